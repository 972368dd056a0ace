#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"
#include "integrator/form_factors.h"

#include <algorithm>
#include <cmath>

namespace etendue::test {

namespace {

/// A large floor at y = 0, seen from above at (x, 0, 0).
SceneDesc floor_seen_at(float x) {
    SceneDesc scene;
    add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 100.0f), diffuse(kAlbedo));
    look(scene, {x, 0.4f, 0.013f}, {0.0f, -1.0f, 0.0f});
    return scene;
}

/// From a plane element to a parallel rectangle of sides a and b at height h, one corner right above it (Howell, B-3).
double corner_form_factor(double a, double b, double h) {
    const double x = a / h;
    const double y = b / h;
    const double root_x = std::sqrt(1.0 + x * x);
    const double root_y = std::sqrt(1.0 + y * y);
    return (x / root_x * std::atan(y / root_x) + y / root_y * std::atan(x / root_y)) / (2.0 * kPiD);
}

/// From the origin to [x0, x1] × [z0, z1] at height h; corners in other quadrants count negatively.
double rectangle_form_factor(double x0, double x1, double z0, double z1, double h) {
    const auto signed_corner = [h](double x, double z) {
        return std::copysign(1.0, x) * std::copysign(1.0, z) * corner_form_factor(std::abs(x), std::abs(z), h);
    };
    return signed_corner(x1, z1) - signed_corner(x0, z1) - signed_corner(x1, z0) + signed_corner(x0, z0);
}

std::vector<ClosedFormCase> mesh_light_cases() {
    constexpr int kSegments = 1024;
    constexpr float kZ = 0.013f;
    std::vector<ClosedFormCase> cases;

    SceneDesc centre = floor_seen_at(0.0f);
    add(centre, disk_facing_down({0.0f, 1.0f, kZ}, 0.5f, kSegments), emitter(3.0f));
    cases.push_back({"disk_centre", centre, kRho * 3.0 * disk_form_factor(0.5, 1.0, 0.0), 1e-4});

    SceneDesc beside = floor_seen_at(0.8f);
    add(beside, disk_facing_down({0.0f, 0.5f, kZ}, 0.6f, kSegments), emitter(3.0f));
    cases.push_back({"disk_beside", beside, kRho * 3.0 * disk_form_factor(0.6, 0.5, 0.8), 1e-4});

    SceneDesc square = floor_seen_at(0.0f);
    add(square, quad_facing_down({0.7f, 1.0f, kZ + 0.2f}, 1.0f), emitter(2.0f));
    const double square_factor = rectangle_form_factor(0.2, 1.2, -0.3, 0.7, 1.0);
    cases.push_back({"quad", square, kRho * 2.0 * square_factor});

    // Between the camera and the floor, of which it shows as much as if it were not there.
    SceneDesc hidden = floor_seen_at(0.0f);
    MaterialDesc unseen = emitter(2.0f);
    unseen.visible_to_camera = false;
    add(hidden, quad_facing_down({0.0f, 0.2f, kZ}, 0.5f), unseen);
    cases.push_back({"hidden_quad", hidden, kRho * 2.0 * rectangle_form_factor(-0.25, 0.25, -0.25, 0.25, 0.2)});

    // Between the floor and a point whose light goes on through it.
    SceneDesc clear = floor_seen_at(0.0f);
    MaterialDesc passing = emitter(2.0f);
    passing.override_model = {};
    passing.metallic = 0.0f;
    passing.roughness = 0.0f;
    passing.ior = 1.0f;
    passing.specular = 0.0f;
    passing.transmission = 1.0f;
    add(clear, quad_facing_down({0.7f, 1.0f, kZ + 0.2f}, 1.0f), passing);
    add_light(clear, LightType::Point, 5.0f, {1.5f, 2.0f, kZ});
    const double from_point = 5.0 * 2.0 / std::pow(std::hypot(1.5, 2.0), 3.0);
    cases.push_back({"quad_that_stops_no_light",
                     clear,
                     kRho * 2.0 * square_factor + kRho / kPiD * from_point,
                     1e-4,
                     {},
                     kFindDeltaLights});

    SceneDesc behind = floor_seen_at(0.0f);
    add(behind, quad_facing_up({0.7f, 1.0f, kZ + 0.2f}, 1.0f), emitter(2.0f));
    cases.push_back({"quad_from_behind", behind, 0.0});

    MaterialDesc both_sides = emitter(2.0f);
    both_sides.double_sided = true;
    SceneDesc double_sided = floor_seen_at(0.0f);
    add(double_sided, quad_facing_up({0.7f, 1.0f, kZ + 0.2f}, 1.0f), both_sides);
    cases.push_back({"quad_double_sided", double_sided, kRho * 2.0 * square_factor});

    // One mesh in two places, once mirrored: instances in the BVH, and unequal areas.
    SceneDesc instanced = floor_seen_at(0.0f);
    Mat4f mirrored;
    mirrored.setScale(Vec3f(-2.0f, 1.0f, 1.0f));
    add(instanced, quad_facing_down({0.7f, 1.0f, kZ + 0.2f}, 1.0f), emitter(2.0f), mirrored);
    instanced.instances.push_back(instanced.instances.back());
    instanced.instances.back().to_world = Mat4f();
    const double mirrored_factor = rectangle_form_factor(-2.4, -0.4, -0.3, 0.7, 1.0);
    cases.push_back({"quad_instances", instanced, kRho * 2.0 * (square_factor + mirrored_factor)});

    // Closed: of its triangles those that face away are left out. Radiance times the projected solid angle of a sphere
    // above the horizon, pi (r / d)² cos.
    SceneDesc globe = floor_seen_at(0.75f);
    add(globe, sphere({0.0f, 1.0f, kZ}, 0.4f, 5, Facing::Outwards), emitter(3.0f));
    const double to_globe = std::hypot(0.75, 1.0);
    const double globe_factor = 0.16 / (to_globe * to_globe) / to_globe;
    cases.push_back({"globe", globe, kRho * 3.0 * globe_factor, 5e-4});

    // Small enough to count as a point, so that the floor's angle to it is one.
    const auto small_lamp = [](const BeamDesc& beam) {
        SceneDesc scene = floor_seen_at(0.75f);
        MaterialDesc lamp = emitter(3000.0f);
        lamp.beam = beam;
        add(scene, quad_facing_down({0.0f, 1.0f, kZ}, 0.01f), lamp);
        return scene;
    };
    const double squared = 0.75 * 0.75 + 1.0;
    const double intensity = 3000.0 * 1e-4;
    // So small that `naive` would miss it.
    const std::vector<std::string> all_but_naive{"path", "direct", "bdpt", "whitted"};
    const BeamDesc panel{.kind = BeamDesc::Kind::Panel, .spread = 2.0f};
    const double slats = (std::tan(1.0) - 0.75) / (std::tan(1.0) - 1.0);
    cases.push_back(
        {"panel", small_lamp(panel), kRho / kPiD * intensity * slats / squared / squared, 1e-4, {}, all_but_naive});
    const BeamDesc spot{.kind = BeamDesc::Kind::Spot, .inner_cone_angle = 0.3f, .outer_cone_angle = 0.9f};
    const double cone = (1.0 / std::sqrt(squared) - std::cos(0.9)) / (std::cos(0.3) - std::cos(0.9));
    cases.push_back({"spot_disk",
                     small_lamp(spot),
                     kRho / kPiD * intensity * cone * cone / squared / std::sqrt(squared),
                     3e-4,
                     {},
                     all_but_naive});

    // Lights of very different power, so that a wrong probability of the choice shows.
    SceneDesc several = square;
    add(several, disk_facing_down({0.0f, 1.5f, kZ}, 0.3f, kSegments), emitter(7.0f));
    add_light(several, LightType::Point, 0.5f, {-1.0f, 1.0f, kZ});
    const double several_light =
        2.0 * square_factor + 7.0 * disk_form_factor(0.3, 1.5, 0.0) + 0.5 / (2.0 * std::sqrt(2.0)) / kPiD;
    // `naive` would miss the point.
    cases.push_back({"several_lights", several, kRho * several_light, 1e-4, {}, kFindDeltaLights});
    return cases;
}

