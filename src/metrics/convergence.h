// How an error falls with the work that is put into an image.
#pragma once

#include <optional>
#include <span>

namespace etendue {

/// An error after so much work: seconds, or samples.
struct ErrorAfter {
    double work = 0.0;
    double error = 0.0;
};

/// Exponent p of error ~ work^p by least squares over the logarithms of the points that are positive and finite; -1 is
/// what the variance of independent samples has. Nothing where no line fits: fewer than three such points, or a line
/// that explains less than 98% of the variance of the logarithms of the errors (the coefficient of determination).
[[nodiscard]] std::optional<double> log_log_slope(std::span<const ErrorAfter> points);

/// The work after which an error is reached.
struct WorkToReach {
    double work = 0.0;
    bool extrapolated = false;  ///< beyond the last point, along the fitted line
};

/// Returns the work at which the straight lines between the logarithms of `points`, in the order of their work, first
/// come down to `error` > 0; the first point's if it is there already. Beyond the last point, the work lies along the
/// slope of all points, if a line fits them and falls. None if the error is never reached, or there are no points.
[[nodiscard]] std::optional<WorkToReach> work_to_reach(std::span<const ErrorAfter> points, double error);

}  // namespace etendue
