#include "batch/batch_units.h"

#include "core/error.h"
#include "program/small_files.h"
#include "session/usage_error.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

using Names = std::vector<std::string>;

class BatchUnits : public testing::Test {
  protected:
    BatchUnits() {
        options_.roots = {(folder_ / "scenes").string()};
        options_.output = "out";
    }
    [[nodiscard]] std::vector<BatchTask> collect(const Names& variants = {}, const Names& cameras = {}) const {
        return collect_tasks(options_,
                             [&](const std::filesystem::path&) {
                                 return SceneNames{variants, cameras, cameras.empty() ? "" : cameras.front()};
                             })
            .chosen;
    }
    /// Returns the error that leaves no tasks; empty if there are tasks.
    [[nodiscard]] std::string message(const Names& variants = {}) const try {
        (void)collect(variants);
        return "";
    } catch (const SceneError& error) {
        return error.problems().all().front().message;
    } catch (const UsageError& error) {
        return error.what();
    }
    [[nodiscard]] static Names images(const std::vector<BatchTask>& tasks) {
        Names names;
        for (const BatchTask& task : tasks) names.push_back(task.job.output.string());
        return names;
    }

    TestFolder folder_;
    BatchOptions options_;
};

TEST_F(BatchUnits, AreOneForEachSceneAndFrame) {
    write_scene(folder_ / "scenes/a/still");
    write_scene(folder_ / "scenes/moving", R"("frames": [3, 9, 4],)");
    const std::vector<BatchTask> tasks = collect({"red"});
    EXPECT_EQ(images(tasks), (Names{"out/a/still.exr", "out/moving.0003.exr", "out/moving.0007.exr"}));
    EXPECT_EQ(tasks[2].id, "moving.0007");
    EXPECT_EQ(tasks[2].render_output, "out/moving.exr");
    EXPECT_EQ(tasks[2].job.frame, 7);
    EXPECT_FALSE(tasks[2].job.variant) << "they were not asked for";
}

TEST_F(BatchUnits, AreOneForEachVariantIfAsked) {
    write_scene(folder_ / "scenes/shoe");
    options_.all_variants = true;
    EXPECT_EQ(images(collect()), Names{"out/shoe.exr"});
    options_.overrides.give("--frames", "1:2");
    const std::vector<BatchTask> tasks = collect({"red", "blue"});
    EXPECT_EQ(images(tasks), (Names{"out/shoe.red.0001.exr", "out/shoe.red.0002.exr", "out/shoe.blue.0001.exr",
                                    "out/shoe.blue.0002.exr"}));
    EXPECT_EQ(tasks[1].job.variant, "red");
    EXPECT_EQ(tasks[1].job.name, "shoe variant red frame 2");
    EXPECT_EQ(tasks[1].render_output, "out/shoe.red.exr");
}

TEST_F(BatchUnits, AreOneForEachCameraIfAsked) {
    write_scene(folder_ / "scenes/shoe");
    options_.all_cameras = true;
    const std::vector<BatchTask> tasks = collect({"red"}, {"front", "top"});
    EXPECT_EQ(images(tasks), (Names{"out/shoe.front.exr", "out/shoe.top.exr"}));
    EXPECT_EQ(tasks[1].job.camera, "top");
    EXPECT_EQ(tasks[1].job.name, "shoe camera top");
    EXPECT_EQ(collect({}, {"Camera.001"})[0].job.name, "shoe Camera.001") << "it says itself what it is";
    options_.all_variants = true;
    EXPECT_EQ(images(collect({"red"}, {"front", "top"})), (Names{"out/shoe.red.front.exr", "out/shoe.red.top.exr"}));
}

