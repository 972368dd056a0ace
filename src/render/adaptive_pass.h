// Which pixels get the samples of the next pass, so that an image comes to an error with as few of them as possible.
#pragma once

#include "core/parallel.h"
#include "film/error_estimate.h"
#include "render/progressive_render.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// The variance that a sample of each pixel is expected to have, from `variance`, an estimate with one degree of
/// freedom for each of width * height pixels: the largest of the means over the 5 x 5 pixels around each of the 3 x 3
/// around it, so that an edge or a firefly wakes its neighbours. A pixel's own estimate is left out of all of them:
/// what its samples brought must not decide how many it gets, or those that found little would end too soon and the
/// image would be too dark.
[[nodiscard]] std::vector<float> variance_around(std::span<const float> variance, int width, int height,
                                                 const ThreadPool& threads);

/// How samples are to be shared out. One entry for each pixel.
struct Allocation {
    std::span<const float> variance;         ///< relative, that one sample is expected to have
    std::span<const std::uint32_t> samples;  ///< taken
    double eye_error = 0.0;                  ///< measured: mean of the squared relative error that eye samples leave
    double light_error = 0.0;  ///< measured: squared relative error that light paths leave, one per sample
    double target = 0.0;       ///< wanted: eye_error + light_error in the end; > 0, less than their sum now
    std::uint32_t most = 0;    ///< samples that a pixel may have at most
};

/// No pixel's goal is less than this part of the mean, so that what no sample has found yet can be found. It costs as
/// much of all samples at most.
inline constexpr double kLeastShare = 0.125;

/// Samples that each pixel is to have in the end. With e the variance of a sample, n the number of them, P pixels and
/// l the variance that one light path leaves in the image, the least Σ n with
///     mean(e / n) + l / Σ n = target,  n no less than what is taken and no more than `most`
/// has n = c sqrt(e) wherever the bounds allow (Neyman, "On the Two Different Aspects of the Representative Method",
/// 1934): a light path is of use to the whole image, wherever it comes from, and changes c alone. Found by bisection to
/// 1%. The scale of `variance` does not matter, that of `eye_error` does.
[[nodiscard]] std::vector<float> sample_goals(const Allocation& allocation);

struct AdaptivePass {
    std::vector<std::uint8_t> is_active;  ///< 1 for active pixels of the window, row by row; empty if none can get more
    std::uint32_t active = 0;             ///< number of active pixels
    std::uint32_t count = 0;              ///< samples that each active pixel gets
};

/// The next pass of `state`, between passes, whose error `errors` says and is to be `relative_error` with `most`
/// samples per pixel at most.
[[nodiscard]] AdaptivePass plan_adaptive_pass(const RenderState& state, const ErrorEstimate& errors,
                                              double relative_error, std::uint32_t most, const ThreadPool& threads);

/// A pass of those pixels that have less than `least` samples, by which none of them gets more. At least one has less.
[[nodiscard]] AdaptivePass pass_up_to(const AdaptiveState& state, std::uint32_t least);

}  // namespace etendue
