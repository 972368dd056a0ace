#include "session/prepared_scene.h"

#include "image/write.h"
#include "program/small_files.h"

#include <functional>
#include <map>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

TEST(PrepareScene, AddsWhatIsMissingAndSaysSo) {
    const TestFolder folder;
    write_scene(folder.path());
    write_file(folder / "render.json", "{}");
    const PreparedScene prepared = prepare_scene(folder.path(), {});
    EXPECT_TRUE(prepared.scene.environment.enabled);
    EXPECT_FALSE(prepared.problems.all().empty());
}

TEST(PrepareScene, AnotherEnvironmentKeepsTheRotationAlone) {
    const TestFolder folder;
    write_scene(folder.path());
    write_file(
        folder / "render.json",
        R"({"environment": {"color": [0.2, 0.2, 0.2], "scale": 0.05, "rotation": 1, "visible_to_camera": false}})");
    SettingsOverrides overrides;
    overrides.environment = (folder / "other.exr").string();
    ImageF sky(2, 1, 3);
    write_image(folder / "other.exr", sky, {});
    const EnvironmentDesc environment = prepare_scene(folder.path(), overrides).scene.environment;
    EXPECT_EQ(environment.image, folder / "other.exr");
    EXPECT_EQ(environment.color, Rgb(1.0f));
    EXPECT_EQ(environment.scale, 1.0f);
    EXPECT_EQ(environment.rotation, 1.0f);
    EXPECT_TRUE(environment.visible_to_camera);
}

TEST(PrepareScene, FramesHaveOneCameraAndOneGround) {
    const TestFolder folder;
    write_scene(folder.path());
    write_file(folder / "render.json", "{}");
    (void)animated_scene(folder.path().string());
    nlohmann::json gltf = nlohmann::json::parse(read_file(folder / "scene.gltf"));
    gltf.erase("cameras");
    gltf["nodes"][1].erase("camera");
    write_file(folder / "scene.gltf", gltf.dump());
    const auto at = [&](std::optional<int> frame) {
        SettingsOverrides overrides;
        overrides.frame = frame;
        if (!frame) overrides.give("--time-code", "1");
        return prepare_scene(folder.path(), overrides).scene;
    };
    const SceneDesc first = at(0);
    const SceneDesc last = at(24);
    const SceneDesc alone = at(std::nullopt);
    const auto ground = [](const SceneDesc& scene) { return scene.meshes.back().primitives.at(0).positions; };
    EXPECT_EQ(first.cameras.at(0).to_world, last.cameras.at(0).to_world);
    EXPECT_EQ(ground(first), ground(last));
    EXPECT_NE(alone.cameras.at(0).to_world, last.cameras.at(0).to_world) << "a moment is framed by itself";
    EXPECT_NE(ground(alone), ground(last));
}

TEST(PrepareScene, OverridesAreValidatedToo) {
    const TestFolder folder;
    write_scene(folder.path());
    SettingsOverrides overrides;
    overrides.give("--crop", "0,0,1000,10");
    EXPECT_THROW((void)prepare_scene(folder.path(), overrides), SceneError);
    overrides = {};
    overrides.give("--camera", "mian");
    EXPECT_THROW((void)prepare_scene(folder.path(), overrides), SceneError);
}

TEST(SettingsHash, ChangesWithEverythingThatChangesTheImage) {
    const TestFolder folder;
    write_scene(folder.path());
    write_file(folder / "sky.exr", "");
    const auto hash_with = [&](const std::function<void(SettingsOverrides&)>& change) {
        SettingsOverrides overrides;
        change(overrides);
        return settings_hash(prepare_scene(folder.path(), overrides).scene, overrides.depth);
    };
    std::map<std::string, std::string> seen;
    const auto expect_new = [&](const char* name, const std::function<void(SettingsOverrides&)>& change) {
        const std::string hash = hash_with(change);
        EXPECT_TRUE(seen.emplace(hash, name).second) << name << " makes the same hash as " << seen[hash];
        EXPECT_EQ(hash_with(change), hash) << name << " does not repeat its hash";
    };
    expect_new("nothing", [](SettingsOverrides&) {});
    expect_new("size", [](SettingsOverrides& o) { o.give("--size", "17x12"); });
    expect_new("environment", [&](SettingsOverrides& o) { o.environment = (folder / "sky.exr").string(); });
    expect_new("exposure", [](SettingsOverrides& o) { o.give("--exposure", "1"); });
    expect_new("an exposure that is hardly another", [](SettingsOverrides& o) { o.give("--exposure", "1.000004"); });
    expect_new("pixel depth", [](SettingsOverrides& o) { o.depth = PixelDepth::Float; });
}

TEST(SettingsHash, ChangesWithTheScenesOwnNumbers) {
    const TestFolder folder;
    write_scene(folder.path());
    const auto hash = [&](const std::string& extra) {
        write_scene(folder.path(), extra);
        return settings_hash(prepare_scene(folder.path(), {}).scene, PixelDepth::Half);
    };
    const std::string plain = hash("");
    EXPECT_NE(hash(R"("lens_radius": 0.01,)"), plain);
    EXPECT_EQ(hash(""), plain);
}

}  // namespace

}  // namespace etendue::test
