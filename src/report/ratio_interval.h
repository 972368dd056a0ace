// The ratio of two measured numbers, with what chance leaves open of it.
#pragma once

#include <limits>

namespace etendue {

/// Share of the intervals of ratios that hold the true one.
inline constexpr double kRatioConfidence = 0.95;

/// The logarithm of a positive number, estimated from several measurements.
struct LogEstimate {
    double value = std::numeric_limits<double>::quiet_NaN();
    double variance = std::numeric_limits<double>::quiet_NaN();  ///< variance of `value`; unknown of one measurement
    double degrees = 0.0;                                        ///< degrees of freedom of the variance
};

struct RatioInterval {
    double ratio = std::numeric_limits<double>::quiet_NaN();
    double low = std::numeric_limits<double>::quiet_NaN();  ///< unknown if a variance is
    double high = std::numeric_limits<double>::quiet_NaN();
};

/// Returns the estimate of the product of two numbers that were measured independently.
[[nodiscard]] LogEstimate product(const LogEstimate& a, const LogEstimate& b);

/// The ratio exp(a − b) and its interval exp(a − b ± t e), with e² the sum of the variances and t the two-sided
/// quantile of Student's distribution with e⁴ / Σ(variance² / degrees) degrees of freedom (B. L. Welch, "The
/// generalization of 'Student's' problem when several different population variances are involved", Biometrika 34,
/// 1947).
[[nodiscard]] RatioInterval ratio_interval(const LogEstimate& a, const LogEstimate& b,
                                           double confidence = kRatioConfidence);

}  // namespace etendue
