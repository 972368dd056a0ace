// The library as another program sees it: public headers and the shared library only.
#include "program/small_files.h"

#include <algorithm>
#include <filesystem>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <etendue/etendue.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;

class Api : public testing::Test {
  protected:
    void SetUp() override {
        write_scene(box_);
        testing::internal::CaptureStderr();
        testing::internal::CaptureStdout();
    }
    /// Whoever embeds a library wants no words of it on his streams.
    void TearDown() override {
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    }

    [[nodiscard]] Error error_of(const std::string& settings) const {
        try {
            (void)render(Scene(box_, settings));
        } catch (const Error& error) {
            return error;
        }
        ADD_FAILURE() << settings;
        return {Error::Kind::Failed, "none", {}};
    }

    TestFolder folder_;
    fs::path box_ = folder_ / "box";
};

float brightest(const Picture& picture) {
    return std::ranges::max(picture.pixels());
}

TEST_F(Api, RendersWhatTheSceneAsksFor) {
    Scene scene(box_);
    EXPECT_EQ(scene.name(), "box");
    EXPECT_EQ(scene.width(), 16);
    EXPECT_EQ(scene.height(), 12);
    const Picture picture = render(std::move(scene));
    EXPECT_EQ(picture.width(), 16);
    EXPECT_EQ(picture.height(), 12);
    EXPECT_EQ(picture.pixels().size(), 16u * 12u * 4u);
    EXPECT_GT(brightest(picture), 0.0f);
    EXPECT_TRUE(picture.is_complete());
    EXPECT_EQ(picture.samples_per_pixel(), 2);
    EXPECT_EQ(picture.working_space(), "ACEScg");
    EXPECT_TRUE(picture.layers().empty());
}

TEST_F(Api, SettingsOverrideThoseOfTheSceneAndLeaveTheRest) {
    const Scene scene(box_, R"({"spp": 5, "aovs": ["depth", "N"], "crop": [2, 3, 10, 8]})");
    EXPECT_EQ(scene.width(), 8);
    EXPECT_EQ(scene.height(), 5);
    const Picture picture = render(scene, {.threads = 1});
    EXPECT_EQ(picture.samples_per_pixel(), 5);
    ASSERT_EQ(picture.layers().size(), 2u);
    EXPECT_EQ(picture.layers()[0].name, "depth");
    EXPECT_EQ(picture.layers()[0].values.size(), 8u * 5u);
    EXPECT_EQ(picture.layers()[1].name, "N");
    EXPECT_EQ(picture.layers()[1].values.size(), 8u * 5u * picture.layers()[1].channels.size());
    // A scene that was copied in can be rendered again, by any number of threads.
    const Picture again = render(scene, {.threads = 2});
    EXPECT_TRUE(std::ranges::equal(picture.pixels(), again.pixels()));
}

TEST_F(Api, ASceneNeedsNoRenderJson) {
    fs::remove(box_ / "render.json");
    EXPECT_EQ(render(Scene(box_, R"({"size": [4, 3], "spp": 1})")).pixels().size(), 4u * 3u * 4u);
}

TEST_F(Api, ErrorsNameFileAndPointer) {
    const Error typo = error_of(R"({"ssp": 3})");
    EXPECT_EQ(typo.kind(), Error::Kind::InvalidScene);
    EXPECT_EQ(typo.file(), "(settings)");
    EXPECT_EQ(typo.pointer(), "/ssp");
    EXPECT_NE(typo.messages().front().text.find("spp"), std::string::npos) << typo.what();
    const Error camera = error_of(R"({"camera": "mian"})");
    EXPECT_EQ(camera.file(), "(settings)");
    EXPECT_EQ(camera.pointer(), "/camera");
    EXPECT_EQ(error_of("{").file(), "(settings)");
    EXPECT_EQ(error_of("[1]").file(), "(settings)");
    EXPECT_EQ(error_of(R"({"integrator": {"type": "paht"}})").pointer(), "/integrator/type");

    write_file(box_ / "render.json", R"({"spp": 0, "seed": -1})");
    const Error two = error_of(R"({"seed": 4})");
    ASSERT_EQ(two.messages().size(), 1u) << "the seed is overridden";
    EXPECT_EQ(two.file(), (box_ / "render.json").string());
    EXPECT_EQ(two.pointer(), "/spp");
    EXPECT_THROW(Scene(folder_ / "nowhere"), Error);
}

