// The light that the samples of a wave have found, and what of it belongs to which layer.
#pragma once

#include "core/rgb.h"
#include "integrator/aov/path_words.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

class SampleLight {
  public:
    /// Starts `samples` of them. `aovs` may be null.
    void reset(std::size_t samples, const AovSet* aovs) {
        layer_count_ = aovs != nullptr ? aovs->layout.light : 0;
        radiance_.assign(samples, Rgb());
        layers_.assign(samples * layer_count_, Rgb());
        rays_.assign(aovs != nullptr && aovs->layout.has_ray_counts ? samples : 0, 0);
    }

    /// Adds light to the sample in `slot`, and its shares to the layers of their expressions.
    void add(std::uint32_t slot, const Rgb& light, std::span<const ExpressionShare> shares = {}) {
        radiance_[slot] += light;
        for (const ExpressionShare& part : shares) {
            const Rgb value = light * part.share;
            for (ExpressionMask left = part.expressions; left != 0; left &= left - 1)
                layers_[slot * layer_count_ + static_cast<std::size_t>(std::countr_zero(left))] += value;
        }
    }
    /// A ray that was traced for the sample.
    void count_ray(std::uint32_t slot) {
        if (!rays_.empty()) ++rays_[slot];
    }
    [[nodiscard]] bool counts_rays() const { return !rays_.empty(); }

    [[nodiscard]] const Rgb& radiance(std::size_t slot) const { return radiance_[slot]; }
    [[nodiscard]] std::span<const Rgb> layers(std::size_t slot) const {
        return std::span(layers_).subspan(slot * layer_count_, layer_count_);
    }
    [[nodiscard]] std::uint32_t rays(std::size_t slot) const { return rays_.empty() ? 0 : rays_[slot]; }

  private:
    std::size_t layer_count_ = 0;
    std::vector<Rgb> radiance_;
    std::vector<Rgb> layers_;  ///< sample by sample
    std::vector<std::uint32_t> rays_;
};

}  // namespace etendue
