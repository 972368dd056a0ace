// Relief that is too small to be seen, as roughness: spreads of slopes in other frames, and of lobes with them.
#pragma once

#include "core/frame.h"
#include "core/vec.h"
#include "texture/slope_distribution.h"

#include <algorithm>
#include <cmath>

namespace etendue {

/// `covariance` of slopes along x and y of the frame `from`, as slopes in the frame `to` around their mean normal; to
/// first order in what they differ from that.
//
// A slope that differs by (dx, dy) is that of the vector n / (n · from.z) + dx from.x + dy from.y, where n is the mean
// normal, to.z. In `to` its slopes are its components along to.x and to.y over n · from.z's inverse.
[[nodiscard]] inline SlopeCovariance tilted(const SlopeCovariance& covariance, const Frame& from, const Frame& to) {
    const float cosine = dot(from.normal, to.normal);
    const Vec2f of_x(cosine * dot(from.tangent, to.tangent), cosine * dot(from.tangent, to.bitangent));
    const Vec2f of_y(cosine * dot(from.bitangent, to.tangent), cosine * dot(from.bitangent, to.bitangent));
    const auto moment = [&](float x0, float y0, float x1, float y1) {
        return covariance.xx * x0 * x1 + covariance.xy * (x0 * y1 + y0 * x1) + covariance.yy * y0 * y1;
    };
    return {moment(of_x.x, of_y.x, of_x.x, of_y.x), moment(of_x.x, of_y.x, of_x.y, of_y.y),
            moment(of_x.y, of_y.y, of_x.y, of_y.y)};
}

/// A rough surface that is made rougher, in the axes of what that makes of it.
struct RoughnessAxes {
    Vec2f direction;       ///< unit, in which it is roughest
    Vec2f added_variance;  ///< variance of slopes along `direction` and across it, >= 0, which widens the alphas along
                           ///< x and y
};

/// Returns the axes for the alphas `alpha`, of which that along x is no less, and slopes that vary by `covariance`
/// beside (widening.h). The variances are those that turn `alpha.x` and `alpha.y` into the alphas along the new axes.
[[nodiscard]] inline RoughnessAxes roughness_axes(Vec2f alpha, const SlopeCovariance& covariance) {
    const Vec2f own(0.5f * alpha.x * alpha.x, 0.5f * alpha.y * alpha.y);
    // Eigenvalues and the eigenvector of the larger one of the sum, a symmetric matrix.
    const float mean = 0.5f * (own.x + covariance.xx + own.y + covariance.yy);
    const float half_difference = 0.5f * (own.x + covariance.xx - own.y - covariance.yy);
    const float radius = std::sqrt(half_difference * half_difference + covariance.xy * covariance.xy);
    const float angle = 0.5f * std::atan2(covariance.xy, half_difference);
    return {{std::cos(angle), std::sin(angle)},
            {std::max(0.0f, mean + radius - own.x), std::max(0.0f, mean - radius - own.y)}};
}

}  // namespace etendue
