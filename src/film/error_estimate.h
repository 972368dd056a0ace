// How far an image is from what it would be with samples without end, from two parts of its own samples.
#pragma once

#include "film/film.h"

#include <vector>

namespace etendue {

/// The expected squared relative error of an image, apart for what makes it. All are means over the three channels of
///     (a - b)² s (1 - s) / (v² + 0.01)
/// where `a` is the mean of the share `s` of the samples that one part of the image holds, `b` that of the others, and
/// `v` the image: the variance of a - b is σ² (1 / s + 1 / (1 - s)) / n, that of the mean of all is σ² / n. Samples
/// that fill each other's gaps (Sobol's) make it too high rather than too low. 0.01 is the epsilon of `etendue diff`'s
/// relMSE. What a pixel's own samples bring and what light paths do is estimated apart, as each has a share of its own,
/// and added: the two are all but independent, since a light path seldom falls into the pixel that it was made for.
struct ErrorEstimate {
    std::vector<float> eye;  ///< of each pixel, row by row: what its own samples bring
    double eye_mean = 0.0;   ///< of these
    double light = 0.0;      ///< mean over the pixels of what light paths bring

    /// The square root of the relMSE that the image can be expected to have.
    [[nodiscard]] double relative_error() const;
};

/// Of `whole`, whose samples and light paths `part` holds some of, of every pixel; both films have the same window. A
/// pixel of which it holds none or all counts as free of error.
[[nodiscard]] ErrorEstimate estimate_errors(const Film& whole, const Film& part);

}  // namespace etendue
