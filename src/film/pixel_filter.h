// Pixel filters, by importance sampling: each sample is placed with the filter's density and counts once, so that
// pixels need no neighbours and tiles no borders (Ernst, Stamminger, Greiner, "Filter Importance Sampling", RT 2006).
// Lamps in view are the exception: wave/lamps_in_view.h.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace etendue {

enum class FilterShape {
    BlackmanHarris,  ///< default radius 1.5 pixels: smooth, no ringing
    Box,             ///< default radius 0.5
    Gaussian,        ///< default radius 1.5, standard deviation a third of the radius, lowered to zero at the edge
    Mitchell,        ///< default radius 2, B = C = 1/3; has negative lobes, whose samples count negatively
};

class PixelFilter {
  public:
    /// `radius` in pixels; 0 for the shape's default.
    explicit PixelFilter(FilterShape shape, float radius = 0.0f);

    struct Sample {
        Vec2f offset;  ///< from the pixel's centre, pixels
        float weight;  ///< filter over density, plus or minus a constant; its mean is 1
    };
    /// `u` in [0, 1)².
    [[nodiscard]] Sample sample(Vec2f u) const {
        const Sample1D x = sample_1d(u.x);
        const Sample1D y = sample_1d(u.y);
        return {{x.offset, y.offset}, x.weight * y.weight};
    }

    /// The filter in one dimension at `x` pixels from the centre, normalised to integrate to 1; the filter is
    /// separable.
    [[nodiscard]] float evaluate(float x) const {
        const float step = std::abs(x) * steps_per_pixel_;
        if (step > static_cast<float>(kValues)) return 0.0f;
        const std::size_t below = std::min(static_cast<std::size_t>(step), kValues - 1);
        return values_[below] + (values_[below + 1] - values_[below]) * (step - static_cast<float>(below));
    }
    /// Density, per pixel, with which samples are placed at `x` pixels from the centre in one dimension.
    [[nodiscard]] float pdf(float x) const {
        if (!(x >= edges_.front() && x < edges_.back())) return 0.0f;
        const auto next = std::upper_bound(edges_.begin(), edges_.end(), x);
        return 1.0f / (static_cast<float>(kCells) * (*next - *(next - 1)));
    }
    /// True if some samples count negatively; the weights of all others are 1 if none do.
    [[nodiscard]] bool has_negative_parts() const { return positive_radius_ < radius_; }
    [[nodiscard]] float radius() const { return radius_; }
    [[nodiscard]] FilterShape shape() const { return shape_; }

  private:
    struct Sample1D {
        float offset;
        float weight;
    };
    [[nodiscard]] Sample1D sample_1d(float u) const {
        const float scaled = u * static_cast<float>(kCells);
        const std::size_t cell = std::min(static_cast<std::size_t>(scaled), kCells - 1);
        const float within = scaled - static_cast<float>(cell);
        const float offset = edges_[cell] + (edges_[cell + 1] - edges_[cell]) * within;
        return {offset, std::abs(offset) < positive_radius_ ? weight_ : -weight_};
    }

    /// Cells of equal mass of |filter|: small enough for the first-level cache, fine enough that the steps between them
    /// (the density is constant within a cell) do not show.
    static constexpr std::size_t kCells = 512;

    /// Steps of the table for `evaluate`: straight lines between them stay within 3e-6 of the filter's largest value.
    static constexpr std::size_t kValues = 1024;

    FilterShape shape_;
    float radius_;
    float steps_per_pixel_ = 1.0f;
    float weight_ = 1.0f;           ///< ∫ |filter| / ∫ filter
    float positive_radius_ = 0.0f;  ///< beyond it the filter is negative
    std::vector<float> edges_;      ///< edges of the cells, kCells + 1 offsets
    std::vector<float> values_;     ///< at equal steps from the centre to the radius, kValues + 1
};

}  // namespace etendue
