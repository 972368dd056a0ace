#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"

namespace etendue::test {

std::vector<ClosedFormCase> environment_cases() {
    std::vector<ClosedFormCase> cases;
    SceneDesc convex;
    set_environment(convex);
    convex.environment.color = Rgb(0.5f);
    convex.environment.scale = 1.4f;
    add(convex, sphere({0.0f, 0.0f, 0.0f}, 1.0f, 2, Facing::Outwards), diffuse(0.6f));
    look(convex, {0.0f, 0.0f, 3.0f}, {0.0f, 0.0f, -1.0f}, 0.6f);
    cases.push_back({"environment_on_convex_body", convex, 0.6 * 0.7, 1e-5, {}, light_too(kFindDirectLight)});

    SceneDesc seen = convex;
    seen.cameras.clear();
    look(seen, {0.0f, 0.0f, 3.0f}, {0.0f, 0.0f, 1.0f});
    // Not for `light`: no camera is connected to what is infinitely far away.
    cases.push_back({.name = "environment_seen", .scene = seen, .radiance = 0.7, .is_exact = true});

    // The integral of the squared cosine over the hemisphere is 2 pi / 3. The image's bilinear cells cost 1e-4.
    constexpr double kRadiance = 0.6 * 2.0 / 3.0;
    SceneDesc above;
    set_environment(above);
    add(above, quad_facing_up({0.0f, 0.0f, 0.0f}, 10.0f), diffuse(0.6f));
    look(above, {0.1f, 1.0f, 0.2f}, {0.0f, -1.0f, 0.0f});
    cases.push_back({"environment_cosine_lobe", above, kRadiance, 5e-4});
    cases.back().environment_axis = Vec3f(0.0f, 1.0f, 0.0f);

    // A quarter turn counter-clockwise, seen from above, takes -Z to -X.
    SceneDesc turned;
    set_environment(turned);
    turned.environment.rotation = 0.5f * kPi;
    add(turned, parallelogram({0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 10.0f}, {0.0f, 10.0f, 0.0f}), diffuse(0.6f));
    look(turned, {-1.0f, 0.1f, 0.2f}, {1.0f, 0.0f, 0.0f});
    cases.push_back({"environment_turned", turned, kRadiance, 5e-4});
    cases.back().environment_axis = Vec3f(0.0f, 0.0f, -1.0f);
    return cases;
}

std::vector<ClosedFormCase> mixed_light_cases() {
    // A point above the floor that brings as much as the sky, so that each is chosen about as often. It hides nothing.
    SceneDesc scene;
    set_environment(scene);
    add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 10.0f), diffuse(kAlbedo));
    add_light(scene, LightType::Point, 2.0f, {0.1f, 1.0f, 0.2f});
    look(scene, {0.1f, 0.5f, 0.2f}, {0.0f, -1.0f, 0.0f});
    ClosedFormCase both{"lamp_and_environment", scene, kRho * (2.0 / 3.0 + 2.0 / kPiD), 5e-4, {}, kFindDeltaLights};
    both.environment_axis = Vec3f(0.0f, 1.0f, 0.0f);
    return {both};
}

}  // namespace etendue::test
