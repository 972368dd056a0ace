// Filtered look-ups of many points at once, each in a texture of its own.
#pragma once

#include "core/columns.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "core/vector_bytes.h"
#include "texture/footprint.h"
#include "texture/texture.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace etendue {

/// Does many look-ups at once, each as `Texture::lookup` does but for roundings. What is computed many at a time
/// are textures of 8 bits in memory that are read in the usual way, between texels and between levels; others are
/// looked up one by one. Which is which depends on the texture alone.
class TextureLookups {
  public:
    /// Forgets all look-ups.
    void clear();
    /// Adds a look-up, whose result has the next index. `texture` must outlive it.
    void add(const Texture& texture, Vec2f uv, const TextureFootprint& footprint);
    /// Computes what has been added.
    void finish();
    /// Returns the result of look-up `i`, if none has been added since `finish`: linear, in the image's own primaries.
    [[nodiscard]] const Rgb& operator[](std::size_t i) const { return results_[i]; }
    /// Returns the bytes held besides the object itself.
    [[nodiscard]] std::size_t bytes() const { return vector_bytes(results_); }

  private:
    /// A level of a texture whose texels are one number or more of 8 bits.
    struct Level {
        const std::uint8_t* texels = nullptr;
        std::size_t width = 0;
    };
    struct Tap {
        std::array<Level, 2> levels;  ///< between which it lies
        std::uint8_t lookup = 0;
    };
    static_assert(kBlockLanes <= 256);

    void plan_lookups();
    void add_taps(std::size_t lookup);
    void read_taps();
    /// The four texels around as many taps as are computed at once, in one of their two levels, mixed.
    [[nodiscard]] BasicRgb<Wide> read_level(std::size_t first, std::size_t level);

    std::vector<Rgb> results_;
    // Look-ups that have not been computed.
    std::size_t lookups_ = 0;
    std::array<const Texture*, kBlockLanes> textures_{};
    std::array<const MipChain*, kBlockLanes> chains_{};
    std::array<std::uint32_t, kBlockLanes> result_of_{};
    Vec2Columns uv_, diameter0_, diameter1_, size_;
    Column last_level_;
    Vec2Columns step_;
    Column count_, level_, fraction_;
    // Taps of them that have not been read.
    std::size_t taps_ = 0;
    std::array<Tap, kBlockLanes> tap_{};
    Vec2Columns tap_uv_;
    std::array<Vec2Columns, 2> tap_size_;
    Column tap_fraction_;
    Vec2Columns clamps_, mirrors_;  ///< not 0 where a coordinate does
    RgbColumns tap_value_;
};

}  // namespace etendue
