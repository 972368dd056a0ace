// What follows from the numbers of a profile: rates, shares, what tiles cost.
#pragma once

#include "report/profile_report.h"

#include <cstddef>
#include <limits>
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

/// A place of the image in all passes of a run together. Its thread's processor time counts, so that what other
/// programs took does not, and the median over passes of that of a sample, so that one slow pass does not.
struct TileCost {
    PixelRect rect{};
    double cpu_seconds_per_sample = 0.0;
    double cpu_seconds = 0.0;  ///< CPU seconds of all samples
    double share = 0.0;        ///< share of the CPU time of all tiles, [0, 1]
};

/// Returns the tiles of `run`, the most expensive first, at most `count`.
[[nodiscard]] std::vector<TileCost> most_expensive_tiles(const ProfileRun& run,
                                                         std::size_t count = std::numeric_limits<std::size_t>::max());

/// Returns the median over the repetitions of the CPU seconds of a sample.
[[nodiscard]] double cpu_seconds_per_sample(const ProfileRun& run);

}  // namespace etendue