TEST_F(BatchUnits, AreNamedAfterThePattern) {
    write_scene(folder_ / "scenes/a/still");
    write_scene(folder_ / "scenes/moving", R"("frames": [3, 9, 4],)");
    options_.all_cameras = true;
    options_.name_pattern = "{scene}/{frame}_{variant}-{camera}.v2";
    EXPECT_EQ(images(collect({}, {"top"})),
              (Names{"out/a/still/top.v2.exr", "out/moving/0003-top.v2.exr", "out/moving/0007-top.v2.exr"}));
    options_.name_pattern = "{scene}.{variant}.{frame}";
    EXPECT_EQ(images(collect({}, {})), (Names{"out/a/still.exr", "out/moving.0003.exr", "out/moving.0007.exr"}));
    options_.name_pattern = "{scene}/{variant}.{frame}";
    EXPECT_EQ(images(collect({}, {})), (Names{"out/a/still.exr", "out/moving/0003.exr", "out/moving/0007.exr"}))
        << "nothing is hidden";
    write_scene(folder_ / "scenes/other");
    options_.all_cameras = false;
    options_.name_pattern = "same";
    EXPECT_EQ(message(), "two files would be written to 'out/same.exr'; put {scene} into --name");
    options_.all_variants = true;
    options_.name_pattern = "{scene}";
    EXPECT_EQ(message({"red", "blue"}), "two files would be written to 'out/a/still.exr'; put {variant} into --name");
    for (const char* wrong : {"{shot}", "a{", "/abs/{scene}", "../{scene}", "{scene}/", "{scene}.exr", "{frame}/a", ""})
        EXPECT_THROW(check_name_pattern(wrong), UsageError) << wrong;
    EXPECT_NO_THROW(check_name_pattern("{scene}/{variant}/{camera}.{frame}"));
}

TEST_F(BatchUnits, KeepTheMarksOfTheNamesThatThePatternTakes) {
    write_scene(folder_ / "scenes/take_");
    options_.name_pattern = "{scene}{frame}";
    EXPECT_EQ(images(collect()), Names{"out/take_.exr"});
}

TEST_F(BatchUnits, HaveTheNameOfTheirCameraIfThePatternAsksForIt) {
    write_scene(folder_ / "scenes/a", R"("frames": [3, 3],)");
    options_.name_pattern = "{scene}/{camera}.{frame}";
    EXPECT_EQ(images(collect({}, {"top", "front"})), Names{"out/a/top.0003.exr"});
    EXPECT_FALSE(collect({}, {"top", "front"})[0].job.camera) << "nobody has asked for another one";
    EXPECT_EQ(images(collect()), Names{"out/a/camera.0003.exr"});
    EXPECT_EQ(images(collect({}, {"left/eye"})), Names{"out/a/left_eye.0003.exr"});
    options_.all_cameras = true;
    EXPECT_EQ(images(collect({}, {"top", "front"})), (Names{"out/a/top.0003.exr", "out/a/front.0003.exr"}));
}

TEST_F(BatchUnits, StayBelowTheOutputDirectoryWhateverThePatternIsGiven) {
    write_scene(folder_ / "scenes/a");
    options_.all_variants = true;
    for (const auto& [pattern, image] : {std::pair("{variant}/{scene}", "out/a.exr"),
                                         std::pair("{frame}/tmp/{variant}/{scene}/{frame}", "out/tmp/a.exr"),
                                         std::pair("x{variant}/{variant}../{scene}", "out/x/a.exr")}) {
        options_.name_pattern = pattern;
        EXPECT_EQ(images(collect()), Names{image}) << pattern;
    }
    options_.name_pattern = "{variant}/{scene}";
    EXPECT_EQ(images(collect({"..", "."})), (Names{"out/__/a.exr", "out/_/a.exr"}));
    for (const char* wrong : {"{variant}", "{variant}.{frame}", "x{variant}/./{scene}"}) {
        options_.name_pattern = wrong;
        EXPECT_THROW((void)collect(), UsageError) << wrong;
    }
}

