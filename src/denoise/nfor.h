// NFOR: Bitterli, Rousselle, Moon, Iglesias-Guitián, Adler, Mitchell, Jarosz and Novák, "Nonlinearly Weighted
// First-order Regression for Denoising Monte Carlo Renderings", Computer Graphics Forum 35 (4), EGSR 2016.
//
// Two independent halves of the samples are denoised with weights from each other, so that no weight follows the noise
// that it is to remove. Weights come from colours alone; features (albedo, normals, depth, …) are what is fitted.
#pragma once

#include "core/parallel.h"
#include "denoise/halves.h"
#include "denoise/planes.h"

#include <array>
#include <atomic>
#include <vector>

namespace etendue {

struct NforSettings {
    int radius = 9;  ///< radius of the windows of the regression, in [1, kLargestWindowRadius]
    /// Once it is true, the work ends as soon as it can, and what is returned is worth nothing.
    const std::atomic<bool>* stop = nullptr;
};

/// Features without most of their own noise, each scaled to a deviation of about 1 over the image: one plane for each
/// channel.
struct PreparedFeatures {
    Planes a;     ///< from half a of the samples, with weights from b
    Planes b;     ///< from half b, with weights from a
    Planes both;  ///< from both
};

/// Section 5.1 of the paper. All of one size and with the same share; together at most kMostUnknowns - 3 planes, at
/// least one feature or `width` and `height` say how large the result is.
[[nodiscard]] PreparedFeatures prepare_features(const std::vector<Halves>& features, int width, int height,
                                                const NforSettings& settings, const ThreadPool& threads);

/// The layer of light `light`, of 3 planes, denoised: sections 5.2 to 5.4. Pixels of which the halves say that they
/// would become worse stay as they are. Exactly the same for every number of threads. No value is below the least of
/// the mean of both halves, or 0 if that is less: light does not become negative.
[[nodiscard]] Planes denoise_nfor(const Halves& light, const PreparedFeatures& features, const NforSettings& settings,
                                  const ThreadPool& threads);

}  // namespace etendue
