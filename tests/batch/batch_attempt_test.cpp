#include "batch/batch_attempt.h"

#include "program/small_files.h"

#include <chrono>
#include <filesystem>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;

TEST(AttemptHere, EndsWithoutAnImageOnceTheLockIsLost) {
    constexpr double kSeconds = 8.0;
    const TestFolder folder;
    write_scene(folder / "a");
    write_file(folder / "a/render.json", R"({"size": [16, 12], "spp": 10000000, "time": 8, "environment": {}})");
    fs::create_directories(folder / "out");
    const BatchTask task{{folder / "a", folder / "out/a.exr", "a", {}}, folder / "out/a.exr", "a"};
    const auto start = std::chrono::steady_clock::now();
    const Attempt attempt = attempt_here(
        task, {.quiet = true}, {}, "a", [] { return false; }, ThreadPool(1));
    EXPECT_EQ(attempt.end, AttemptEnd::LockLost) << attempt.error;
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), kSeconds);
    EXPECT_FALSE(fs::exists(folder / "out/a.exr"));
    EXPECT_FALSE(fs::exists(folder / "out/a.checkpoint"));
}

}  // namespace

}  // namespace etendue::test
