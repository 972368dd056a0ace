// How far an image is from what it would be with samples without end, from two parts of its own samples.
#pragma once

#include "core/parallel.h"
#include "film/film.h"

#include <vector>

namespace etendue {

/// How bright an image is on the whole, by which its error is measured: the square of the mean of sqrt(v) over those
/// blocks of 8 x 8 pixels that are not black, where v is a block's mean over its pixels and channels. The root lets a
/// lamp in the picture, or a firefly, count for little of what it has; blocks know how bright pixels are that few
/// samples have found light in; and what is black around a picture does not make it a darker one. 0 if all is black.
/// Twice the light is exactly twice the scale.
[[nodiscard]] double image_scale(const Film& film, const ThreadPool& threads);

/// Values below this share of the image's scale are measured against the scale rather than against themselves.
inline constexpr double kDarkShare = 0.5;

/// The expected squared relative error of an image, apart for what makes it. All are means over the three channels of
///     (a - b)² s (1 - s) / (max(0, a b) + ε²)
/// where `a` is the mean of the share `s` of the samples that one part of the image holds, `b` that of the others, and
/// ε is kDarkShare times the image's scale: the variance of a - b is σ² (1 / s + 1 / (1 - s)) / n, that of the mean of
/// all is σ² / n. Samples that fill each other's gaps (Sobol's) make it too high rather than too low. a b, whose mean
/// is the square of the true value, stands below the line, as the square of the image's own would hide its largest
/// errors: a sample that is alone in finding light would be measured by itself. What a pixel's own samples bring and
/// what light paths do is estimated apart, as each has a share of its own, and added: the two are all but independent,
/// since a light path seldom falls into the pixel that it was made for.
///
/// A pixel whose n samples were all equal has shown no error, which is not to have none. With 95% certainty less than
/// 3 / n of all samples are others (the rule of three); if those are off by the image's scale, the variance of the
/// pixel's mean is 3 (scale / n)². That is what counts in place of nothing. An image that is black so far has no scale:
/// its squared relative error is taken to be 1 / n.
struct ErrorEstimate {
    std::vector<float> eye;  ///< error of each pixel, row by row: what its own samples bring
    double eye_mean = 0.0;   ///< mean of `eye`
    /// Mean over the pixels of what light paths bring. If nothing else does, pixels without a difference count here.
    double light = 0.0;

    /// The square root of the mean squared relative error that the image can be expected to have. If light is
    /// multiplied by a power of two, it stays the same to the bit.
    [[nodiscard]] double relative_error() const;
};

/// Errors of the pixels of `whole`, of whose samples and light paths `part` holds some; both films have one window. A
/// pixel of which `part` holds none or all counts as free of error. The result is the same for any number of threads.
[[nodiscard]] ErrorEstimate estimate_errors(const Film& whole, const Film& part, const ThreadPool& threads);

}  // namespace etendue
