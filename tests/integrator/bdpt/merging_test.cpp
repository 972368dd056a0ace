// What merging finds: light between two smooth refractions, which no connection can.
#include "integrator/agreement_cases.h"
#include "integrator/agreement_render.h"
#include "integrator/agreement_room.h"
#include "integrator/bdpt/bdpt_integrator.h"
#include "integrator/bdpt/render_bdpt.h"
#include "support/chi2.h"
#include "world/test_scene.h"

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kPlateSize = 32;
constexpr float kPlateThickness = 0.02f;
constexpr float kIor = 1.5f;

/// A grey floor, a plate of glass above it, and above that a spot and a camera that look straight down.
SceneDesc plate_over_floor(float camera_width) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, 0}, {0, 0, 4}, {4, 0, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    const Handle<MaterialDesc> plate = add_material(scene, glass(0.0f));
    const float top = 1.0f + 0.5f * kPlateThickness;
    const float bottom = 1.0f - 0.5f * kPlateThickness;
    const std::vector<PrimitiveDesc> faces = {quad({0, top, 0}, {0, 0, 2}, {2, 0, 0}),
                                              quad({0, bottom, 0}, {2, 0, 0}, {0, 0, 2}),
                                              quad({2, 1, 0}, {0, 0.5f * kPlateThickness, 0}, {0, 0, 2}),
                                              quad({-2, 1, 0}, {0, 0, 2}, {0, 0.5f * kPlateThickness, 0}),
                                              quad({0, 1, 2}, {2, 0, 0}, {0, 0.5f * kPlateThickness, 0}),
                                              quad({0, 1, -2}, {0, 0.5f * kPlateThickness, 0}, {2, 0, 0})};
    std::vector<PrimitiveDesc> body = faces;
    for (PrimitiveDesc& face : body) face.material = plate;
    place(scene, add_mesh(scene, body), Mat4f());
    LightDesc spot =
        light(LightType::Spot, 10.0f, looking_down(0.5f * std::numbers::pi_v<float>) * translation({0, 2, 0}));
    spot.inner_cone_angle = 0.15f;
    spot.outer_cone_angle = 0.16f;
    scene.lights.push_back(spot);
    CameraDesc& camera = scene.cameras[0];
    camera.type = CameraType::Orthographic;
    camera.ymag = 0.5f * camera_width;
    camera.to_world = looking_down(0.5f * std::numbers::pi_v<float>) * translation({0, 3, 0});
    scene.settings.film.width = scene.settings.film.height = kPlateSize;
    return scene;
}

// No other path of six edges reaches the eye: light goes through the plate, is scattered by the floor, and goes through
// the plate again. Both ways a share (1 - F)² of it passes, and the floor sees the spot kPlateThickness (1 - 1 / n)
// nearer.
TEST(Merging, FindsWhatASpotSendsThroughAPlateTwice) {
    const World world = compile(plate_over_floor(0.2f));
    const double fresnel = std::pow((static_cast<double>(kIor) - 1.0) / (static_cast<double>(kIor) + 1.0), 2.0);
    const double passes = std::pow(1.0 - fresnel, 2.0);
    const double distance = 2.0 - static_cast<double>(kPlateThickness) * (1.0 - 1.0 / static_cast<double>(kIor));
    const double expected = 10.0 / (distance * distance) * passes * passes * 0.5 / std::numbers::pi;
    const auto mean = [&](MergeAt merge) {
        const BdptIntegrator integrator({.lengths = {.max_depth = 6}}, nullptr, {.at = merge});
        const ThreadPool threads;
        const std::atomic<bool> stop{false};
        RenderOptions render_options = whole_image(kPlateSize, kPlateSize, 32, 3);
        return mean_of(render(world, integrator, render_options, threads, stop, {}).film.resolve());
    };
    // The eye sees a part in which irradiance differs by 1%; counts of some ten thousand photons vary by as much.
    EXPECT_NEAR(mean(MergeAt::BetweenDeltas), expected, 0.02 * expected);
    EXPECT_NEAR(mean(MergeAt::Everywhere), expected, 0.02 * expected);
    EXPECT_EQ(mean(MergeAt::Nothing), 0.0);
}

/// A room, where subpaths merge, and the heuristic.
using MergedRoom = std::tuple<const char*, MergeAt>;

std::string name_of_merged_room(const testing::TestParamInfo<MergedRoom>& info) {
    const auto& [name, merge] = info.param;
    return name + std::string(merge == MergeAt::Everywhere ? "Everywhere" : "BetweenDeltas");
}

class MergingAgreement : public testing::TestWithParam<MergedRoom> {};

// With so small a radius its bias is below the noise.
TEST_P(MergingAgreement, MakesTheSameImage) {
    constexpr int kRooms = 2;  // instances
    const auto& [name, merge] = GetParam();
    const AgreementCase& room = agreement_case(name);
    const World world = agreement_world(room);
    const ThreadPool threads;
    const BdptIntegrator merging({.lengths = room.lengths}, nullptr, {.at = merge, .radius = 0.2f, .alpha = 1.0f});
    const BlockAgreement result =
        test_agreement(estimate(world, "path", room, {.first_seed = 700}, threads),
                       estimate(world, merging, room, {.first_seed = 800}, threads, room.window),
                       {.block_size = kAgreementBlock, .significance = sidak_level(kFamilyLevel, kRooms)});
    EXPECT_TRUE(result.agree()) << result.str();
}

INSTANTIATE_TEST_SUITE_P(Rooms, MergingAgreement,
                         testing::Values(MergedRoom{"SmoothGlass", MergeAt::BetweenDeltas},
                                         MergedRoom{"LampPlastic", MergeAt::Everywhere}),
                         name_of_merged_room);

}  // namespace

}  // namespace etendue::test
