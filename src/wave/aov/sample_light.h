// The light that the samples of a wave have found, and what of it belongs to which layer.
#pragma once

#include "core/rgb.h"
#include "core/vector_bytes.h"
#include "wave/aov/path_words.h"
#include "wave/render_counters.h"
#include "wave/tile_job.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// A contribution that may be one of the brightest.
struct BrightLight {
    std::uint32_t slot = 0;
    Rgb value{};                    ///< before any limit; of a splat, as a sample of the pixel has it
    std::optional<Vec2f> position;  ///< place of a splat, pixels of the full image
};

class SampleLight {
  public:
    /// Starts `samples` of the job. Contributions that are as bright as `brightest` are put aside.
    void reset(std::size_t samples, const TileJob& job, float brightest);

    /// Adds light to the sample in `slot`, and its shares to the layers of their expressions.
    void add(std::uint32_t slot, const Rgb& light, LightKind kind, std::span<const ExpressionShare> shares = {}) {
        // One comparison for all that is done with bright light only; not finite is bright.
        if (max_component(light) < watched_) [[likely]]
            add_unwatched(slot, light, shares);
        else
            add_watched(slot, light, kind, shares);
    }
    /// Leaves what the light path of the sample in `slot`, of this index in its pixel, brings to a place on the film.
    void add_splat(std::uint32_t slot, std::uint32_t sample, const Splat& splat, LightKind kind,
                   std::span<const ExpressionShare> shares, std::vector<Splat>& splats);

    /// Counts a ray that was traced for the sample in `slot`.
    void count_ray(std::uint32_t slot) {
        if (!rays_.empty()) ++rays_[slot];
    }
    [[nodiscard]] bool counts_rays() const { return !rays_.empty(); }

    [[nodiscard]] const Rgb& radiance(std::size_t slot) const { return radiance_[slot]; }
    /// Returns the light layers of the sample in `slot`: those of expressions, then what a limit took away.
    [[nodiscard]] std::span<const Rgb> layers(std::size_t slot) const {
        return std::span(layers_).subspan(slot * layer_count_, layer_count_);
    }
    [[nodiscard]] std::uint32_t rays(std::size_t slot) const { return rays_.empty() ? 0 : rays_[slot]; }
    [[nodiscard]] std::size_t bytes() const { return vector_bytes(radiance_, layers_, rays_, bright_); }
    /// Returns the contributions that were put aside.
    [[nodiscard]] std::span<const BrightLight> bright() const { return bright_; }

  private:
    void add_unwatched(std::uint32_t slot, const Rgb& light, std::span<const ExpressionShare> shares) {
        radiance_[slot] += light;
        for (const ExpressionShare& part : shares) {
            const Rgb value = light * part.share;
            for (ExpressionMask left = part.expressions; left != 0; left &= left - 1)
                layers_[slot * layer_count_ + static_cast<std::size_t>(std::countr_zero(left))] += value;
        }
    }
    void add_watched(std::uint32_t slot, const Rgb& light, LightKind kind, std::span<const ExpressionShare> shares);
    /// Shows a contribution to whom it concerns, and returns what of it counts.
    [[nodiscard]] Rgb watch(const BrightLight& light, LightKind kind, std::span<const ExpressionShare> shares);

    std::size_t layer_count_ = 0;
    std::vector<Rgb> radiance_;
    std::vector<Rgb> layers_;  ///< sample by sample
    std::vector<std::uint32_t> rays_;
    std::vector<BrightLight> bright_;
    float watched_ = std::numeric_limits<float>::infinity();  ///< the least of the limits below
    float limit_ = std::numeric_limits<float>::infinity();
    float brightest_ = std::numeric_limits<float>::infinity();
    float splat_scale_ = 1.0f;  ///< from splats to samples
    const AovSet* aovs_ = nullptr;
    PathSpeller* speller_ = nullptr;
};

}  // namespace etendue
