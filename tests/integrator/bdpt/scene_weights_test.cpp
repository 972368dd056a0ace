// The weights of all strategies over the paths of every scene of scenes/. ETENDUE_WEIGHT_PATHS says how many each scene
// and heuristic gets in place of 30,000; `tools/test thorough` takes 100,000.
#include "color/color_config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "film/pixel_filter.h"
#include "integrator/bdpt/weight_comparison.h"
#include "loader/loader.h"
#include "world/compile.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kWidth = 64;           // pixels
constexpr float kShortEdge = 0.02f;  // of the scene's radius

std::size_t paths_to_weigh() {
    const char* const asked = std::getenv("ETENDUE_WEIGHT_PATHS");
    return asked == nullptr ? 30'000 : static_cast<std::size_t>(std::clamp(std::atoi(asked), 1, 100'000'000));
}

std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(ETENDUE_SCENES))
        if (entry.is_directory()) names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

class SceneWeights : public testing::TestWithParam<std::string> {};

TEST_P(SceneWeights, SumToOneAndAreThoseOfTheDefinition) {
    SceneDesc desc = load_scene(std::filesystem::path(ETENDUE_SCENES) / GetParam()).scene;
    FilmSettings& film = desc.settings.film;
    film.height = std::max(1, film.height * kWidth / film.width);
    film.width = kWidth;
    const IntegratorSettings& integrator = desc.settings.integrator;
    const PathLengths lengths = integrator.lengths;
    const PixelRect all{0, 0, film.width, film.height};
    const PixelFilter filter(FilterShape::Box);
    const TileJob job{all, all, film.width, film.height, 0, 1, 0, SampleSequence::Sobol, &filter};
    const ThreadPool threads;
    ProblemList warnings;
    const World world = compile_world(std::move(desc), ColorConfig::built_in(), "ACEScg", threads, warnings);
    for (const Heuristic heuristic : {Heuristic::Power, Heuristic::Balance})
        EXPECT_GE(expect_right_weights(world, lengths, heuristic, MergeAt::Nothing, {&job, 1}, paths_to_weigh(),
                                       kShortEdge * world.geometry().bounding_radius()),
                  2u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneWeights, testing::ValuesIn(scene_names()), [](const auto& scene) {
    std::string name = scene.param;
    std::ranges::replace(name, '-', '_');
    return name;
});

}  // namespace

}  // namespace etendue::test
