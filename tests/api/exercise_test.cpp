// Every integrator on scenes and materials of every kind, and files that come from elsewhere: each in the smallest form
// that still takes the same ways through the code. Sanitizers watch these in continuous integration; in other builds
// they say little but that pixels are finite.
#include "program/small_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <etendue/etendue.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kLayers =
    R"("aovs": ["passes", "cryptomatte", "variance", "denoising", "caustics=lpe:L S+ D E"])";

/// Lights a model from all sides.
constexpr std::string_view kSky = R"("environment": {"color": [1, 1, 1]})";

fs::path scene_directory(std::string_view name) {
    return fs::path(ETENDUE_SOURCE_DIR) / "scenes" / name;
}

class Exercise : public testing::Test {
  protected:
    /// Renders `scene` in 24 x 16 pixels with `settings`, the members of a render.json, writes it, and expects pixels
    /// that are finite and not all black.
    void exercise(const fs::path& scene, std::string_view settings, int samples = 2) {
        SCOPED_TRACE(fmt::format("{} {}", scene.string(), settings));
        try {
            const Picture picture = render(
                Scene(scene, fmt::format(R"({{"size": [24, 16], "spp": {}, {}}})", samples, settings)), {.threads = 2});
            const auto is_number = [](float value) { return std::isfinite(value); };
            EXPECT_TRUE(std::ranges::all_of(picture.pixels(), is_number));
            EXPECT_TRUE(std::ranges::any_of(picture.pixels(), [](float value) { return value > 0.0f; }));
            picture.write_exr(folder_ / "image.exr");
            EXPECT_GT(fs::file_size(folder_ / "image.exr"), 0u);
        } catch (const Error& error) {
            ADD_FAILURE() << error.what();
        }
    }

    TestFolder folder_;
};
class FilesFromElsewhere : public Exercise {};

std::string with_layers(std::string_view integrator) {
    return fmt::format(R"("integrator": {{"type": "{}"}}, {})", integrator, kLayers);
}

TEST_F(Exercise, PathInScenesOfEveryKind) {
    for (const std::string_view scene : {"cornell-box", "glossy-interior", "many-lights", "sun-and-sky", "instances"})
        exercise(scene_directory(scene), with_layers("path"));
}

TEST_F(Exercise, EveryIntegratorThroughGlass) {
    for (const std::string_view integrator : {"path", "direct", "naive", "light", "bdpt"})
        exercise(scene_directory("cornell-glass"), with_layers(integrator));
    exercise(scene_directory("cornell-glass"), R"("integrator": {"type": "whitted"}, "aovs": ["cryptomatte"])");
    for (const std::string_view integrator : {"normals", "albedo"})
        exercise(scene_directory("cornell-box"), fmt::format(R"("integrator": {{"type": "{}"}})", integrator));
}

TEST_F(Exercise, WhatSettingsTurnOn) {
    const fs::path box = scene_directory("cornell-box");
    exercise(box, R"("integrator": {"type": "bdpt", "connections": "cache:4"})");
    exercise(box, R"("integrator": {"light_samples": 3}, "film": {"filter": "mitchell"}, "sampler": "random")");
    exercise(box, R"("min_spp": 4, "error": 0.1)", 16);
    exercise(scene_directory("caustic-glass"),
             R"("clamp_indirect": 5, "brightest": 4, "robust": "mon:5", "crop": [4, 4, 20, 12])", 8);
    exercise(scene_directory("glossy-interior"), R"("texture_memory": "1M")");
}

TEST_F(Exercise, EveryMaterialByPathAndBdpt) {
    const fs::path rows = ETENDUE_MATERIAL_ROWS;
    if (!fs::is_directory(rows)) GTEST_SKIP() << rows << " is not there; the preset ci generates it";
    std::set<fs::path> scenes;
    for (const fs::directory_entry& entry : fs::directory_iterator(rows))
        if (entry.is_directory()) scenes.insert(entry.path());
    ASSERT_GT(scenes.size(), 10u);
    for (const fs::path& scene : scenes)
        for (const std::string_view integrator : {"path", "bdpt"})
            exercise(scene, fmt::format(R"("integrator": {{"type": "{}"}})", integrator));
}

/// The folder of files from elsewhere, `part` of it; empty where there is none.
fs::path assets(std::string_view part) {
    const char* const named = std::getenv("ETENDUE_ASSETS");
    const fs::path folder = (named != nullptr ? fs::path(named) : fs::path(ETENDUE_SHARED_ASSETS)) / part;
    return fs::is_directory(folder) ? folder : fs::path{};
}

/// The files below `folder` with one of these extensions, in order.
std::vector<fs::path> files_below(const fs::path& folder, const std::set<std::string>& extensions) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && extensions.contains(entry.path().extension())) files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

TEST_F(FilesFromElsewhere, ModelsAreRenderedAndBrokenOnesRefused) {
    const fs::path models = assets("models");
    const fs::path broken = assets("broken");
    if (models.empty() || broken.empty()) GTEST_SKIP() << "there are no models; ETENDUE_ASSETS names their folder";
    for (const fs::path& file : files_below(models, {".gltf", ".glb"})) exercise(file, kSky);
    for (const fs::path& file : files_below(broken, {".gltf", ".glb"})) try {
            (void)Scene(file);  // some are repaired
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), Error::Kind::InvalidScene) << file << ": " << error.what();
        }
}

TEST_F(FilesFromElsewhere, EnvironmentsLightAScene) {
    const fs::path images = assets("hdri");
    if (images.empty()) GTEST_SKIP() << "there are no environments; ETENDUE_ASSETS names their folder";
    for (const fs::path& file : files_below(images, {".hdr", ".exr"})) {
        const fs::path scene = folder_ / file.stem().string();
        fs::copy(scene_directory("furnace"), scene);
        fs::copy(file, scene / file.filename());
        exercise(scene, fmt::format(R"("environment": {{"image": "{}"}})", file.filename().string()));
    }
}

}  // namespace

}  // namespace etendue::test
