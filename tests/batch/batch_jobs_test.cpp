#include "batch/batch_jobs.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr std::uint64_t kGibibyte = std::uint64_t{1} << 30u;

TEST(MemoryNeed, IsTheEstimateAndWhatIsAllowedAtMost) {
    PlannedUnit unit;
    EXPECT_EQ(memory_need(unit, {}), kAllMemory);
    EXPECT_EQ(memory_need(unit, {.max_memory = 4 * kGibibyte}), 4 * kGibibyte);
    unit.memory_bytes = 6 * kGibibyte;
    EXPECT_EQ(memory_need(unit, {}), 6 * kGibibyte);
    EXPECT_EQ(memory_need(unit, {.max_memory = 4 * kGibibyte}), 4 * kGibibyte);
    EXPECT_EQ(memory_need(unit, {.max_memory = 8 * kGibibyte}), 6 * kGibibyte);
    unit.memory_bytes = 1;
    EXPECT_EQ(memory_need(unit, {}), kGibibyte / 4) << "the program itself may need that";
}

TEST(MemoryLeft, IsWhatIsFreeWithoutWhatWillStillBeTaken) {
    const std::vector<JobShare> under_way{{.need = 6 * kGibibyte, .has = 2 * kGibibyte},
                                          {.need = 1 * kGibibyte, .has = 3 * kGibibyte}};
    EXPECT_EQ(memory_left({}, 10 * kGibibyte, std::nullopt), 10 * kGibibyte);
    EXPECT_EQ(memory_left(under_way, 10 * kGibibyte, std::nullopt), 6 * kGibibyte);
    EXPECT_EQ(memory_left(under_way, 3 * kGibibyte, std::nullopt), 0u);
    EXPECT_EQ(memory_left(under_way, 10 * kGibibyte, 11 * kGibibyte), 2 * kGibibyte);
    EXPECT_EQ(memory_left(under_way, 10 * kGibibyte, 8 * kGibibyte), 0u);
    EXPECT_EQ(memory_left({}, 10 * kGibibyte, 8 * kGibibyte), 8 * kGibibyte);
    const std::vector<JobShare> unknown{{.need = kAllMemory, .has = kGibibyte}};
    EXPECT_EQ(memory_left(unknown, 10 * kGibibyte, std::nullopt), 0u) << "it is alone";
}

/// Begins one image after the other, and returns their threads.
std::vector<int> threads_of(std::vector<std::uint64_t> needs, std::uint64_t memory, std::size_t jobs, int threads) {
    std::vector<JobShare> under_way;
    std::vector<int> result;
    while (!needs.empty() && under_way.size() < jobs) {
        result.push_back(threads_of_next(under_way, needs, memory, jobs, threads));
        under_way.push_back({.need = needs.front(), .threads = result.back()});
        memory -= std::min(memory, needs.front());
        needs.erase(needs.begin());
    }
    return result;
}

TEST(ThreadsOfNext, DividesThemAmongThoseThatBeginTogether) {
    EXPECT_EQ(threads_of({1, 1, 1, 1}, 100, 3, 16), (std::vector{5, 5, 6}));
    EXPECT_EQ(threads_of({1}, 100, 3, 16), (std::vector{16})) << "the last one has all";
    EXPECT_EQ(threads_of({1, 1}, 100, 3, 16), (std::vector{8, 8}));
    EXPECT_EQ(threads_of({1, 1, 1}, 100, 3, 2), (std::vector{1, 1, 1})) << "each has one at least";
    EXPECT_EQ(threads_of({60, 60, 1}, 100, 1, 16), (std::vector{16}));
}

TEST(ThreadsOfNext, ThoseWithoutMemoryGetNone) {
    const std::array<std::uint64_t, 3> needs{60, 60, 1};
    EXPECT_EQ(threads_of_next({}, needs, 100, 3, 16), 16) << "the second has to wait, and with it the third";
    EXPECT_EQ(threads_of_next({}, needs, 120, 3, 16), 8);
    const std::array<JobShare, 1> all{{{.need = 60, .threads = 16}}};
    EXPECT_EQ(threads_of_next(all, needs, 100, 3, 16), 5) << "one that comes after all has its share all the same";
    EXPECT_EQ(threads_of_next({}, std::array{kAllMemory, std::uint64_t{1}}, 100, 2, 16), 16);
}

TEST(UsualJobs, IsOneForEveryFourThreads) {
    EXPECT_EQ(usual_jobs(1), 1u);
    EXPECT_EQ(usual_jobs(7), 1u);
    EXPECT_EQ(usual_jobs(64), 16u);
}

}  // namespace

}  // namespace etendue::test
