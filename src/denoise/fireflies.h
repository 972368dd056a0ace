// Fireflies: pixels that one sample of an unlikely path has made as bright as no sample of the other half says they
// are.
#pragma once

#include "denoise/halves.h"

#include <cstddef>

namespace etendue {

/// How many times brighter than its surroundings in the other half a pixel must be to be a firefly.
inline constexpr float kFireflyFactor = 50.0f;
/// Sets the surroundings that a firefly is compared with: this many pixels to each side, 7 × 7 in all.
inline constexpr int kFireflyRadius = 3;

struct Fireflies {
    std::size_t count = 0;     ///< values of a half that were replaced
    double light_share = 0.0;  ///< share of the image's light that they took with them, in [0, 1]
};

/// Replaces each pixel of one half whose sum of channels is more than kFireflyFactor times that of the other half's
/// mean over (2 kFireflyRadius + 1)² pixels and half of its mean over the image: by the other half's mean over 3 × 3
/// pixels. What is bright in both halves stays, a lamp's image or a caustic; where light is so rare that the other half
/// has none of it, light is lost. The variance is
/// estimated again. Borders are filled.
Fireflies remove_fireflies(Halves& light);

}  // namespace etendue
