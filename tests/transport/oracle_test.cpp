// The wide integrators find what the scalar algorithms of src/transport find, sample by sample: both draw the same
// random numbers.
//
// Of 2 million samples here 10 differ by more than a relative 1e-4, none of them by more than 2e-3, and all in one
// scene, `instances`, where textures that are looked up under reflections and leaning normals amplify rounding. Of
// 390,000 splats 2 have no partner. The limits below leave room for what depends on the processor and on Embree:
//   - Plain surfaces and their lights are computed in lanes, from a triangle's edges and not from a SurfacePoint. The
//     last bits differ, and smooth lobes, short distances and textures amplify them along the path.
//   - A number within rounding of a probability (a lobe, a light, Russian roulette) sends the path another way.
//   - A ray within rounding of an edge meets one triangle in a packet and the next one alone.
//
// Lamps in view (wave/lamps_in_view.h), an estimator across pixels, do not run here: the filter is a box. What
// both sides take from src/transport, such as probabilities of roulette, is tested by closed forms, not by this.
#include "color/color_config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "integrator/agreement_cases.h"
#include "loader/loader.h"
#include "transport/oracle_comparison.h"
#include "transport/oracle_rooms.h"
#include "world/compile.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Most of the samples, and of the splats, that may differ, in scenes and in rooms.
constexpr double kMostOfScenes = 0.002;
constexpr double kMostOfRooms = 0.0007;

/// Returns how many photons were compared.
std::size_t expect_samples_of_oracle(const World& world, const OracleRun& run, double most) {
    const OracleComparison result = compare_with_oracle(world, run);
    EXPECT_LE(static_cast<double>(result.differing), most * static_cast<double>(result.samples))
        << run << ": " << result;
    EXPECT_LE(static_cast<double>(result.splats_alone), most * static_cast<double>(result.splats))
        << run << ": " << result;
    EXPECT_LE(static_cast<double>(result.photons_alone), most * static_cast<double>(result.photons))
        << run << ": " << result;
    return result.photons;
}

/// Compares all algorithms, and what they may be asked for; returns how many photons were compared.
std::size_t expect_all_samples_of_oracle(const World& world, const OracleRun& run, double most = kMostOfRooms) {
    for (const char* const integrator : {"path", "direct", "naive", "hemisphere", "light", "bdpt"}) {
        OracleRun one = run;
        one.integrator = integrator;
        expect_samples_of_oracle(world, one, most);
    }
    OracleRun split = run;
    split.light_samples = 3;
    expect_samples_of_oracle(world, split, most);
    split.sequence = SampleSequence::Random;
    expect_samples_of_oracle(world, split, most);
    OracleRun power = run;
    power.integrator = "bdpt";
    power.heuristic = Heuristic::Power;
    power.sequence = SampleSequence::Random;
    expect_samples_of_oracle(world, power, most);
    if (!world.traits().has_specular_surfaces) return 0;
    OracleRun merged = run;
    merged.integrator = "vcm";
    const std::size_t photons = expect_samples_of_oracle(world, merged, most);
    merged.heuristic = Heuristic::Power;
    merged.merge = MergeAt::Everywhere;
    merged.samples = 2;
    return photons + expect_samples_of_oracle(world, merged, most);
}

std::vector<std::string> scenes_with_oracle() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(ETENDUE_SCENES))
        if (entry.is_directory()) names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

std::vector<std::string> rooms_with_oracle() {
    std::vector<std::string> names;
    for (const AgreementCase& room : agreement_cases()) names.push_back(room.name);
    return names;
}

std::string as_test_name(const testing::TestParamInfo<std::string>& scene) {
    std::string name = scene.param;
    std::ranges::replace(name, '-', '_');
    return name;
}

class OracleOfScene : public testing::TestWithParam<std::string> {};

TEST_P(OracleOfScene, FindsTheSameSamples) {
    SceneDesc desc = load_scene(std::filesystem::path(ETENDUE_SCENES) / GetParam()).scene;
    const IntegratorSettings& integrator = desc.settings.integrator;
    const PathLengths lengths = integrator.lengths;
    const ThreadPool threads;
    ProblemList warnings;
    const World world = compile_world(std::move(desc), ColorConfig::built_in(), "ACEScg", threads, warnings);
    expect_all_samples_of_oracle(world, {.lengths = lengths}, kMostOfScenes);
}

INSTANTIATE_TEST_SUITE_P(Scenes, OracleOfScene, testing::ValuesIn(scenes_with_oracle()), as_test_name);

class OracleOfRoom : public testing::TestWithParam<std::string> {};

TEST_P(OracleOfRoom, FindsTheSameSamples) {
    const AgreementCase& room = agreement_case(GetParam());
    expect_all_samples_of_oracle(agreement_world(room), {.lengths = room.lengths});
}

INSTANTIATE_TEST_SUITE_P(Rooms, OracleOfRoom, testing::ValuesIn(rooms_with_oracle()), as_test_name);

TEST(Oracle, FindsTheSamplesOfACrowdedRoom) {
    EXPECT_GT(expect_all_samples_of_oracle(crowded_room(RoomAir::Vacuum), {}), 1000u);
}

TEST(Oracle, FindsTheSamplesInFog) {
    EXPECT_GT(expect_all_samples_of_oracle(crowded_room(RoomAir::Fog), {}), 1000u);
}

TEST(Oracle, FindsTheSamplesBehindHiddenBoundaries) {
    EXPECT_GT(expect_all_samples_of_oracle(crowded_room(RoomAir::Resin), {}), 1000u);
}

TEST(Oracle, FindsTheSamplesOfACameraThatABodyDivides) {
    const World world = divided_room();
    EXPECT_FALSE(world.media().camera_interior());
    expect_all_samples_of_oracle(world, {});
}

TEST(Oracle, FindsTheSamplesUnderManyLights) {
    expect_all_samples_of_oracle(many_lights_room(), {});
}

}  // namespace

}  // namespace etendue::test
