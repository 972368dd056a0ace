#include "core/parallel.h"

#include <atomic>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

/// A denormal halved, without the compiler knowing the answer.
float half_of_the_smallest_normal() {
    volatile float smallest = std::numeric_limits<float>::min();
    return smallest * 0.5f;
}

TEST(ThreadPool, HasAsManyThreadsAsAskedFor) {
    for (const int count : {1, 2, 5}) EXPECT_EQ(ThreadPool(count).thread_count(), count);
    EXPECT_GE(ThreadPool().thread_count(), 1);
}

TEST(ThreadPool, CallsEveryIndexOnce) {
    for (const int threads : {1, 2, 5}) {
        const ThreadPool pool(threads);
        std::vector<std::atomic<int>> calls(10'000);
        pool.parallel_for(calls.size(), [&](std::size_t index, int) { ++calls[index]; });
        for (const auto& count : calls) ASSERT_EQ(count.load(), 1);
    }
}

TEST(ThreadPool, NoTwoCallsShareASlot) {
    const ThreadPool pool(4);
    std::vector<std::atomic<int>> users(4);
    std::atomic<bool> shared = false;
    pool.parallel_for(2000, [&](std::size_t, int slot) {
        ASSERT_GE(slot, 0);
        ASSERT_LT(slot, 4);
        if (users[static_cast<std::size_t>(slot)].fetch_add(1) != 0) shared = true;
        std::this_thread::yield();
        users[static_cast<std::size_t>(slot)].fetch_sub(1);
    });
    EXPECT_FALSE(shared);
}

TEST(ThreadPool, NothingToDoIsFine) {
    const ThreadPool pool(2);
    pool.parallel_for(0, [](std::size_t, int) { FAIL(); });
}

TEST(ThreadPool, ExceptionsLeaveThroughTheCaller) {
    const ThreadPool pool(2);
    EXPECT_THROW(pool.parallel_for(100,
                                   [](std::size_t index, int) {
                                       if (index == 37) throw std::runtime_error("tile 37");
                                   }),
                 std::runtime_error);
    std::atomic<int> calls = 0;
    pool.parallel_for(10, [&](std::size_t, int) { ++calls; });
    EXPECT_EQ(calls, 10) << "the pool works on";
}

TEST(ThreadPool, FlushesDenormalsInEveryCallOnly) {
    const ThreadPool pool(3);
    ASSERT_GT(half_of_the_smallest_normal(), 0.0f);
    std::atomic<int> kept = 0;
    pool.parallel_for(1000, [&](std::size_t, int) { kept += half_of_the_smallest_normal() != 0.0f ? 1 : 0; });
    EXPECT_EQ(kept, 0);
    pool.execute([&] { kept += half_of_the_smallest_normal() != 0.0f ? 1 : 0; });
    EXPECT_EQ(kept, 0);
    EXPECT_GT(half_of_the_smallest_normal(), 0.0f) << "the caller's mode is put back";
}

TEST(ThreadPool, NestedLoopsStayInTheArena) {
    const ThreadPool pool(3);
    std::atomic<int> calls = 0;
    pool.parallel_for(10, [&](std::size_t, int) { pool.parallel_for(10, [&](std::size_t, int) { ++calls; }); });
    EXPECT_EQ(calls, 100);
}

TEST(FlushDenormals, LastsAsLongAsItLives) {
    {
        const FlushDenormals flush;
        EXPECT_EQ(half_of_the_smallest_normal(), 0.0f);
        { const FlushDenormals inner; }
        EXPECT_EQ(half_of_the_smallest_normal(), 0.0f) << "an inner one does not end the outer one";
    }
    EXPECT_GT(half_of_the_smallest_normal(), 0.0f);
}

}  // namespace

}  // namespace etendue
