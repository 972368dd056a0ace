#include "batch/batch_sequences.h"

#include "program/small_files.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;

/// A stale image of `scene`; without a frame if that is none.
PlannedUnit stale_image(const fs::path& scene, std::optional<int> frame) {
    PlannedUnit unit;
    unit.task.job = {.scene = scene, .output = fmt::format("{}.exr", frame.value_or(0)), .name = "a", .frame = frame};
    unit.task.render_output = "out" / scene.filename();
    unit.reason = "never rendered";
    return unit;
}

std::vector<bool> which_begin(const FirstFrames& frames, const BatchPlan& plan) {
    std::vector<bool> which;
    for (std::size_t i = 0; i < plan.size(); ++i) which.push_back(frames.lets_begin(i));
    return which;
}

using Which = std::vector<bool>;

TEST(FirstFrames, AreWaitedForByThoseOfTheirSequence) {
    const TestFolder folder;
    for (const char* scene : {"a", "b"}) write_scene(folder / scene);
    const BatchPlan plan{stale_image(folder / "a", 9), stale_image(folder / "a", 7), stale_image(folder / "b", 1),
                         stale_image(folder / "b", std::nullopt), stale_image(folder / "b", 2)};
    FirstFrames frames(plan, {});
    EXPECT_EQ(which_begin(frames, plan), (Which{false, true, true, true, false}));
    frames.end(2, true);
    EXPECT_EQ(which_begin(frames, plan), (Which{false, true, true, true, true}));
    frames.end(1, true);
    EXPECT_EQ(which_begin(frames, plan), Which(5, true));
}

TEST(FirstFrames, GiveWayToTheNextIfTheyFail) {
    const TestFolder folder;
    write_scene(folder / "a");
    const BatchPlan plan{stale_image(folder / "a", 4), stale_image(folder / "a", 2), stale_image(folder / "a", 3)};
    FirstFrames frames(plan, {});
    EXPECT_EQ(which_begin(frames, plan), (Which{false, true, false}));
    frames.end(1, false);
    EXPECT_EQ(which_begin(frames, plan), (Which{false, false, true}));
    frames.end(2, true);
    EXPECT_TRUE(frames.lets_begin(0));
}

TEST(FirstFrames, AreNotWaitedForIfTheyAreUpToDate) {
    const TestFolder folder;
    write_scene(folder / "a");
    BatchPlan plan{stale_image(folder / "a", 1), stale_image(folder / "a", 2), stale_image(folder / "a", 3)};
    plan[0].reason.clear();
    EXPECT_EQ(which_begin(FirstFrames(plan, {}), plan), Which(3, true));
}

TEST(FirstFrames, AreNotWaitedForIfAnExposureIsAskedFor) {
    const TestFolder folder;
    write_scene(folder / "a", R"("color": {"exposure": 1},)");
    write_scene(folder / "b", R"("color": {},)");
    for (const bool is_given : {true, false}) {
        const BatchPlan plan{stale_image(folder / (is_given ? "a" : "b"), 1),
                             stale_image(folder / (is_given ? "a" : "b"), 2)};
        EXPECT_EQ(which_begin(FirstFrames(plan, {}), plan), (Which{true, is_given}));
        SettingsOverrides overrides;
        overrides.give("--exposure", "2");
        EXPECT_EQ(which_begin(FirstFrames(plan, overrides), plan), Which(2, true));
    }
}

}  // namespace

}  // namespace etendue::test
