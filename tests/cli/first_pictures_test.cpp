// What a first render shows: the studio, the exposure of the PNG, shadow catchers.
#include "image/read.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "support/temporary_folder.h"
#include "support/text.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class FirstPictures : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(work_); }

    [[nodiscard]] ProgramResult run(const std::vector<std::string>& arguments) const {
        return run_etendue(arguments, work_);
    }
    /// Makes the small scene without its environment.
    void write_dark_scene(const std::string& name) const {
        write_scene(work_ / name);
        json settings = json::parse(read_file(work_ / name / "render.json"));
        settings.erase("environment");
        settings["integrator"]["type"] = "path";
        write_file(work_ / name / "render.json", settings.dump());
    }
    /// Renders and returns what stderr says.
    std::string render(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "render");
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.err;
    }
    [[nodiscard]] json exposure_of(const std::string& name) const {
        return json::parse(read_file(work_ / (name + ".json"))).at("exposure");
    }
    /// Returns the red of the first pixel, which shows no triangle.
    [[nodiscard]] float corner(const std::string& exr) const { return read_image_float(work_ / exr).pixels.at(0); }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(FirstPictures, SceneWithoutLightGetsAStudio) {
    write_dark_scene("a");
    const std::string said = render({"a", "-o", "a.exr"});
    EXPECT_TRUE(contains(said, "lit by a studio, whose ground --no-ground leaves out")) << said;
    EXPECT_NEAR(corner("a.exr"), 0.5f, 0.01f) << "the backdrop";
    const json with = json::parse(read_file(work_ / "a.json"));

    EXPECT_TRUE(contains(render({"a", "--no-ground", "-o", "b.exr"}), "lit by a studio;"));
    EXPECT_LT(json::parse(read_file(work_ / "b.json")).at("triangles"), with.at("triangles"));

    EXPECT_TRUE(contains(render({"a", "--environment", "none", "-o", "c.exr"}), "the image is black"));
    EXPECT_EQ(corner("c.exr"), 0.0f);

    EXPECT_FALSE(contains(render({"a", "--environment", "neutral", "-o", "d.exr"}), "studio"));
    EXPECT_NEAR(corner("d.exr"), 1.0f, 0.001f);
}

TEST_F(FirstPictures, StudioTakesThePlaceOfAnEnvironment) {
    write_scene(work_ / "a");
    EXPECT_FALSE(contains(render({"a", "-o", "a.exr"}), "studio"));
    EXPECT_NEAR(corner("a.exr"), 1.0f, 0.001f);
    (void)render({"a", "--studio", "-o", "b.exr"});
    EXPECT_NEAR(corner("b.exr"), 0.5f, 0.01f);
    const ProgramResult both = run({"render", "a", "--studio", "--environment", "neutral", "-o", "c.exr"});
    EXPECT_EQ(both.exit_code, 3) << both.err;
    EXPECT_TRUE(contains(both.err, "--studio puts another light in its place")) << both.err;
}

TEST_F(FirstPictures, PngGetsTheExposureThatItsImageAsksFor) {
    write_scene(work_ / "a");
    const std::string settings = read_file(work_ / "a/render.json");
    write_file(work_ / "a/render.json", std::string(settings).replace(settings.find("\"environment\": {}"), 17,
                                                                      R"("environment": {"scale": 6})"));
    const std::string said = render({"a", "--float", "-o", "a.exr"});
    EXPECT_TRUE(contains(said, "a.png: exposure -2.41 stops (chosen; --exposure sets it): half of it")) << said;
    EXPECT_NEAR(exposure_of("a").at("stops").get<double>(), std::log2(1.5 / 8.0), 0.011)
        << "the triangle is the brightest, at 8";
    EXPECT_TRUE(exposure_of("a").at("chosen").is_string());
    EXPECT_NEAR(corner("a.exr"), 6.0f, 0.01f) << "the EXR stays";
    // The EXR tells it to others.
    EXPECT_EQ(run({"view", "a.exr", "-o", "view.png"}).exit_code, 0);
    EXPECT_EQ(read_image_8bit(work_ / "view.png").pixels, read_image_8bit(work_ / "a.png").pixels);

    const std::string asked = render({"a", "--exposure", "1", "-o", "b.exr", "--view", "Un-tone-mapped"});
    EXPECT_FALSE(contains(asked, "exposure +1")) << asked;
    EXPECT_TRUE(contains(asked, "% of the pixels are as bright as it can show; a lower --exposure")) << asked;
    EXPECT_EQ(exposure_of("b").at("stops"), 1.0);
    EXPECT_TRUE(exposure_of("b").at("chosen").is_null());
    EXPECT_GT(exposure_of("b").at("clipped_share"), 0.05);
    EXPECT_NE(read_image_8bit(work_ / "view.png").pixels, read_image_8bit(work_ / "b.png").pixels);
}

