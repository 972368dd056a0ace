#include "process/memory_left.h"

#include "program/small_files.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace etendue::test {

namespace {

TEST(FreeMemory, IsWhatTheMachineAndAllGroupsLeave) {
    const TestFolder folder;
    const auto free = [&] { return free_memory_bytes(folder / "proc", folder / "groups"); };
    for (const char* directory : {"proc/self", "groups/user/job"})
        std::filesystem::create_directories(folder / directory);
    write_file(folder / "proc/meminfo", "MemTotal:       9000 kB\nMemFree:        100 kB\nMemAvailable:   8000 kB\n");
    EXPECT_EQ(free(), 8000u * 1024) << "without groups";
    write_file(folder / "proc/self/cgroup", "1:name=other:/elsewhere\n0::/user/job\n");
    write_file(folder / "groups/user/job/memory.max", "max\n");
    write_file(folder / "groups/user/job/memory.current", "1000000\n");
    EXPECT_EQ(free(), 8000u * 1024) << "a group without a limit";
    write_file(folder / "groups/user/memory.max", "5000000\n");
    write_file(folder / "groups/user/memory.current", "2000000\n");
    EXPECT_EQ(free(), 3000000u) << "that of the group around it";
    write_file(folder / "groups/user/memory.stat", "anon 1\ninactive_file 500000\nactive_file 7\n");
    EXPECT_EQ(free(), 3500000u) << "caches can be given up";
    write_file(folder / "groups/user/job/memory.max", "900000\n");
    EXPECT_EQ(free(), 0u) << "it has more than it may";
}

TEST(FreeMemory, OfThisMachineIsSome) {
    EXPECT_GT(free_memory_bytes(), 0u);
}

TEST(ProcessMemory, GrowsWithWhatIsWritten) {
    constexpr std::size_t kBytes = std::size_t{64} << 20u;
    const std::uint64_t before = process_memory_bytes(getpid());
    const std::vector<char> bytes(kBytes, 'x');
    EXPECT_GT(process_memory_bytes(getpid()), before + kBytes / 2) << bytes.back();
    EXPECT_EQ(process_memory_bytes(-1), 0u);
}

}  // namespace

}  // namespace etendue::test
