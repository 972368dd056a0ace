// Pixel filters, by importance sampling: each sample is placed with the filter's density and counts once, so that pixels
// need no neighbours and tiles no borders (Ernst, Stamminger, Greiner, "Filter Importance Sampling", RT 2006).
#pragma once

#include "core/vec.h"
#include "sampling/distribution.h"

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
        float weight;  ///< filter over density; its mean is 1
    };
    /// `u` in [0, 1)².
    [[nodiscard]] Sample sample(Vec2f u) const;

    /// The filter in one dimension at `x` pixels from the centre, normalised to integrate to 1; the filter is separable.
    [[nodiscard]] float evaluate(float x) const;
    [[nodiscard]] float radius() const { return radius_; }

  private:
    struct Sample1D {
        float offset;
        float weight;
    };
    [[nodiscard]] Sample1D sample_1d(float u) const;

    FilterShape shape_;
    float radius_;
    float normalization_ = 1.0f;
    Distribution1D magnitude_;  ///< of |filter| over [-radius, radius]
};

}  // namespace etendue
