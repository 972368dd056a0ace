// Relative indices of refraction in the albedo tables: what both layouts share.
//
// What a rough interface loses changes fastest with the index where light meets the facets at their critical angle,
// and for a matched interface edge-on: there facets reflect the more the closer their squared cosine to the direction
// is to the relative difference of the indices, and refraction by that difference turns light above the horizon. An
// index is measured by r = (eta - 1) / (eta + 1), eta >= 1 being the denser side's, evenly in log(r + scale), where
// `scale` follows the direction to such places. What bends sharply at a known index has its bend on a node.
#pragma once

#include "bsdf/ggx_albedo.h"

#include <cmath>

namespace etendue::ggx_albedo_indices {

/// Root of the reflectance at normal incidence.
[[nodiscard]] inline float r0_root(float eta) {
    return (eta - 1.0f) / (eta + 1.0f);
}
[[nodiscard]] inline float eta_of(float root) {
    return (1.0f + root) / (1.0f - root);
}
inline constexpr float kLargestRoot = (kMaxTabulatedEta - 1.0f) / (kMaxTabulatedEta + 1.0f);

/// `along`: the width of the slopes towards the direction.
[[nodiscard]] inline float index_scale(float cos_theta, float along) {
    return 0.0003f + 0.08f * cos_theta * (0.5f * cos_theta + along);
}

/// Squared sine of the largest tabulated index's critical angle.
inline constexpr float kSmallestSine2 = 1.0f / (kMaxTabulatedEta * kMaxTabulatedEta);
/// The root of the index whose critical angle has the given squared sine, which is taken to be `smallest` or more.
[[nodiscard]] inline float critical_root(float sine2, float smallest = kSmallestSine2) {
    const float sine = std::sqrt(sine2 > smallest ? sine2 : smallest);
    return (1.0f - sine) / (1.0f + sine);
}

/// Position in [0, 1] of `root` between `low` and `high`, even in log(root + scale); 0 where those are the same.
[[nodiscard]] inline float log_fraction(float root, float low, float high, float scale) {
    const float range = std::log((high + scale) / (low + scale));
    return range > 0.0f ? std::log((root + scale) / (low + scale)) / range : 0.0f;
}
[[nodiscard]] inline float at_log_fraction(float fraction, float low, float high, float scale) {
    return low + (low + scale) * std::expm1(fraction * std::log((high + scale) / (low + scale)));
}

}  // namespace etendue::ggx_albedo_indices
