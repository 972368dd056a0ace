// Renders of rooms of agreement, with their variance.
#pragma once

#include "core/parallel.h"
#include "integrator/agreement_cases.h"
#include "integrator/integrator.h"
#include "metrics/block_agreement.h"
#include "render/render.h"

#include <cstdint>
#include <string>

namespace etendue::test {

struct AgreementRenders {
    std::uint32_t seeds = 6;
    std::uint32_t first_seed = 0;
    /// By default a splat falls into one pixel, so that those of a block are independent, as the test assumes; with
    /// others the variances are widened for blocks of `kAgreementBlock`.
    FilterShape filter = FilterShape::Box;
};

/// Pixels, side of the blocks that are compared.
inline constexpr int kAgreementBlock = 8;

/// What all renders of the room have in common: the filter is a box.
[[nodiscard]] RenderOptions render_options(const AgreementCase& agreement);

/// Of the pixels of `part`, which lies within the window that is rendered.
[[nodiscard]] ImageEstimate estimate(const World& world, const Integrator& integrator, const AgreementCase& agreement,
                                     const AgreementRenders& renders, const ThreadPool& threads, const PixelRect& part);
/// Estimates the whole window. Of `vcm` that is Richardson's extrapolation to a radius of zero, (4 I(r / 2) - I(r)) /
/// 3: the bias of merges is of the second order in r.
[[nodiscard]] ImageEstimate estimate(const World& world, const std::string& integrator, const AgreementCase& agreement,
                                     const AgreementRenders& renders, const ThreadPool& threads);

/// Relative standard error of the mean of the image, the largest over the channels; 0 where that is 0.
[[nodiscard]] double mean_error(const ImageEstimate& image);

}  // namespace etendue::test
