// How far an image is from a reference, in the measures that rendering papers use.
//
// v is a pixel's channel in the image, r the same in the reference; means are over all pixels and channels.
#pragma once

#include "image/image.h"

#include <string>
#include <string_view>

namespace etendue {

/// Keeps relative measures finite where the reference is black.
inline constexpr double kMetricEpsilon = 1e-2;
/// Share of the largest terms that the trimmed relMSE drops: fireflies.
inline constexpr double kTrimmedShare = 1e-3;

struct ErrorMetrics {
    double rel_mse = 0.0;          ///< mean (v - r)² / (r² + epsilon)
    double rel_mse_trimmed = 0.0;  ///< the same without the largest 0.1% of the terms (rounded down to whole terms)
    double mse = 0.0;              ///< mean (v - r)²
    double mae = 0.0;              ///< mean |v - r|
    double smape = 0.0;            ///< mean |v - r| / (|v| + |r| + epsilon)

    /// One line a measure, `name value   formula`.
    [[nodiscard]] std::string str() const;
};

/// Compares `image` with `reference`, both of the same size and number of channels. Throws std::invalid_argument if
/// they are not, or are empty. Values that are not finite make the measures not finite.
[[nodiscard]] ErrorMetrics compute_error_metrics(const ImageF& image, const ImageF& reference);

/// Throws std::invalid_argument, which says `what` and the sizes, unless `a` and `b` have the same size and channels
/// and are not empty.
void require_same_shape(const ImageF& a, const ImageF& b, std::string_view what);

}  // namespace etendue
