#include "batch/batch_jobs.h"

#include "process/process_limits.h"

#include <algorithm>

namespace etendue {

std::uint64_t memory_need(const PlannedUnit& unit, const BatchOptions& options) {
    const std::uint64_t estimate = std::max(unit.memory_bytes.value_or(kAllMemory), kLeastMemoryLimit);
    return std::min(estimate, options.max_memory.value_or(kAllMemory));
}

std::size_t usual_jobs(int threads) {
    constexpr int kThreadsOfEach = 4;
    return static_cast<std::size_t>(std::max(1, threads / kThreadsOfEach));
}

std::uint64_t memory_left(std::span<const JobShare> under_way, std::uint64_t free,
                          const std::optional<std::uint64_t>& budget) {
    std::uint64_t left = free;
    std::uint64_t left_of_budget = budget.value_or(kAllMemory);
    for (const JobShare& job : under_way) {
        const std::uint64_t takes = std::max(job.need, job.has);
        left -= std::min(left, takes - job.has);
        if (budget) left_of_budget -= std::min(left_of_budget, takes);
    }
    return std::min(left, left_of_budget);
}

int threads_of_next(std::span<const JobShare> under_way, std::span<const std::uint64_t> next_needs,
                    std::uint64_t memory, std::size_t jobs, int threads) {
    int free = threads;
    for (const JobShare& job : under_way) free -= job.threads;
    int beginning = 0;
    for (const std::uint64_t need : next_needs) {
        const bool is_full = under_way.size() + static_cast<std::size_t>(beginning) == jobs;
        if (beginning > 0 && (is_full || need > memory)) break;
        memory -= std::min(memory, need);
        ++beginning;
    }
    return std::max({1, threads / static_cast<int>(jobs), free / std::max(1, beginning)});
}

}  // namespace etendue