TEST_F(BatchUnits, AreFilesIfTheseAreGiven) {
    write_scene(folder_ / "scenes/lib");
    std::filesystem::copy(folder_ / "scenes/lib/scene.gltf", folder_ / "scenes/lib/fox.gltf");
    options_.roots = {(folder_ / "scenes/lib/fox.gltf").string(), (folder_ / "scenes/lib/scene.gltf").string()};
    const std::vector<BatchTask> tasks = collect();
    EXPECT_EQ(images(tasks), (Names{"out/fox.exr", "out/scene.exr"}));
    EXPECT_EQ(tasks[0].job.scene.filename(), "fox.gltf");
}

TEST_F(BatchUnits, AndTheirScenesAreSafeFromTheLog) {
    write_scene(folder_ / "scenes/a");
    options_.log = folder_ / "scenes/a/render.json";
    EXPECT_THROW((void)collect(), ReplacedInput);
    for (const char* file : {"ledger.jsonl", "../out/a.json", "index.html"}) {
        options_.log = options_.output / file;
        EXPECT_THROW((void)collect(), UsageError) << file;
    }
    options_.log = options_.output / "night.log";
    EXPECT_EQ(collect().size(), 1u);
}

TEST_F(BatchUnits, CannotBeDenoisedByAnySettings) {
    write_scene(folder_ / "scenes/a");
    const BatchTask task = collect().front();
    EXPECT_EQ(why_not_denoised(task, options_), "");
    for (const std::vector<std::string>& wrong :
         {Names{"--spp", "1"}, Names{"--aov-layout", "files"}, Names{"--aces-container"}}) {
        BatchOptions options = options_;
        options.overrides.give(wrong[0], wrong.size() > 1 ? wrong[1] : "");
        EXPECT_TRUE(why_not_denoised(task, options).starts_with("error: --denoise: ")) << wrong[0];
    }
    write_scene(folder_ / "scenes/a", R"("aov_layout": "files",)");
    EXPECT_NE(why_not_denoised(task, options_), "");
}

TEST_F(BatchUnits, AreThoseThatGlobsChoose) {
    for (const char* scene : {"shots/a", "shots/b", "props/lamp"}) write_scene(folder_ / "scenes" / scene);
    options_.only = {"shots/*"};
    EXPECT_EQ(images(collect()), (Names{"out/shots/a.exr", "out/shots/b.exr"}));
    options_.only = {"shots", "l?mp"};
    options_.exclude = {"b"};
    EXPECT_EQ(images(collect()), (Names{"out/props/lamp.exr", "out/shots/a.exr"}));
    options_.overrides.give("--frames", "1:12");
    options_.only = {"*a.000[2-3]"};
    EXPECT_EQ(images(collect()), (Names{"out/shots/a.0002.exr", "out/shots/a.0003.exr"}));
    options_.only = {"a.000[2-3]"};
    EXPECT_EQ(images(collect()), (Names{"out/shots/a.0002.exr", "out/shots/a.0003.exr"}))
        << "its folder may be left out";
    options_.only = {"shot"};
    EXPECT_TRUE(message().starts_with("--only 'shot' matches no image; there are props/lamp.0001, ")) << message();
    options_.only = {"a"};
    options_.exclude = {"a.001?"};
    EXPECT_EQ(collect().size(), 9u);
    options_.exclude = {"nothing"};
    EXPECT_TRUE(message().starts_with("--exclude 'nothing' matches no image; there are ")) << message();
    options_.exclude = {"shots"};
    EXPECT_EQ(message(), "--only and --exclude leave no image");
    options_.only.clear();
    options_.exclude = {"*"};
    EXPECT_EQ(message(), "--exclude leaves no image");
}

TEST_F(BatchUnits, HaveFileNamesOfTheirOwnWhateverVariantsAreCalled) {
    write_scene(folder_ / "scenes/shoe");
    options_.all_variants = true;
    EXPECT_EQ(images(collect({"a/b", "a#b", "a_b", "a/b", "", "../..", "\n"})),
              (Names{"out/shoe.a_b.exr", "out/shoe.a_b-2.exr", "out/shoe.a_b-3.exr", "out/shoe..exr",
                     "out/shoe..._...exr", "out/shoe._.exr"}));
    EXPECT_LT(images(collect({std::string(1000, 'x')})).front().size(), 200u);
}

