// What the camera rays of a wave have met, until it is known which of their samples the film keeps.
#pragma once

#include "film/layers.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace etendue {

/// Holds, for each sample of a wave, the depth, the numbers and the ids of the surface that it has met first. A sample
/// whose light is dropped must leave nothing in any layer, or its coverage would count where its alpha does not.
class WaveHits {
    [[nodiscard]] static auto of(auto& all, std::size_t sample, std::size_t count) {
        return std::span(all).subspan(sample * count, count);
    }

  public:
    /// Starts with `samples` that have met nothing. Of each there will be `averaged` numbers, the first of the values
    /// of `layout`, and all else that it has of surfaces. Memory is kept.
    void reset(const LayerLayout& layout, std::size_t averaged, std::size_t samples) {
        averaged_ = averaged;
        nearest_ = layout.nearest;
        mattes_ = layout.mattes;
        distances_.assign(samples, std::numeric_limits<float>::infinity());
        depths_.assign(layout.is_deep ? samples : 0, kDeepBackground);
        values_.resize(samples * (averaged_ + nearest_));
        ids_.resize(samples * mattes_);
    }

    /// Metres along its ray at which a sample has met a surface, whose numbers and ids all have to be put down then.
    void set_distance(std::size_t sample, float distance) { distances_[sample] = distance; }
    [[nodiscard]] bool has_hit(std::size_t sample) const {
        return distances_[sample] < std::numeric_limits<float>::infinity();
    }
    /// Returns the depth of what a sample has met, metres along the viewing direction; of deep images only.
    [[nodiscard]] float& depth(std::size_t sample) { return depths_[sample]; }
    [[nodiscard]] float depth(std::size_t sample) const { return depths_[sample]; }
    /// Returns a sample's averaged numbers, then those of the nearest.
    [[nodiscard]] std::span<float> values(std::size_t sample) { return of(values_, sample, averaged_ + nearest_); }
    /// Returns a sample's ids, one of each matte.
    [[nodiscard]] std::span<std::uint32_t> ids(std::size_t sample) { return of(ids_, sample, mattes_); }

    /// Adds what `sample` has met, with the weight of its radiance, to a pixel of `layers`, all but its depth.
    void add_to(LayerBuffer& layers, std::size_t pixel, std::size_t sample, double weight) const {
        if (!has_hit(sample)) return;
        const std::span<const float> values = of(values_, sample, averaged_ + nearest_);
        const std::span<double> sums = layers.sums(pixel).subspan(layers.layout().value_sums(), averaged_);
        for (std::size_t v = 0; v < averaged_; ++v) sums[v] += weight * static_cast<double>(values[v]);
        if (nearest_ > 0) layers.add_nearest(pixel, distances_[sample], values.subspan(averaged_));
        const std::span<const std::uint32_t> ids = of(ids_, sample, mattes_);
        for (std::size_t m = 0; m < mattes_; ++m) layers.mattes().add(pixel, m, ids[m], weight);
    }

  private:
    std::size_t averaged_ = 0;
    std::size_t nearest_ = 0;
    std::size_t mattes_ = 0;
    std::vector<float> distances_;  ///< infinite of those that have met nothing
    std::vector<float> depths_;
    std::vector<float> values_;
    std::vector<std::uint32_t> ids_;
};

}  // namespace etendue
