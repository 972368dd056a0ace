#include "core/memory_nodes.h"

#include "support/temporary_folder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// What a test binds is a thread of its own.
template <typename Body>
void on_a_thread(Body body) {
    std::thread(std::move(body)).join();
}

std::vector<int> members(const ProcessorSet& set) {
    std::vector<int> all;
    for (int processor = 0; processor < ProcessorSet::kMostProcessors; ++processor)
        if (set.contains(processor)) all.push_back(processor);
    return all;
}

/// Adds a node to a folder of them, as sysfs has it.
void add_node(const TemporaryFolder& folder, const std::string& name, const std::string& processors) {
    fs::create_directory(folder / name);
    std::ofstream(folder / name / "cpulist") << processors << '\n';
}

TEST(ProcessorSet, HoldsWhatIsAdded) {
    ProcessorSet set;
    EXPECT_EQ(set.size(), 0);
    for (const int processor : {0, 3, 1500, ProcessorSet::kMostProcessors - 1}) set.add(processor);
    EXPECT_EQ(set.size(), 4);
    EXPECT_EQ(members(set), (std::vector{0, 3, 1500, ProcessorSet::kMostProcessors - 1}));
}

TEST(ProcessorSet, LeavesOutWhatNoMachineHas) {
    ProcessorSet set;
    set.add(-1);
    set.add(ProcessorSet::kMostProcessors);
    EXPECT_EQ(set.size(), 0);
    EXPECT_FALSE(set.contains(-1));
    EXPECT_FALSE(set.contains(ProcessorSet::kMostProcessors));
}

TEST(ProcessorSet, HasInCommonWhatBothHold) {
    ProcessorSet some;
    ProcessorSet others;
    for (const int processor : {1, 2, 2000}) some.add(processor);
    for (const int processor : {2, 3, 2000}) others.add(processor);
    EXPECT_EQ(members(some.common_with(others)), (std::vector{2, 2000}));
}

TEST(ProcessorSet, BindsTheCallingThread) {
    const std::vector<int> allowed = members(ProcessorSet::of_this_thread());
    ASSERT_FALSE(allowed.empty());
    on_a_thread([&] {
        ProcessorSet last;
        last.add(allowed.back());
        EXPECT_TRUE(last.bind_this_thread());
        EXPECT_EQ(members(ProcessorSet::of_this_thread()), std::vector{allowed.back()});
    });
    EXPECT_EQ(members(ProcessorSet::of_this_thread()), allowed) << "other threads stay as they are";
}

TEST(ProcessorSet, ChangesNothingWhereTheSystemRefuses) {
    on_a_thread([] {
        const std::vector<int> before = members(ProcessorSet::of_this_thread());
        EXPECT_FALSE(ProcessorSet().bind_this_thread());
        EXPECT_EQ(members(ProcessorSet::of_this_thread()), before);
    });
}

TEST(MemoryNodes, ThoseOfThisMachineHoldEveryProcessor) {
    const std::vector<ProcessorSet> nodes = memory_nodes();
    if (nodes.empty()) GTEST_SKIP() << "this system does not tell of memory nodes";
    for (const int processor : members(ProcessorSet::of_this_thread()))
        EXPECT_TRUE(std::any_of(nodes.begin(), nodes.end(), [&](const ProcessorSet& n) {
            return n.contains(processor);
        })) << processor;
}

TEST(MemoryNodes, AreInTheOrderOfTheirNumbers) {
    const std::vector<int> allowed = members(ProcessorSet::of_this_thread());
    if (allowed.size() < 2) GTEST_SKIP() << "needs two processors";
    const TemporaryFolder folder;
    add_node(folder, "node10", std::to_string(allowed[0]));
    add_node(folder, "node2", std::to_string(allowed[1]));
    const std::vector<ProcessorSet> nodes = memory_nodes(folder / "");
    ASSERT_EQ(nodes.size(), 2u);
    EXPECT_EQ(members(nodes[0]), std::vector{allowed[1]});
    EXPECT_EQ(members(nodes[1]), std::vector{allowed[0]});
}

TEST(MemoryNodes, HoldWhatTheThreadMayUseOnly) {
    const std::vector<int> allowed = members(ProcessorSet::of_this_thread());
    const TemporaryFolder folder;
    add_node(folder, "node0", "0-8191");
    add_node(folder, "node1", "");
    std::vector<ProcessorSet> nodes = memory_nodes(folder / "");
    ASSERT_EQ(nodes.size(), 1u) << "a node of memory alone is left out";
    EXPECT_EQ(members(nodes[0]), allowed);
    on_a_thread([&] {
        ProcessorSet first;
        first.add(allowed.front());
        ASSERT_TRUE(first.bind_this_thread());
        nodes = memory_nodes(folder / "");
    });
    ASSERT_EQ(nodes.size(), 1u);
    EXPECT_EQ(members(nodes[0]), std::vector{allowed.front()});
}

TEST(MemoryNodes, ListsMayHaveRangesAndSingles) {
    const std::vector<int> allowed = members(ProcessorSet::of_this_thread());
    if (allowed.size() < 2) GTEST_SKIP() << "needs two processors";
    const TemporaryFolder folder;
    const std::string first = std::to_string(allowed.front());
    const std::string last = std::to_string(allowed.back());
    add_node(folder, "node0", first + "-" + first + ",8000-8191," + last);
    add_node(folder, "node1", "8000-8191," + last);
    const std::vector<ProcessorSet> nodes = memory_nodes(folder / "");
    ASSERT_EQ(nodes.size(), 2u);
    EXPECT_EQ(members(nodes[0]), (std::vector{allowed.front(), allowed.back()}));
    EXPECT_EQ(members(nodes[1]), std::vector{allowed.back()});
}

TEST(MemoryNodes, WhatIsNoNodeOrNoListIsLeftOut) {
    const TemporaryFolder folder;
    add_node(folder, "power", "0-8191");
    add_node(folder, "node", "0-8191");
    add_node(folder, "node1x", "0-8191");
    add_node(folder, "node3", "every");
    add_node(folder, "node4", "-1");
    add_node(folder, "node5", "0-");
    add_node(folder, "node6", "99999999999999999999");
    fs::create_directory(folder / "node7");
    EXPECT_TRUE(memory_nodes(folder / "").empty());
    EXPECT_TRUE(memory_nodes(folder / "missing").empty());
}

}  // namespace

}  // namespace etendue
