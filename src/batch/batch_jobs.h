// What images that are rendered at the same time take of the machine, and whether there is room for another.
#pragma once

#include "batch/batch_options.h"
#include "batch/batch_plan.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace etendue {

/// Stands for the memory of an image whose need is unknown, which is rendered alone.
inline constexpr std::uint64_t kAllMemory = std::numeric_limits<std::uint64_t>::max();

/// Returns the bytes of memory that the process of an image will need: what was estimated, kLeastMemoryLimit at least
/// and --max-memory at most.
[[nodiscard]] std::uint64_t memory_need(const PlannedUnit& unit, const BatchOptions& options);

/// Returns how many images are rendered at the same time by `threads` threads, if nothing else is asked for.
[[nodiscard]] std::size_t usual_jobs(int threads);

/// Holds what an image under way takes.
struct JobShare {
    std::uint64_t need = 0;  ///< bytes of memory that it was expected to need
    std::uint64_t has = 0;   ///< bytes of memory that it has
    int threads = 0;
};

/// Returns the bytes of memory for another image beside those under way: what is `free` now, without what they will
/// still take, and within `budget`, which they share.
[[nodiscard]] std::uint64_t memory_left(std::span<const JobShare> under_way, std::uint64_t free,
                                        const std::optional<std::uint64_t>& budget);

/// Returns how many of `threads` threads the image gets that begins now: those that are free, divided among as many
/// images as can begin now, and no less than its share among `jobs`. `next_needs` are its need of memory and those of
/// the images after it, which have `memory`.
[[nodiscard]] int threads_of_next(std::span<const JobShare> under_way, std::span<const std::uint64_t> next_needs,
                                  std::uint64_t memory, std::size_t jobs, int threads);

}  // namespace etendue
