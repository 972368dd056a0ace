// Pixels that no filter can use: NaN, infinities, and values so large that their squares overflow.
#pragma once

#include "denoise/planes.h"

#include <cstddef>

namespace etendue {

/// Values beyond ± this count as infinite: squares of their differences, and sums of those, still fit a float.
inline constexpr float kLargestUsable = 1e15f;
/// How far away pixels are looked for that an unusable one is filled from.
inline constexpr int kFillRadius = 8;

/// Replaces each pixel of which any value, in `whole` or in `one_half`, is not finite or beyond kLargestUsable: in both
/// by the mean of the usable pixels of the smallest square around it that has any, up to kFillRadius; by zero beyond.
/// `whole` and `one_half` have the same shape; their borders are neither read nor filled. Returns how many pixels were
/// replaced.
std::size_t fill_unusable(Planes& whole, Planes& one_half);

/// Is the depth, in metres, that a layer holds where the ray met nothing.
inline constexpr float kNothingThere = 1e10f;

/// Moves the background of `whole` and `one_half` (values of kNothingThere and more) to 1.1 times the plane's largest
/// other value in `whole`, so that the plane's own differences stay visible. A plane that is all background becomes 0.
void bring_background_near(Planes& whole, Planes& one_half);

}  // namespace etendue
