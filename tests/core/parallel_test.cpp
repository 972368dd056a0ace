#include "core/parallel.h"

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <span>
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

/// One node for each of two processors that this process may use; fewer where there are not two.
std::vector<ProcessorSet> nodes_of_one_processor_each() {
    const ProcessorSet allowed = ProcessorSet::of_this_thread();
    std::vector<ProcessorSet> nodes;
    for (int processor = 0; processor < ProcessorSet::kMostProcessors && nodes.size() < 2; ++processor)
        if (allowed.contains(processor)) nodes.emplace_back().add(processor);
    return nodes;
}

/// Where the thread in each of the pool's slots may run, which is the same in all of its calls.
std::vector<ProcessorSet> processors_of_slots(const ThreadPool& pool) {
    std::vector<ProcessorSet> found(static_cast<std::size_t>(pool.thread_count()));
    std::atomic<int> differing = 0;
    pool.parallel_for(2000, [&](std::size_t, int slot) {
        ProcessorSet& known = found[static_cast<std::size_t>(slot)];
        const ProcessorSet now = ProcessorSet::of_this_thread();
        if (known.size() == 0) known = now;
        if (known.common_with(now).size() != known.size() || known.size() != now.size()) ++differing;
        std::this_thread::sleep_for(std::chrono::microseconds(20));  // so that every slot is taken
    });
    EXPECT_EQ(differing, 0);
    return found;
}

TEST(ThreadPool, KeepsEverySlotOnAMemoryNode) {
    const std::vector<ProcessorSet> nodes = nodes_of_one_processor_each();
    if (nodes.size() < 2) GTEST_SKIP() << "needs two processors";
    const int free_processors = ProcessorSet::of_this_thread().size();
    for (const int threads : {2, 3, 6}) {
        const ThreadPool pool(threads, nodes);
        const std::vector<ProcessorSet> slots = processors_of_slots(pool);
        int on_the_first = 0;
        for (std::size_t slot = 0; slot < slots.size(); ++slot) {
            if (slots[slot].size() == 0) continue;  // no worker came to it
            EXPECT_EQ(slots[slot].size(), 1);
            const bool first = static_cast<int>(slot) < threads / 2;
            EXPECT_EQ(slots[slot].common_with(nodes[first ? 0 : 1]).size(), 1) << "slot " << slot << " of " << threads;
            on_the_first += first ? 1 : 0;
        }
        EXPECT_GE(on_the_first, 1) << "the caller";
        EXPECT_EQ(ProcessorSet::of_this_thread().size(), free_processors) << "the caller goes free again";
    }
}

void expect_free_slots(const ThreadPool& pool, int free_processors) {
    for (const ProcessorSet& slot : processors_of_slots(pool)) {
        if (slot.size() == 0) continue;  // no worker came to it
        EXPECT_EQ(slot.size(), free_processors);
    }
}

TEST(ThreadPool, BindsNobodyWhereItIsSmallerThanTheMachineOrThereIsOneNode) {
    const std::vector<ProcessorSet> nodes = nodes_of_one_processor_each();
    if (nodes.size() < 2) GTEST_SKIP() << "needs two processors";
    const int free_processors = ProcessorSet::of_this_thread().size();
    expect_free_slots(ThreadPool(1, nodes), free_processors);
    expect_free_slots(ThreadPool(2, std::span(nodes).first(1)), free_processors);
    expect_free_slots(ThreadPool(2, {}), free_processors);
}

TEST(ThreadPool, WorkersThatABoundCallerStartedAreFreeInOtherPools) {
    const std::vector<ProcessorSet> nodes = nodes_of_one_processor_each();
    if (nodes.size() < 2) GTEST_SKIP() << "needs two processors";
    const int free_processors = ProcessorSet::of_this_thread().size();
    processors_of_slots(ThreadPool(3, nodes));
    expect_free_slots(ThreadPool(3, {}), free_processors);
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
