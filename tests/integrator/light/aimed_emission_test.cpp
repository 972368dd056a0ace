// Light paths that are aimed at a mirror bring the light that others bring, from every kind of light.
//
// All comparisons together fail with probability 0.01 if everything is right (Sidak's correction); seeds are fixed.
#include "integrator/agreement_cases.h"
#include "integrator/agreement_render.h"
#include "integrator/agreement_room.h"
#include "support/chi2.h"
#include "world/test_scene.h"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

struct AimedLight {
    std::string name;
    std::function<void(SceneDesc&)> add;
};

const std::vector<AimedLight>& aimed_lights() {
    static const std::vector<AimedLight> all{
        {"Lamp", [](SceneDesc& scene) { add_lamp(scene); }},
        {"TwoSidedLamp", [](SceneDesc& scene) { add_lamp(scene, true); }},
        {"Panel",
         [](SceneDesc& scene) {
             MaterialDesc lamp = emissive(Rgb(12.0f));
             lamp.beam = {.kind = BeamDesc::Kind::Panel, .spread = 2.0f};
             add_object(scene, quad({0.1f, 1.3f, -2.8f}, {0.3f, 0, 0}, {0, 0, 0.3f}), add_material(scene, lamp));
         }},
        // In view, with mirrors across its horizon.
        {"SeenLamp",
         [](SceneDesc& scene) {
             add_object(scene, quad({0.5f, 0.3f, -2.95f}, {0.2f, 0, 0}, {0, 0.2f, 0}),
                        add_material(scene, emissive(Rgb(6.0f))));
         }},
        {"Point", [](SceneDesc& scene) { scene.lights.push_back(point_light()); }},
        {"Spot", [](SceneDesc& scene) { scene.lights.push_back(spot_light()); }},
        {"Sun", [](SceneDesc& scene) { scene.lights.push_back(sun_light()); }},
        {"WideSun",
         [](SceneDesc& scene) {
             scene.lights.push_back(sun_light());
             scene.lights.back().angle = 0.3f;
         }},
        {"Environment", [](SceneDesc& scene) { add_environment(scene); }},
    };
    return all;
}

class AimedEmission : public testing::TestWithParam<AimedLight> {};

TEST_P(AimedEmission, BringsTheLightOfOtherPaths) {
    const AgreementCase room{
        GetParam().name,
        [](SceneDesc& scene) {
            add_object(scene, sphere({0.2f, -0.25f, -3.0f}, 0.15f, 12), add_material(scene, conductor(0.0f)));
            add_object(scene, sphere({-0.4f, -0.3f, -2.8f}, 0.1f, 12), add_material(scene, conductor(0.0f)));
            GetParam().add(scene);
        },
        {.max_depth = 4},
        {0, 0, kAgreementWidth, kAgreementHeight},
        16};
    const World world = agreement_world(room);
    ASSERT_EQ(world.emitters().aim(true).spheres().size(), 2u);
    const ThreadPool threads;
    const auto image = [&](bool aims, std::uint32_t first_seed) {
        const auto integrator = make_integrator("light", {.lengths = room.lengths, .aimed_emission = aims});
        return estimate(world, *integrator, room, {.first_seed = first_seed}, threads, room.window);
    };
    const BlockAgreement result = test_agreement(
        image(true, 100), image(false, 200),
        {.block_size = kAgreementBlock, .significance = sidak_level(kFamilyLevel, aimed_lights().size())});
    EXPECT_TRUE(result.agree()) << result.str();
}

INSTANTIATE_TEST_SUITE_P(Lights, AimedEmission, testing::ValuesIn(aimed_lights()),
                         [](const auto& light) { return light.param.name; });

}  // namespace

}  // namespace etendue::test
