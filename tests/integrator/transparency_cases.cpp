#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"

#include <string>
#include <vector>

namespace etendue::test {

namespace {

/// A floor that sees nothing but a glowing ceiling without end, so that its radiance is 0.6 · 2 everywhere.
SceneDesc floor_and_ceiling() {
    SceneDesc scene;
    add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 10.0f), diffuse(0.6f));
    add(scene, sphere({0.0f, 0.0f, 0.0f}, 8.0f, 2, Facing::Inwards), emitter(2.0f));
    look(scene, {0.11f, 0.2f, 0.07f}, {0.0f, -1.0f, 0.0f}, 1.0f);
    return scene;
}

/// A floor at y = 0 that glows with radiance 2, seen from y = 1 through what stands between.
SceneDesc glowing_floor() {
    SceneDesc scene;
    add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 10.0f), emitter(2.0f));
    look(scene, {0.11f, 1.0f, 0.07f}, {0.0f, -1.0f, 0.0f});
    return scene;
}

/// Takes the whole sky from what is seen of the floor.
PrimitiveDesc canopy(float radius) {
    return sphere({0.0f, 0.0f, 0.0f}, radius, 1, Facing::Inwards);
}

/// Between the glowing floor and the camera.
PrimitiveDesc card(float height) {
    return quad_facing_up({0.0f, height, 0.0f}, 10.0f);
}

std::vector<ClosedFormCase> card_cases() {
    std::vector<ClosedFormCase> cases;
    const double open = kRho * 2.0;
    cases.push_back({"ceiling", floor_and_ceiling(), open, 1e-5, {}, light_too(kFindDirectLight)});

    SceneDesc one = floor_and_ceiling();
    add(one, canopy(4.0f), black_card(0.3f));
    cases.push_back({"blend_card", one, open * 0.7, 1e-5, {}, light_too(kFindDirectLight)});

    SceneDesc two = one;
    add(two, canopy(4.8f), black_card(0.5f));
    cases.push_back({"two_blend_cards", two, open * 0.7 * 0.5, 1e-5, {}, light_too(kFindDirectLight)});

    SceneDesc holes = floor_and_ceiling();
    add(holes, canopy(4.0f), black_card(0.4f, AlphaMode::Mask));
    cases.push_back({"mask_below_cutoff", holes, open, 1e-5, {}, light_too(kFindDirectLight)});
    SceneDesc solid = floor_and_ceiling();
    add(solid, canopy(4.0f), black_card(0.6f, AlphaMode::Mask));
    cases.push_back({"mask_above_cutoff", solid, 0.0, 1e-5, {}, light_too(kFindDirectLight)});

    // Lights that only shadow rays find.
    SceneDesc sun;
    add(sun, quad_facing_up({0.0f, 0.0f, 0.0f}, 10.0f), diffuse(0.6f));
    add(sun, canopy(1.0f), black_card(0.3f));
    add_light(sun, LightType::Directional, kPi, {0.0f, 5.0f, 0.0f}, {0.6f, -0.8f, 0.0f});
    look(sun, {0.11f, 0.2f, 0.07f}, {0.0f, -1.0f, 0.0f});
    cases.push_back({"blend_card_and_sun", sun, kRho * 0.8 * 0.7, 1e-5, {}, kFindDeltaLights});

    SceneDesc seen = glowing_floor();
    add(seen, card(0.5f), black_card(0.3f));
    cases.push_back({"blend_card_before_camera", seen, 2.0 * 0.7});

    // As an instance of a shared mesh, whose alpha goes another way through Embree.
    SceneDesc shared = seen;
    shared.instances.push_back(shared.instances.back());
    shared.instances.back().to_world.setTranslation(Vec3f(0.0f, 0.1f, 0.0f));
    cases.push_back({"blend_card_instances", shared, 2.0 * 0.7 * 0.7});
    return cases;
}

std::vector<ClosedFormCase> transparent_light_cases() {
    std::vector<ClosedFormCase> cases;
    MaterialDesc light = emitter(2.0f);
    light.alpha_mode = AlphaMode::Blend;
    light.base_alpha = 0.6f;
    SceneDesc dome;
    add(dome, quad_facing_up({0.0f, 0.0f, 0.0f}, 10.0f), diffuse(0.6f));
    add(dome, sphere({0.0f, 0.0f, 0.0f}, 8.0f, 2, Facing::Inwards), light);
    look(dome, {0.11f, 0.2f, 0.07f}, {0.0f, -1.0f, 0.0f}, 1.0f);
    cases.push_back({"transparent_light", dome, kRho * 2.0 * 0.6, 1e-5, {}, light_too(kFindDirectLight)});

    // Two of them behind each other: the nearer one lets 0.4 of the other through.
    SceneDesc nested = dome;
    add(nested, sphere({0.0f, 0.0f, 0.0f}, 9.0f, 2, Facing::Inwards), light);
    cases.push_back(
        {"nested_transparent_lights", nested, kRho * 2.0 * (0.6 + 0.4 * 0.6), 1e-5, {}, light_too(kFindDirectLight)});

    SceneDesc seen;
    add(seen, quad_facing_up({0.0f, 0.0f, 0.0f}, 10.0f), light);
    look(seen, {0.11f, 1.0f, 0.07f}, {0.0f, -1.0f, 0.0f});
    cases.push_back({"transparent_light_seen", seen, 2.0 * 0.6});
    return cases;
}

