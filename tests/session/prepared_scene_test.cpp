#include "session/prepared_scene.h"

#include "program/small_files.h"

#include <functional>
#include <map>
#include <string>

#include <gtest/gtest.h>

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

TEST(PrepareScene, OverridesAreValidatedToo) {
    const TestFolder folder;
    write_scene(folder.path());
    SettingsOverrides overrides;
    overrides.crop = {0, 0, 1000, 10};
    EXPECT_THROW((void)prepare_scene(folder.path(), overrides), SceneError);
    overrides.crop.reset();
    overrides.camera = "mian";
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
    expect_new("preview", [](SettingsOverrides& o) { o.spp = 3; });
    expect_new("size", [](SettingsOverrides& o) { o.size = {17, 12}; });
    expect_new("crop", [](SettingsOverrides& o) { o.crop = {0, 0, 5, 5}; });
    expect_new("integrator", [](SettingsOverrides& o) { o.integrator = "naive"; });
    expect_new("seed", [](SettingsOverrides& o) { o.seed = 9; });
    expect_new("time", [](SettingsOverrides& o) { o.time_seconds = 5.0; });
    expect_new("depth", [](SettingsOverrides& o) { o.max_depth = 3; });
    expect_new("least depth", [](SettingsOverrides& o) { o.min_depth = 2; });
    expect_new("light samples", [](SettingsOverrides& o) { o.light_samples = 2; });
    expect_new("heuristic", [](SettingsOverrides& o) { o.heuristic = HeuristicType::Power; });
    expect_new("strategy", [](SettingsOverrides& o) { o.strategy = {2, 1}; });
    expect_new("unweighted", [](SettingsOverrides& o) {
        o.strategy = {2, 1};
        o.weighted = false;
    });
    expect_new("connections", [](SettingsOverrides& o) { o.cached_connections = 2; });
    expect_new("environment", [&](SettingsOverrides& o) { o.environment = (folder / "sky.exr").string(); });
    expect_new("exposure", [](SettingsOverrides& o) { o.exposure = 0.5f; });
    expect_new("small exposure", [](SettingsOverrides& o) { o.exposure = 0.50001f; });
    expect_new("view", [](SettingsOverrides& o) { o.view = "Un-tone-mapped"; });
    expect_new("working space", [](SettingsOverrides& o) { o.working_space = "Linear Rec.709 (sRGB)"; });
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
    EXPECT_NE(hash(R"("sampler": "random",)"), plain);
    EXPECT_NE(hash(R"("film": {"filter": "box"},)"), plain);
    EXPECT_NE(hash(R"("film": {"filter_radius": 2},)"), plain);
    EXPECT_NE(hash(R"("lens_radius": 0.01,)"), plain);
    EXPECT_NE(hash(R"("integrator": {"min_depth": 2},)"), plain);
    EXPECT_NE(hash(R"("integrator": {"roulette_depth": 2},)"), plain);
    EXPECT_NE(hash(R"("color": {"display": "Display P3 - Display"},)"), plain);
    EXPECT_EQ(hash(""), plain);
}

}  // namespace

}  // namespace etendue::test