TEST_F(Api, WarningsAreAList) {
    EXPECT_TRUE(Scene(box_).messages().empty());
    std::string text = read_file(box_ / "scene.gltf");
    text.replace(text.find(", \"camera\": 0"), 13, "");
    write_file(box_ / "scene.gltf", text);
    write_file(box_ / "render.json", R"({"size": [8, 8], "spp": 1})");
    const Scene scene(box_);
    ASSERT_FALSE(scene.messages().empty());
    EXPECT_NE(scene.messages().front().kind, Message::Kind::Error);
    EXPECT_NE(scene.messages().front().text.find("camera"), std::string::npos);
    EXPECT_FALSE(
        render(Scene(box_, R"({"min_spp": 4, "error": 0, "clamp_indirect": 1, "integrator": {"max_depth": 2}})"))
            .messages()
            .empty())
        << "what has no effect";
}

TEST_F(Api, ProgressComesUpToTheEnd) {
    std::vector<double> fractions;
    (void)render(Scene(box_), {.progress = [&](const Progress& now) { fractions.push_back(now.fraction); }});
    ASSERT_FALSE(fractions.empty());
    EXPECT_EQ(fractions.back(), 1.0);
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
}

TEST_F(Api, AStopLeavesWhatThereIs) {
    std::stop_source source;
    const Picture picture =
        render(Scene(box_, R"({"spp": 1000000})"),
               {.progress = [&](const Progress&) { source.request_stop(); }, .stop = source.get_token()});
    EXPECT_FALSE(picture.is_complete());
    EXPECT_GE(picture.samples_per_pixel(), 1);
    EXPECT_LT(picture.samples_per_pixel(), 1000000);
    EXPECT_GT(brightest(picture), 0.0f);
    EXPECT_FALSE(render(Scene(box_), {.stop = source.get_token()}).is_complete()) << "stopped before it began";
}

TEST_F(Api, WritesTheImageAndItsLayers) {
    const Picture picture = render(Scene(box_, R"({"aovs": ["depth"], "aov_layout": "files"})"));
    picture.write_exr(folder_ / "a.exr", Picture::Depth::Float);
    EXPECT_TRUE(fs::exists(folder_ / "a.exr"));
    EXPECT_TRUE(fs::exists(folder_ / "a.depth.exr"));
    const Picture copy = picture;  // NOLINT(performance-unnecessary-copy-initialization): what is tested
    copy.write_exr(folder_ / "b.exr", Picture::Depth::Float);
    EXPECT_EQ(fs::file_size(folder_ / "a.exr"), fs::file_size(folder_ / "b.exr"));
    EXPECT_THROW(picture.write_exr(folder_ / "nowhere/a.exr"), Error);
}

TEST_F(Api, AnImageReplacesNoInput) {
    render(Scene(box_)).write_exr(box_ / "sky.exr");
    const auto size = fs::file_size(box_ / "sky.exr");
    const Picture lit = render(Scene(box_, R"({"environment": {"image": "sky.exr"}})"));
    EXPECT_THROW(lit.write_exr(box_ / "sky.exr"), Error);
    EXPECT_THROW(lit.write_exr(box_ / "scene.gltf"), Error);
    EXPECT_EQ(fs::file_size(box_ / "sky.exr"), size);
}

TEST_F(Api, ThreadsHaveARange) {
    EXPECT_THROW((void)render(Scene(box_), {.threads = -1}), Error);
    EXPECT_THROW((void)render(Scene(box_), {.threads = 4097}), Error);
}

}  // namespace

}  // namespace etendue::test