TEST_F(BatchUnits, OfOneFileAreAnError) {
    write_scene(folder_ / "scenes/shoe.red");
    write_scene(folder_ / "scenes/shoe");
    options_.all_variants = true;
    EXPECT_EQ(collect().size(), 2u);
    EXPECT_THROW((void)collect_tasks(options_,
                                     [](const std::filesystem::path& scene) {
                                         return SceneNames{scene.extension() == ".red" ? Names{} : Names{"red"}, {}};
                                     }),
                 SceneError);
}

TEST_F(BatchUnits, WriteNoLayerOverAnImage) {
    for (const char* name : {"a", "a.deep", "a.depth", "a.v2"}) write_scene(folder_ / "scenes" / name);
    EXPECT_EQ(collect().size(), 4u) << "without layers that have files of their own";
    options_.overrides.deep = true;
    EXPECT_THROW((void)collect(), SceneError);
    std::filesystem::remove_all(folder_ / "scenes/a.deep");
    EXPECT_EQ(collect().size(), 3u);
    options_.overrides.give("--aov", "depth");
    EXPECT_EQ(collect().size(), 3u) << "in the image's own file";
    options_.overrides.give("--aov-layout", "files");
    try {
        (void)collect();
        ADD_FAILURE() << "a.depth.exr has two images";
    } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what()).find("two files would be written to 'out/a.depth.exr'"), std::string::npos)
            << error.what();
    }
    std::filesystem::remove_all(folder_ / "scenes/a.depth");
    options_.overrides.given.erase("/aovs");
    options_.overrides.give("--aov", "denoising");
    EXPECT_EQ(collect().size(), 2u);
    write_scene(folder_ / "scenes/a.half_N");
    EXPECT_THROW((void)collect(), SceneError);
}

// A layer that is named after a lamp of the scene.
TEST_F(BatchUnits, WriteNoLayerOfALampOverAnImage) {
    write_scene(folder_ / "scenes/a", R"("lights": {"Key": {"type": "point", "power": 1, "position": [0, 0, 0]}},)");
    write_scene(folder_ / "scenes/a.light_Key");
    options_.overrides.give("--aov", "lights");
    EXPECT_EQ(collect().size(), 2u) << "in the image's own file";
    options_.overrides.give("--aov-layout", "files");
    try {
        (void)collect();
        ADD_FAILURE() << "a.light_Key.exr has two images";
    } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what()).find("two files would be written to 'out/a.light_Key.exr'"),
                  std::string::npos)
            << error.what();
    }
    write_scene(folder_ / "scenes/a", R"("lights": {"Fill": {"type": "point", "power": 1, "position": [0, 0, 0]}},)");
    EXPECT_EQ(collect().size(), 2u);
}

TEST_F(BatchUnits, WriteNoPreviewOverAnImage) {
    write_scene(folder_ / "scenes/a");
    write_scene(folder_ / "scenes/a.preview");
    EXPECT_THROW((void)collect(), SceneError);
}

TEST_F(BatchUnits, AreCutBetweenCharactersOfVariants) {
    write_scene(folder_ / "scenes/shoe");
    options_.all_variants = true;
    EXPECT_EQ(images(collect({std::string(99, 'x') + "é", "a\u009b\u202e"})),
              (Names{"out/shoe." + std::string(99, 'x') + ".exr", "out/shoe.a__.exr"}));
}

TEST_F(BatchUnits, AreNoneOfVariantsThatNoCommandLineCanName) {
    write_scene(folder_ / "scenes/shoe");
    options_.all_variants = true;
    EXPECT_THROW((void)collect({std::string("a\0b", 3)}), SceneError);
}

TEST_F(BatchUnits, MayNotTakeThePlaceOfTheReport) {
    write_scene(folder_ / "scenes/report");
    EXPECT_THROW((void)collect(), SceneError);
}

}  // namespace

}  // namespace etendue::test
