// How far an image is from what it would be with samples without end, from two parts of its own samples.
#pragma once

#include "film/film.h"

namespace etendue {

/// The square root of the relMSE that `whole` can be expected to have: the mean over pixels and channels of
///     (a - b)² s (1 - s) / (v² + 0.01)
/// where `a` is the mean of the share `s` of the samples that `part` holds, `b` that of the others, and `v` of all:
/// the variance of a - b is σ² (1 / s + 1 / (1 - s)) / n, that of v is σ² / n, whatever made the samples, light
/// subpaths included. Samples that fill each other's gaps (Sobol's) make it too high rather than too low. 0.01 is the
/// epsilon of `etendue diff`'s relMSE. `share` in (0, 1); both films have the same window.
[[nodiscard]] double estimate_relative_error(const Film& whole, const Film& part, double share);

}  // namespace etendue
