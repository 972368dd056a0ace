#include "core/parallel.h"

#include "core/error.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

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

// As with 'ulimit -u', which does not hold for root.
TEST(ThreadPool, IsAnErrorWhereThreadsCannotBeStarted) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers take more address space than can be limited";
#endif
    rlimit old{};
    ASSERT_EQ(::getrlimit(RLIMIT_AS, &old), 0);
    std::ifstream statm("/proc/self/statm");
    rlim_t pages = 0;
    statm >> pages;
    const rlimit limit{pages * 4096 + (rlim_t{256} << 20), old.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_AS, &limit), 0);
    std::string error;
    try {
        const ThreadPool pool(1000);
    } catch (const IoError& failure) {
        error = failure.what();
    }
    ::setrlimit(RLIMIT_AS, &old);
    EXPECT_NE(error.find("of 1004 threads can be started, 4 of them for libraries"), std::string::npos) << error;
    EXPECT_EQ(ThreadPool(2).thread_count(), 2);
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

/// One node for each of two processors that this process may use; fewer where there are not two.
std::vector<ProcessorSet> nodes_of_one_processor_each() {
    const ProcessorSet allowed = ProcessorSet::of_this_thread();
    std::vector<ProcessorSet> nodes;
    for (int processor = 0; processor < ProcessorSet::kMostProcessors && nodes.size() < 2; ++processor)
        if (allowed.contains(processor)) nodes.emplace_back().add(processor);
    return nodes;
}

/// Where the threads in the pool's slots may run while they stay on their nodes, and that they go where they might
/// before afterwards. Ends when every slot had a thread, or with empty sets for those that had none for seconds.
std::vector<ProcessorSet> processors_of_slots(const ThreadPool& pool) {
    const ProcessorSet free = ProcessorSet::of_this_thread();
    std::vector<ProcessorSet> found(static_cast<std::size_t>(pool.thread_count()));
    std::atomic<int> wrong = 0;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    do {
        pool.parallel_for(100, [&](std::size_t, int slot) {
            {
                const NodeBinding::Stay stay = pool.stay_on_node(slot);
                ProcessorSet& known = found[static_cast<std::size_t>(slot)];
                const ProcessorSet now = ProcessorSet::of_this_thread();
                if (known == ProcessorSet()) known = now;
                if (known != now) ++wrong;
                std::this_thread::sleep_for(std::chrono::microseconds(50));  // for the others to come
            }
            if (ProcessorSet::of_this_thread() != free) ++wrong;
        });
    } while (std::count(found.begin(), found.end(), ProcessorSet()) > 0 && std::chrono::steady_clock::now() < deadline);
    EXPECT_EQ(wrong, 0);
    return found;
}

TEST(ThreadPool, SlotsStayOnTheirMemoryNode) {
    const std::vector<ProcessorSet> nodes = nodes_of_one_processor_each();
    if (nodes.size() < 2) GTEST_SKIP() << "needs two processors";
    for (const int threads : {2, 3, 6}) {
        const std::vector<ProcessorSet> slots = processors_of_slots(ThreadPool(threads, nodes));
        for (int slot = 0; slot < threads; ++slot)
            EXPECT_EQ(slots[static_cast<std::size_t>(slot)], nodes[slot < threads / 2 ? 0 : 1])
                << "slot " << slot << " of " << threads;
    }
}

TEST(ThreadPool, SlotsGoWhereTheSystemSendsThemIfThereAreFewOrThereIsOneNode) {
    const std::vector<ProcessorSet> nodes = nodes_of_one_processor_each();
    if (nodes.size() < 2) GTEST_SKIP() << "needs two processors";
    const ProcessorSet free = ProcessorSet::of_this_thread();
    EXPECT_EQ(processors_of_slots(ThreadPool(1, nodes)), std::vector(1, free));
    EXPECT_EQ(processors_of_slots(ThreadPool(2, std::span(nodes).first(1))), std::vector(2, free));
    EXPECT_EQ(processors_of_slots(ThreadPool(2, {})), std::vector(2, free));
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
