#include "session/image_job.h"

#include "program/small_files.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(FramePath, NumbersStandWhereTheyAreAskedForOrBeforeTheExtension) {
    EXPECT_EQ(frame_path("shot.exr", 7), "shot.0007.exr");
    EXPECT_EQ(frame_path("a.b/shot.v2.exr", 12345), "a.b/shot.v2.12345.exr");
    EXPECT_EQ(frame_path("shot.exr", -7), "shot.-0007.exr");
    EXPECT_EQ(frame_path("out/shot_####_left.exr", 7), "out/shot_0007_left.exr");
    EXPECT_EQ(frame_path("##/#######.exr", 7), "##/0000007.exr");
    EXPECT_EQ(frame_path("#.#.exr", 7), "#.0007.exr");
}

TEST(ImageJobs, TheCommandLinesFramesComeBeforeTheScenes) {
    const TestFolder folder;
    write_scene(folder.path());
    EXPECT_EQ(image_jobs(folder.path(), "a.exr", "a", {}).size(), 1u);
    EXPECT_EQ(image_jobs(folder.path(), "a.exr", "a", {})[0].output, "a.exr");
    write_file(folder / "render.json", R"({"frames": [3, 9, 4]})");
    const std::vector<ImageJob> jobs = image_jobs(folder.path(), "a.exr", "a", {});
    ASSERT_EQ(jobs.size(), 2u);
    EXPECT_EQ(jobs[1].output, "a.0007.exr");
    EXPECT_EQ(jobs[1].frame, 7);
    SettingsOverrides moment;
    moment.give("--time-code", "1.5");
    EXPECT_EQ(image_jobs(folder.path(), "a.exr", "a", moment)[0].output, "a.exr");
    SettingsOverrides overrides;
    overrides.give("--frames", "1");
    EXPECT_EQ(image_jobs(folder / "scene.gltf", "a.exr", "a", overrides)[0].output, "a.0001.exr");
}

}  // namespace

}  // namespace etendue::test
