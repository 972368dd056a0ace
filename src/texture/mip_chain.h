// A texture in memory: its image and ever smaller versions of it, in the file's own depth.
#pragma once

#include "core/vec.h"
#include "image/image.h"
#include "texture/slope_distribution.h"
#include "texture/srgb.h"
#include "texture/texture_options.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

namespace etendue {

/// Levels of a full chain from `width` × `height` down to 1 × 1, each half the one before (rounded down).
[[nodiscard]] int mip_level_count(int width, int height);
/// Texels of all its levels together: about 4/3 of the image's.
[[nodiscard]] std::uint64_t mip_texel_count(int width, int height);

/// Bytes that a normal map of this size takes to keep its slopes' covariances.
[[nodiscard]] std::uint64_t slope_covariance_bytes(int width, int height);

/// Bounds the texels of an image, channel by channel, linear.
struct TexelRange {
    Texel least, greatest;
};

/// Says which levels a chain has, and how those that are not given are averaged.
enum class MipLevels {
    All,         ///< over the texels' areas
    AllByAlpha,  ///< as All, but colours with alpha as their weight; what has none takes those of the coarser level
    AsGiven,     ///< only those that are given
};

class MipChain {
  public:
    /// `levels` are the image and, if they are known, some of its mip levels, all of one depth; not empty. The others
    /// are averaged from them in linear light and rounded to the image's depth, if they are wanted.
    MipChain(std::vector<NativeImage> levels, Encoding encoding, MipLevels wanted = MipLevels::All);

    /// Value at `uv`, whose wraps are as `options` say, between the two levels next to `level` >= 0: bilinear in both,
    /// or the nearest texel of both.
    [[nodiscard]] Texel sample(Vec2f uv, float level, bool nearest, const TextureOptions& options) const;

    /// Keeps, of a normal map with all levels, how the slopes of the image, `interpolated` between its texels or not,
    /// are spread within each texel of the others.
    void keep_slopes(bool interpolated);
    /// The slopes of a normal map that keeps them, read as by `sample`, between levels from the first mip level on:
    /// `level` >= 1.
    [[nodiscard]] SlopeDistribution sample_slopes(Vec2f uv, float level, bool nearest,
                                                  const TextureOptions& options) const;

    /// Has the texels around `uv` in [0, 1)² of the image itself fetched from memory.
    void fetch(Vec2f uv) const;

    /// Mean of rgb and of alpha over all texels of the image, linear.
    [[nodiscard]] Texel mean() const;

    /// Returns the least and the greatest value of each channel of the image.
    [[nodiscard]] TexelRange range() const;

    /// A level whose texels are 8 bits a channel.
    struct Level8 {
        const std::uint8_t* texels;  ///< row by row, the channels of each together
        int width;
        int height;
    };
    [[nodiscard]] bool is_8bit() const { return std::holds_alternative<std::vector<std::uint8_t>>(values_); }
    /// Returns the level of this index of a chain that is_8bit.
    [[nodiscard]] Level8 level8(int index) const {
        const Level& level = levels_[static_cast<std::size_t>(index)];
        return {std::get<std::vector<std::uint8_t>>(values_).data() + level.first * static_cast<std::size_t>(channels_),
                level.width, level.height};
    }
    [[nodiscard]] int level_count() const { return static_cast<int>(levels_.size()); }
    [[nodiscard]] int channels() const { return channels_; }
    /// Returns the linear values of a chain's integers of 8 bits.
    [[nodiscard]] const Decoding8& decoding8() const { return *decoding8_; }

    [[nodiscard]] int width() const { return levels_.front().width; }
    [[nodiscard]] int height() const { return levels_.front().height; }
    [[nodiscard]] std::size_t bytes() const;

  private:
    struct Level {
        int width;
        int height;
        std::size_t first;  ///< texel
    };
    using Values =
        std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<Float16>, std::vector<float>>;
    template <typename T>
    std::vector<T> take_levels(std::vector<NativeImage>& images);
    template <typename T>
    void add_levels(std::vector<T>& values, bool by_alpha);
    /// Calls `use(values, channels)` with the values as they are stored and the number of channels as a constant.
    template <typename Use>
    auto with_texels(const Use& use) const;
    /// `read(i)` is the value of texel i, counted through all levels.
    template <typename Read>
    [[nodiscard]] auto sample_levels(Vec2f uv, float level, bool nearest, const TextureOptions& options,
                                     const Read& read) const;
    template <typename Read>
    [[nodiscard]] auto sample_level(Vec2f uv, const Level& level, bool nearest, const TextureOptions& options,
                                    const Read& read) const;
    template <int Channels, typename T>
    [[nodiscard]] Texel read_texel(const T* texel) const;
    template <typename T>
    [[nodiscard]] float decode_color(T value) const;

    int channels_ = 0;
    Encoding encoding_ = Encoding::Linear;
    const Decoding8* decoding8_ = nullptr;  ///< linear values of 8-bit colour
    std::vector<Level> levels_;
    Values values_;
    std::vector<Float16> slope_covariances_;  ///< xx, xy and yy of each texel from the first mip level on
};

}  // namespace etendue