std::vector<ClosedFormCase> film_cases() {
    std::vector<ClosedFormCase> cases;
    // glTF's thin wall of index 1.5 at normal incidence: reflects 0.04, tints the rest once by the base colour.
    MaterialDesc film;
    film.base_color = Rgb(0.7f);
    film.metallic = 0.0f;
    film.roughness = 0.0f;
    film.transmission = 1.0f;
    SceneDesc clear = glowing_floor();
    add(clear, card(0.5f), film);
    cases.push_back({"thin_film", clear, 2.0 * 0.7 * 0.96, 1e-5});

    // Half of what enters meets a diffuse base instead, lit by nothing but the sky of radiance 1.
    film.transmission = 0.5f;
    SceneDesc cloudy = glowing_floor();
    set_environment(cloudy);
    add(cloudy, card(0.5f), film);
    // Seen at normal incidence: mirror 0.04, film 0.5, base 0.5 with the coupling that makes it conserve energy.
    cases.push_back({"thin_film_over_base", cloudy, 0.04 + 0.96 * 0.7 * (0.5 * 2.0 + 0.5), 2e-3, {.max_depth = 2}});
    return cases;
}

/// Thin sheets that light samples pass.
std::vector<ClosedFormCase> pane_cases() {
    std::vector<ClosedFormCase> cases;
    MaterialDesc pane;
    pane.metallic = 0.0f;
    pane.roughness = 0.0f;
    pane.transmission = 1.0f;
    MaterialDesc tinted = pane;
    tinted.base_color = Rgb(0.5f);
    MaterialDesc patchy = pane;
    patchy.alpha_mode = AlphaMode::Blend;
    patchy.base_alpha = 0.25f;
    constexpr double kPassed = 0.96;  // at normal incidence

    // Without what the floor reflects into the panes and these send back.
    const PathLengths one_bounce{.max_depth = 2};
    const auto under_the_sun = [&](const std::string& name, const std::vector<MaterialDesc>& panes, double passed) {
        SceneDesc scene;
        add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 10.0f), diffuse(0.6f));
        float height = 1.0f;
        for (const MaterialDesc& one : panes) add(scene, card(height += 0.1f), one);
        add_light(scene, LightType::Directional, kPi, {0.0f, 5.0f, 0.0f}, {0.0f, -1.0f, 0.0f});
        look(scene, {0.11f, 0.2f, 0.07f}, {0.0f, -1.0f, 0.0f});
        cases.push_back({name, scene, kRho * passed, 1e-5, one_bounce, kFindDeltaLights});
    };
    under_the_sun("sun_behind_a_pane", {pane}, kPassed);
    under_the_sun("sun_behind_a_tinted_pane", {tinted}, 0.5 * kPassed);
    under_the_sun("sun_behind_three_panes", {pane, tinted, pane}, 0.5 * kPassed * kPassed * kPassed);
    under_the_sun("sun_behind_a_patchy_pane", {patchy}, 0.75 + 0.25 * kPassed);
    MaterialDesc wall = pane;
    wall.transmission = 0.0f;
    under_the_sun("sun_behind_a_wall", {wall}, 0.0);

    // A lamp that light samples and paths find, behind a dome of panes.
    SceneDesc dome = floor_and_ceiling();
    add(dome, sphere({0.0f, 0.0f, 0.0f}, 6.0f, 4, Facing::Inwards), pane);
    look(dome, {0.01f, 0.2f, 0.02f}, {0.0f, -1.0f, 0.0f});
    cases.push_back({"lamp_behind_panes", dome, kRho * 2.0 * kPassed, 2e-3, one_bounce});

    // A pane is no vertex: the lamp is one edge away.
    SceneDesc window = glowing_floor();
    add(window, card(0.5f), tinted);
    cases.push_back({"lamp_seen_through_a_pane", window, 2.0 * 0.5 * kPassed, 1e-5, {.max_depth = 1}});
    return cases;
}

}  // namespace

std::vector<ClosedFormCase> transparency_cases() {
    std::vector<ClosedFormCase> cases = card_cases();
    for (ClosedFormCase& c : transparent_light_cases()) cases.push_back(std::move(c));
    for (ClosedFormCase& c : film_cases()) cases.push_back(std::move(c));
    for (ClosedFormCase& c : pane_cases()) cases.push_back(std::move(c));
    return cases;
}

}  // namespace etendue::test
