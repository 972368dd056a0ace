// What follows from the numbers of a profile: rates, shares, what tiles cost.
#pragma once

#include "report/profile_report.h"

#include <vector>

namespace etendue {

/// Returns the median: the mean of the two values in the middle if their number is even, NaN if there is none.
[[nodiscard]] double median(std::vector<double> values);

/// Returns a / b, or NaN unless both are finite and b is positive.
[[nodiscard]] double rate(double a, double b);

/// Returns the rays per second on the clock, by the median of the repetitions.
[[nodiscard]] double rays_per_second(const ProfileRun& run);
[[nodiscard]] double samples_per_second(const ProfileRun& run);

/// Returns the rays per second of one thread while the renderer traces this kind; NaN if it spent no time on the kind.
[[nodiscard]] double rays_per_second(const RayKindReport& kind);

/// Returns the share of the time of all stages in which rays of all kinds were traced, [0, 1].
[[nodiscard]] double tracing_share(const ProfileRun& run);

[[nodiscard]] double sum_of(const std::vector<NamedValue>& values);

/// A place of the image in all passes of a run together.
struct TileCost {
    PixelRect rect{};
    double seconds = 0.0;
    double share = 0.0;  ///< share of the time of all tiles, [0, 1]
};

/// Returns the most expensive tiles of `run`, at most `count`, the most expensive first.
[[nodiscard]] std::vector<TileCost> most_expensive_tiles(const ProfileRun& run, std::size_t count);

}  // namespace etendue
