#include "metrics/convergence.h"

#include <cmath>
#include <cstddef>

namespace etendue {

namespace {

/// Least share of the variance of the logarithms of errors that a line explains which fits them.
constexpr double kLeastDetermination = 0.98;
constexpr double kLeastPoints = 3.0;

bool has_logarithms(const ErrorAfter& point) {
    return point.work > 0.0 && point.error > 0.0 && std::isfinite(point.work) && std::isfinite(point.error);
}

}  // namespace

std::optional<double> log_log_slope(std::span<const ErrorAfter> points) {
    double count = 0.0;
    double x_sum = 0.0;
    double y_sum = 0.0;
    for (const ErrorAfter& point : points) {
        if (!has_logarithms(point)) continue;
        count += 1.0;
        x_sum += std::log(point.work);
        y_sum += std::log(point.error);
    }
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
    for (const ErrorAfter& point : points) {
        if (!has_logarithms(point)) continue;
        const double x = std::log(point.work) - x_sum / count;
        const double y = std::log(point.error) - y_sum / count;
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    if (count < kLeastPoints || !(xx > 0.0) || xy * xy < kLeastDetermination * xx * yy) return std::nullopt;
    return xy / xx;
}

std::optional<WorkToReach> work_to_reach(std::span<const ErrorAfter> points, double error) {
    if (!(error > 0.0)) return std::nullopt;
    const ErrorAfter* before = nullptr;
    for (const ErrorAfter& point : points) {
        if (!has_logarithms(point)) continue;
        if (point.error <= error) {
            if (before == nullptr) return WorkToReach{point.work};
            const double share = std::log(before->error / error) / std::log(before->error / point.error);
            return WorkToReach{before->work * std::pow(point.work / before->work, share)};
        }
        before = &point;
    }
    const std::optional<double> slope = log_log_slope(points);
    if (before == nullptr || !slope || !(*slope < 0.0)) return std::nullopt;
    return WorkToReach{before->work * std::pow(error / before->error, 1.0 / *slope), true};
}

}  // namespace etendue
