// Bare Embree on given rays.
#include "world/test_scene.h"
#include "world/world.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

SceneDesc scene_with_holes() {
    SceneDesc scene = empty_scene();
    MaterialDesc sheet = diffuse(Rgb(0.5f));
    sheet.alpha_mode = AlphaMode::Blend;
    sheet.base_alpha = 0.5f;
    add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, sheet));
    add_object(scene, sphere({0, 0, -3}, 0.5f, 64), add_material(scene, diffuse(Rgb(0.5f))));
    MaterialDesc pane;
    pane.transmission = 1.0f;
    pane.roughness = 0.0f;
    pane.metallic = 0.0f;
    add_object(scene, quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0}), add_material(scene, pane));
    return scene;
}

std::vector<Ray> rays_to_scene(std::size_t count) {
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float x = static_cast<float>(i % 16) / 16.0f - 0.5f;
        rays[i].direction = normalize(Vec3f(x, 0.1f, -1.0f));
        rays[i].alpha_key = static_cast<std::uint32_t>(i) * 2654435761u;
    }
    return rays;
}

TEST(Replay, TakesTimeInEveryFormAndForBothQueries) {
    const World world = compile(scene_with_holes());
    const std::vector<Ray> rays = rays_to_scene(250);
    for (const QueryForm form : {QueryForm::Single, QueryForm::Packet8, QueryForm::Packet16})
        for (const bool occlusion : {false, true})
            for (const Coherence coherence : {Coherence::Coherent, Coherence::Incoherent})
                EXPECT_GT(world.geometry().replay(rays, occlusion, coherence, form), 0.0);
}

TEST(Replay, IsOfTheGivenRaysAlone) {
    // Twenty times as many take several times as long: the least of several tries, that no other process falls into.
    const World world = compile(scene_with_holes());
    const std::vector<Ray> few = rays_to_scene(200);
    const std::vector<Ray> many = rays_to_scene(4000);
    double of_few = 1.0;
    double of_many = 1.0;
    for (int i = 0; i < 20; ++i) {
        of_few = std::min(of_few, world.geometry().replay(few, false, Coherence::Incoherent, QueryForm::Single));
        of_many = std::min(of_many, world.geometry().replay(many, false, Coherence::Incoherent, QueryForm::Single));
    }
    EXPECT_GT(of_many, 5.0 * of_few);
}

}  // namespace

}  // namespace etendue::test
