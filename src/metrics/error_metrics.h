// How far an image is from a reference, in the measures that rendering papers use.
//
// v is a pixel's channel in the image, r the same in the reference; means are over all selected pixels and all
// channels. FLIP, which models what an observer sees, is in flip.h.
#pragma once

#include "image/image.h"
#include "metrics/pixel_selection.h"

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace etendue {

/// Keeps relative measures finite where the reference is black.
inline constexpr double kMetricEpsilon = 1e-2;
/// Share of the largest terms that the trimmed relMSE drops: fireflies.
inline constexpr double kTrimmedShare = 1e-3;

enum class ErrorMetric { RelMse, RelMseTrimmed, Mse, Mae, Smape };

/// All of them, in the order in which they are reported.
inline constexpr std::array kErrorMetrics{ErrorMetric::RelMse, ErrorMetric::RelMseTrimmed, ErrorMetric::Mse,
                                          ErrorMetric::Mae, ErrorMetric::Smape};

/// Returns the name of a metric in reports and on the command line: "relmse", "relmse-trimmed", "mse", "mae", "smape".
[[nodiscard]] std::string_view name_of(ErrorMetric metric);
/// Returns the formula of a metric in plain characters, with its constants: "mean (v - r)^2 / (r^2 + 0.01)".
[[nodiscard]] std::string formula_of(ErrorMetric metric);

struct ErrorMetrics {
    double rel_mse = 0.0;          ///< mean (v - r)² / (r² + epsilon)
    double rel_mse_trimmed = 0.0;  ///< relMSE without the largest 0.1% of its terms (rounded down to whole terms)
    double mse = 0.0;              ///< mean (v - r)²
    double mae = 0.0;              ///< mean |v - r|
    double smape = 0.0;            ///< mean |v - r| / (|v| + |r| + epsilon)

    [[nodiscard]] double value(ErrorMetric metric) const;
    /// One line a measure, `name value   formula`.
    [[nodiscard]] std::string str() const;
};

/// Compares the selected pixels of `image` with those of `reference`, both of the same size and number of channels.
/// Throws std::invalid_argument if they are not, or are empty. Values that are not finite make the measures not finite;
/// so does a selection of no pixels.
/// `variance` is that of each value of the reference, which is independent of the image, or empty: it is taken off the
/// squared errors, so that MSE is in expectation that against a reference without noise, and so is relMSE, trimmed or
/// not, but for the noise of its denominator.
[[nodiscard]] ErrorMetrics compute_error_metrics(const ImageF& image, const ImageF& reference,
                                                 const PixelSelection& selection = {},
                                                 std::span<const float> variance = {});

/// One channel: each pixel's mean of the terms of `metric` over its channels. Their mean over the pixels is the
/// measure; the trimmed relMSE has the map of relMSE. Throws as `compute_error_metrics`.
[[nodiscard]] ImageF error_map(ErrorMetric metric, const ImageF& image, const ImageF& reference);

/// Throws std::invalid_argument, which says `what` and the sizes, unless `a` and `b` have the same size and channels
/// and are not empty.
void require_same_shape(const ImageF& a, const ImageF& b, std::string_view what);

}  // namespace etendue
