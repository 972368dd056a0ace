// What follows from the numbers of a profile: rates, shares, what tiles cost.
#pragma once

#include "report/profile_report.h"

#include <vector>

namespace etendue {

/// NaN of none; the mean of the two in the middle of an even number.
[[nodiscard]] double median(std::vector<double> values);

/// a / b, NaN unless both are finite and b is positive.
[[nodiscard]] double rate(double a, double b);

/// On the clock, by the median of the repetitions.
[[nodiscard]] double rays_per_second(const ProfileRun& run);
[[nodiscard]] double samples_per_second(const ProfileRun& run);

/// Of one thread while the renderer traces this kind.
[[nodiscard]] double rays_per_second(const RayKindReport& kind);

/// Of the time of all stages, that which rays of all kinds were traced in, [0, 1].
[[nodiscard]] double tracing_share(const ProfileRun& run);

[[nodiscard]] double sum_of(const std::vector<NamedValue>& values);

/// A place of the image in all passes of a run together.
struct TileCost {
    PixelRect rect{};
    double seconds = 0.0;
    double share = 0.0;  ///< of the time of all tiles, [0, 1]
};

/// The most expensive of `run`, at most `count`, those that cost most first.
[[nodiscard]] std::vector<TileCost> most_expensive_tiles(const ProfileRun& run, std::size_t count);

}  // namespace etendue