TEST_F(FirstPictures, SayWhatIsTooBrightForTheirFile) {
    write_scene(work_ / "a");
    const std::string settings = read_file(work_ / "a/render.json");
    write_file(work_ / "a/render.json", std::string(settings).replace(settings.find("\"environment\": {}"), 17,
                                                                      R"("environment": {"scale": 70000})"));
    const std::string said = render({"a", "-o", "a.exr"});
    EXPECT_TRUE(contains(said, " pixels are brighter than 65504, the largest of 16-bit floats")) << said;
    EXPECT_EQ(corner("a.exr"), 65504.0f);
    EXPECT_FALSE(contains(render({"a", "--float", "-o", "b.exr"}), "brighter than"));
    EXPECT_NEAR(corner("b.exr"), 70000.0f, 1.0f);
}

TEST_F(FirstPictures, FramesHaveTheExposureOfTheFirst) {
    write_scene(work_ / "walk");
    const std::string scene = animated_scene((work_ / "walk").string());
    const std::vector<std::string> sequence{scene, "--frames", "0:2", "-o", "f.exr"};
    (void)render(sequence);
    EXPECT_TRUE(exposure_of("f.0000").at("chosen").get<std::string>().starts_with("half of it"));
    EXPECT_EQ(exposure_of("f.0002").at("chosen"), "that of the first frame");
    // As if the first had been another image: what it has holds for those that are made after it.
    json first = json::parse(read_file(work_ / "f.0000.json"));
    first["exposure"]["stops"] = -3.5;
    write_file(work_ / "f.0000.json", first.dump());
    (void)render({scene, "--frames", "2:2", "-o", "f.exr", "--force"});
    EXPECT_EQ(exposure_of("f.0002").at("stops"), -3.5);
    // A file of somebody else's.
    write_file(work_ / "f.-001.json", R"({"exposure": {}, "scene": 3})");
    (void)render({scene, "--frames", "2:2", "-o", "f.exr", "--force"});
    EXPECT_EQ(exposure_of("f.0002").at("stops"), -3.5);
    (void)render({scene, "--frames", "2:2", "-o", "f.exr", "--force", "--exposure", "0.5"});
    EXPECT_EQ(exposure_of("f.0002").at("stops"), 0.5);
}

TEST_F(FirstPictures, FramesHaveTheExposureOfTheFirstWhateverFollowsTheirNumber) {
    write_scene(work_ / "walk");
    const std::string scene = animated_scene((work_ / "walk").string());
    for (const auto& [before, after] : {std::pair("a_", "_2k"), {"b.", ".v2"}, {"c-", ""}}) {
        const auto name = [before = before, after = after](const std::string& number) {
            return before + number + after;
        };
        (void)render({scene, "--frames=-1:2", "-o", name("####") + ".exr"});
        EXPECT_TRUE(exposure_of(name("-0001")).at("chosen").get<std::string>().starts_with("half of it"));
        for (const char* const number : {"0000", "0001", "0002"})
            EXPECT_EQ(exposure_of(name(number)).at("chosen"), "that of the first frame") << name(number);
    }
    // Another take has its own.
    json other = json::parse(read_file(work_ / "b.-0001.v2.json"));
    other["exposure"]["stops"] = -3.5;
    write_file(work_ / "b.0002.v1.json", other.dump());
    (void)render({scene, "--frames=2:2", "-o", "b.####.v2.exr", "--force"});
    EXPECT_NE(exposure_of("b.0002.v2").at("stops"), -3.5);
}

TEST_F(FirstPictures, ShadowCatchersAreForEyePaths) {
    write_scene(work_ / "a");
    json gltf = json::parse(read_file(work_ / "a/scene.gltf"));
    gltf["materials"] = {{{"name", "Floor"}}};
    gltf["meshes"][0]["primitives"][0]["material"] = 0;
    write_file(work_ / "a/scene.gltf", gltf.dump());
    json settings = json::parse(read_file(work_ / "a/render.json"));
    settings["materials"]["Floor"]["shadow_catcher"] = true;
    write_file(work_ / "a/render.json", settings.dump());
    (void)render({"a", "-o", "a.exr"});
    EXPECT_NE(json::parse(read_file(work_ / "a.json")).at("integrator"), "auto") << "the pilot has chosen";
    const ProgramResult refused = run({"render", "a", "--integrator", "light", "-o", "b.exr"});
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_TRUE(contains(refused.err, "'light' cannot show the material 'Floor' as a shadow catcher")) << refused.err;
}

}  // namespace

}  // namespace etendue::test
