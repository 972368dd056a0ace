// Collaborative first-order regression: Bitterli et al., "Nonlinearly Weighted First-order Regression for Denoising
// Monte Carlo Renderings" (EGSR 2016), section 5.2.
#pragma once

#include "core/parallel.h"
#include "denoise/nl_means.h"
#include "denoise/planes.h"

namespace etendue {

/// Holds what the regression of one image is made from; borders are filled.
struct RegressionInput {
    const Planes& target;    ///< the image that is fitted, 3 planes
    NlMeansGuide guide;      ///< makes the weights; independent of `target` if the fit is not to follow its noise
    const Planes& features;  ///< scaled to a deviation of about 1; at most kMostUnknowns - 3 planes
};

/// Around every pixel p a function of position and features is fitted (`WindowFit`), and every pixel q becomes the mean
/// of what all windows that it lies in say of it, with the weights w_pq that it had in them:
///
///     û(q) = Σ_p w_pq x_q · β_p / Σ_p w_pq
///
/// Exactly the same for every number of threads. The border is filled.
[[nodiscard]] Planes collaborative_regression(const RegressionInput& input, const NlMeansSettings& settings,
                                              const ThreadPool& threads);

}  // namespace etendue