std::vector<ClosedFormCase> punctual_light_cases() {
    std::vector<ClosedFormCase> cases;
    constexpr float kZ = 0.013f;
    const double distance = std::hypot(0.75, 1.0);

    SceneDesc point = floor_seen_at(0.75f);
    add_light(point, LightType::Point, 5.0f, {0.0f, 1.0f, kZ});
    const double irradiance = 5.0 / distance / (distance * distance);
    cases.push_back({"point", point, kRho / kPiD * irradiance, 1e-4, {}, kFindDeltaLights});
    cases.push_back({"point_by_chance", point, 0.0, 0.0, {}, {"naive"}});

    // The floor's point lies at atan(0.75) = 0.6435 from the axis.
    const auto spot = [&](float inner, float outer) {
        SceneDesc scene = floor_seen_at(0.75f);
        LightDesc& light = add_light(scene, LightType::Spot, 5.0f, {0.0f, 1.0f, kZ});
        light.inner_cone_angle = inner;
        light.outer_cone_angle = outer;
        return scene;
    };
    cases.push_back({"spot_inner", spot(0.7f, 0.9f), kRho / kPiD * irradiance, 1e-4, {}, kFindDeltaLights});
    // KHR_lights_punctual: the square of a ramp in the cosine.
    const double ramp = (1.0 / distance - std::cos(0.9)) / (std::cos(0.3) - std::cos(0.9));
    const double on_edge = kRho / kPiD * irradiance * ramp * ramp;
    cases.push_back({"spot_falloff", spot(0.3f, 0.9f), on_edge, 3e-4, {}, kFindDeltaLights});
    cases.push_back({"spot_outside", spot(0.3f, 0.6f), 0.0, 0.0, {}, kFindDeltaLights});

    SceneDesc sun = floor_seen_at(0.0f);
    add_light(sun, LightType::Directional, 3.0f, {0.0f, 5.0f, 0.0f}, {0.6f, -0.8f, 0.0f});
    cases.push_back({"directional", sun, kRho / kPiD * 3.0 * 0.8, 1e-5, {}, kFindDeltaLights});

    // The whole disk is above the horizon: the irradiance is that of parallel light.
    sun.lights.back().angle = 0.8f;
    cases.push_back({"sun_disk", sun, kRho / kPiD * 3.0 * 0.8, 1e-4});

    // The mirror shows the middle of the disk; the camera that looks there sees nothing.
    SceneDesc mirrored;
    MaterialDesc mirror;
    mirror.override_model = ConductorDesc{};
    add(mirrored, quad_facing_up({0.0f, 0.0f, 0.0f}, 2.0f), mirror);
    add_light(mirrored, LightType::Directional, 3.0f, {0.0f, 5.0f, 0.0f}).angle = 0.2f;
    SceneDesc looking_up = mirrored;
    look(looking_up, {0.0f, 0.4f, 0.0f}, {0.0f, 1.0f, 0.0f});
    look(mirrored, {0.0f, 0.4f, 0.0f}, {0.0f, -1.0f, 0.0f});
    const double cap = 2.0 * kPiD * (1.0 - std::cos(0.1));
    ClosedFormCase in_mirror{"sun_in_mirror", mirrored, 3.0 / cap * 2.0 / (1.0 + std::cos(0.1)), 1e-4};
    in_mirror.is_exact = true;
    cases.push_back(in_mirror);
    cases.push_back({"sun_seen_directly", looking_up, 0.0, 0.0});

    SceneDesc sunny_square;
    add(sunny_square, quad_facing_up({0.0f, 0.0f, 0.0f}, 2.0f), diffuse(kAlbedo));
    add_light(sunny_square, LightType::Directional, 3.0f, {0.0f, 5.0f, 0.0f}, {0.6f, -0.8f, 0.0f});
    look(sunny_square, {0.0f, 0.4f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.7f);
    cases.push_back({"directional_wide", sunny_square, kRho / kPiD * 3.0 * 0.8, 1e-5, {}, light_too(kFindDeltaLights)});
    sunny_square.lights.back().angle = 0.8f;
    cases.push_back({"sun_disk_wide", sunny_square, kRho / kPiD * 3.0 * 0.8, 1e-4, {}, light_too(kFindDirectLight)});
    return cases;
}

/// cos(theta) times `peak` candela, every degree, from 0 to 90.
IesProfileDesc lambertian_profile(float peak) {
    IesProfileDesc profile;
    profile.horizontal = {0.0f, 2.0f * kPi};
    for (int degree = 0; degree <= 90; ++degree) profile.vertical.push_back(kPi * static_cast<float>(degree) / 180.0f);
    for (int plane = 0; plane < 2; ++plane)
        for (const float angle : profile.vertical) profile.candela.push_back(peak * std::max(0.0f, std::cos(angle)));
    return profile;
}

std::vector<ClosedFormCase> measured_light_cases() {
    std::vector<ClosedFormCase> cases;
    constexpr float kZ = 0.013f;
    const double distance = std::hypot(0.75, 1.0);
    const double cosine = 1.0 / distance;

    SceneDesc lamp = floor_seen_at(0.75f);
    add_light(lamp, LightType::Point, 0.5f, {0.0f, 1.0f, kZ}).profile.index = 0;
    lamp.ies_profiles.push_back(lambertian_profile(10.0f));
    const double irradiance = 5.0 * cosine * cosine / (distance * distance);
    cases.push_back({"ies_lambertian", lamp, kRho / kPiD * irradiance, 2e-4, {}, kFindDeltaLights});

    // Beside a lamp of another kind, so that a wrong power shows as noise and a wrong probability as a wrong mean.
    SceneDesc several = lamp;
    add_light(several, LightType::Point, 3.0f, {0.75f, 2.0f, kZ});
    cases.push_back({"ies_and_point", several, kRho / kPiD * (irradiance + 3.0 / 4.0), 2e-4, {}, kFindDeltaLights});

    SceneDesc watts = lamp;
    watts.settings.light_units = LightUnits::Radiometric;
    cases.push_back({"ies_radiometric", watts, kRho / kPiD * irradiance / 683.002, 2e-4, {}, kFindDeltaLights});
    return cases;
}

}  // namespace

std::vector<ClosedFormCase> direct_light_cases() {
    std::vector<ClosedFormCase> cases = mesh_light_cases();
    for (ClosedFormCase& c : punctual_light_cases()) cases.push_back(std::move(c));
    for (ClosedFormCase& c : measured_light_cases()) cases.push_back(std::move(c));
    return cases;
}

}  // namespace etendue::test
