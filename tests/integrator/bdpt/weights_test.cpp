// The recursion of the weights against their definition, over the paths of rooms with every kind of light, material
// and camera.
#include "integrator/agreement_cases.h"
#include "integrator/bdpt/made_paths.h"
#include "integrator/bdpt/reference_weights.h"
#include "integrator/bdpt/weight_comparison.h"
#include "wave/subpath/subpath_wave.h"
#include "world/test_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr PixelRect kWholeImage{0, 0, kAgreementWidth, kAgreementHeight};
/// A quarter of the pixels.
constexpr PixelRect kCrop{18, 20, 50, 44};
constexpr double kPixelsOverThoseOfTheCrop = 4.0;

TileJob job_of(const PixelRect& window, std::uint32_t seed, const PixelFilter& filter) {
    return {window, window, kAgreementWidth, kAgreementHeight, 0, 1, seed, SampleSequence::Sobol, &filter};
}

class BdptWeights : public testing::TestWithParam<AgreementCase> {};

/// Metres; of rooms that are some metres wide.
constexpr float kShortEdge = 0.1f;

TEST_P(BdptWeights, RecursionSaysWhatTheDefinitionSays) {
    constexpr std::size_t kPaths = 100'000;
    const World world = agreement_world(GetParam());
    const PixelFilter filter(FilterShape::Box);
    const TileJob jobs[] = {job_of(kWholeImage, 0, filter), job_of(kCrop, 0, filter)};
    // Of a path of so many edges, or of more where media scatter.
    const int strategies = world.traits().has_scattering_bodies ? 4 : std::min(4, GetParam().lengths.max_depth + 1);
    for (const Heuristic heuristic : {Heuristic::Power, Heuristic::Balance})
        EXPECT_GE(
            expect_right_weights(world, GetParam().lengths, heuristic, MergeAt::Nothing, jobs, kPaths / 2, kShortEdge),
            static_cast<std::size_t>(strategies));
}

/// A room, and where its subpaths merge.
using MergingRoom = std::tuple<const char*, MergeAt>;

std::string name_of_merging_room(const testing::TestParamInfo<MergingRoom>& info) {
    const auto& [name, merge] = info.param;
    return name + std::string(merge == MergeAt::Everywhere ? "Everywhere" : "SeenByDeltas");
}

class MergingWeights : public testing::TestWithParam<MergingRoom> {};

TEST_P(MergingWeights, RecursionSaysWhatTheDefinitionSays) {
    constexpr std::size_t kPaths = 20'000;
    const auto& [name, merge] = GetParam();
    const AgreementCase& room = agreement_case(name);
    const World world = agreement_world(room);
    const PixelFilter filter(FilterShape::Box);
    const TileJob jobs[] = {job_of(kWholeImage, 0, filter), job_of(kCrop, 0, filter)};
    for (const Heuristic heuristic : {Heuristic::Power, Heuristic::Balance})
        expect_right_weights(world, room.lengths, heuristic, merge, jobs, kPaths / 2, kShortEdge);
}

INSTANTIATE_TEST_SUITE_P(Rooms, MergingWeights,
                         testing::Values(MergingRoom{"SmoothGlass", MergeAt::SeenByDeltas},
                                         MergingRoom{"Mirror", MergeAt::SeenByDeltas},
                                         MergingRoom{"SmoothGlass", MergeAt::Everywhere},
                                         MergingRoom{"LampPlastic", MergeAt::Everywhere},
                                         MergingRoom{"VeilMirroredThinLens", MergeAt::Everywhere}),
                         name_of_merging_room);

// Air of precedence covers half of a ball of glass and half of a mirror, so that paths pass boundaries that it hides,
// and meet deltas.
TEST(MergingWeightsOfHiddenBoundaries, AreThoseOfTheDefinition) {
    AgreementCase room = agreement_case("SmoothGlass");
    room.make = [make = room.make](SceneDesc& scene) {
        make(scene);
        MaterialDesc air;
        DielectricDesc desc{.ior = 1.0f, .roughness = 0.0f};
        desc.volume.priority = 1;
        air.override_model = desc;
        add_object(scene, sphere({0.2f, -0.6f, -3.0f}, 0.5f, 8), add_material(scene, air));
        add_object(scene, quad({-0.6f, 0.0f, -3.2f}, {0.3f, 0, 0.1f}, {0, 0.4f, 0}),
                   add_material(scene, conductor(0.0f)));
    };
    const World world = agreement_world(room);
    const PixelFilter filter(FilterShape::Box);
    const TileJob job = job_of(kWholeImage, 0, filter);
    for (const MergeAt merge : {MergeAt::SeenByDeltas, MergeAt::Everywhere})
        expect_right_weights(world, room.lengths, Heuristic::Power, merge, {&job, 1}, 10'000, kShortEdge);
}

// A crop has a light path for each of its camera samples, and those all start in it: per area of the film strategies
// from the eye have more samples than one from the light, as many times as the film is larger. Images do not tell: any
// factor makes the same one, but with more noise.
TEST(BdptWeightsOfACrop, CountItsCameraSamples) {
    const AgreementCase& room = agreement_case("LampPlastic");
    const World world = agreement_world(room);
    const PixelFilter filter(FilterShape::Box);
    const TileJob whole = job_of(kWholeImage, 0, filter);
    const TileJob crop = job_of(kCrop, 0, filter);
    const IntegratorSettings settings{.lengths = room.lengths, .heuristic = Heuristic::Balance};
    const MisContext of_crop = mis_context(world, crop, settings);
    const MisContext of_whole = mis_context(world, whole, settings);
    double worst = 0.0;  // relative error of a ratio of two weights
    std::size_t compared = 0;
    for_each_path(world, crop, settings, [&](const CompletePath& path, double) {
        const std::vector<double> in_crop = reference_weights(of_crop, path);
        const std::vector<double> in_whole = reference_weights(of_whole, path);
        const std::size_t last = path.inner.size() + 1;
        if (!(in_whole[last] > 1e-6)) return;
        for (std::size_t s = 0; s < last; ++s) {
            if (!(in_whole[s] > 1e-6)) continue;
            const double expected = kPixelsOverThoseOfTheCrop * in_whole[s] / in_whole[last];
            worst = std::max(worst, std::abs(in_crop[s] / in_crop[last] / expected - 1.0));
            ++compared;
        }
    });
    EXPECT_GT(compared, 1000u);
    EXPECT_LT(worst, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BdptWeights, testing::ValuesIn(agreement_cases()),
                         [](const auto& agreement) { return agreement.param.name; });

}  // namespace

}  // namespace etendue::test
