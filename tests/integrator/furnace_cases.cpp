// In a closed space whose walls emit e and reflect rho, L = e + rho L everywhere: L = e / (1 - rho), and its part of
// paths with k edges is e rho^(k-1). Lossless bodies in it do not show. Within a body of index n radiance is n² L.
#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace etendue::test {

namespace {

MaterialDesc glowing(float emission, float albedo) {
    MaterialDesc material = emitter(emission);
    material.override_model = DiffuseDesc{Rgb(albedo)};
    return material;
}

SceneDesc furnace(float emission, float albedo) {
    SceneDesc scene;
    add(scene, sphere({0.0f, 0.0f, 0.0f}, 2.0f, 2, Facing::Inwards), glowing(emission, albedo));
    look(scene, {0.0f, 0.0f, 1.5f}, {0.0f, 0.0f, -1.0f}, 0.3f);
    return scene;
}

/// The same as a room of one mesh: all of a wall lies in the planes of its triangles, whose pairs are in the wall
/// opposite.
SceneDesc square_furnace(float emission, float albedo) {
    SceneDesc scene;
    PrimitiveDesc walls;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.5f, 1.5f}) {
            Vec3f center(0.0f);
            center[axis] = side;
            Vec3f u(0.0f);
            Vec3f v(0.0f);
            u[(axis + 1) % 3] = side < 0.0f ? 3.0f : -3.0f;
            v[(axis + 2) % 3] = 3.0f;
            const PrimitiveDesc wall = parallelogram(center, u, v);
            const auto first = static_cast<std::uint32_t>(walls.positions.size());
            walls.positions.insert(walls.positions.end(), wall.positions.begin(), wall.positions.end());
            for (const auto& [a, b, c] : wall.triangles) walls.triangles.push_back({first + a, first + b, first + c});
        }
    add(scene, walls, glowing(emission, albedo));
    look(scene, {0.1f, 0.2f, 1.2f}, {0.0f, 0.0f, -1.0f}, 0.9f);
    return scene;
}

std::vector<ClosedFormCase> empty_furnace_cases() {
    const std::vector<std::string> kAll = light_too(kFindAllBounces);
    const std::vector<std::string> kOne = light_too(kFindDirectLight);
    std::vector<ClosedFormCase> cases;
    const SceneDesc half = furnace(0.5f, 0.5f);
    cases.push_back({"furnace", half, 1.0, 1e-5, {.max_depth = 64}, kAll});
    cases.push_back({"furnace_roulette_at_once", half, 1.0, 1e-5, {.max_depth = 1000, .roulette_depth = 1}, kAll});
    cases.push_back({"furnace_without_roulette", half, 1.0, 1e-5, {.max_depth = 30, .roulette_depth = 1000}, kAll, 16});
    cases.push_back({"furnace_bright_walls", furnace(0.1f, 0.9f), 1.0, 1e-5, {.max_depth = 400}, kAll});
    const SceneDesc square = square_furnace(0.5f, 0.5f);
    cases.push_back({"furnace_square", square, 1.0, 1e-5, {.max_depth = 64}, kAll});
    cases.push_back({"furnace_square_depth_2", square, 0.75, 1e-5, {.max_depth = 2}, kOne});
    cases.push_back({"furnace_depth_1", half, 0.5, 1e-5, {.max_depth = 1}, kOne});
    cases.push_back({"furnace_depth_2", half, 0.75, 1e-5, {.max_depth = 2}, kOne});
    cases.push_back({"furnace_depth_5", half, 1.0 - std::exp2(-5.0), 1e-5, {.max_depth = 5}, kAll});
    // Closed around cameras that see all of it, poles and seam and all.
    constexpr std::uint32_t kFew = 16;
    SceneDesc around = half;
    around.cameras[0].type = CameraType::Equirectangular;
    cases.push_back({"furnace_equirectangular", around, 1.0, 1e-5, {.max_depth = 64}, kAll, kFew});
    around.cameras[0].type = CameraType::Fisheye;
    around.cameras[0].fov = 5.0f;
    around.cameras[0].circle = 1.5f;
    cases.push_back({"furnace_fisheye", around, 1.0, 1e-5, {.max_depth = 64}, kAll, kFew});
    around.cameras[0].fisheye = FisheyeType::Equisolid;
    cases.push_back({"furnace_fisheye_equisolid", around, 1.0, 1e-5, {.max_depth = 64}, {"path", "light"}, kFew});
    // Windows of lengths that together are "furnace_depth_5".
    cases.push_back({"furnace_edges_2", half, 0.25, 1e-5, {.max_depth = 2, .min_depth = 2}, kOne});
    cases.push_back({"furnace_edges_3_to_4", half, 0.1875, 1e-5, {.max_depth = 4, .min_depth = 3}, kAll});
    cases.push_back(
        {"furnace_edges_5", half, std::exp2(-5.0), 1e-5, {.max_depth = 5, .min_depth = 5, .roulette_depth = 2}, kAll});
    return cases;
}

ClosedFormCase body_case(const std::string& name, const MaterialDesc& material, double tolerance, bool in_environment,
                         const std::vector<std::string>& integrators = kFindAllBounces) {
    SceneDesc scene;
    if (in_environment) {
        set_environment(scene);
        look(scene, {0.0f, 0.0f, 1.5f}, {0.0f, 0.0f, -1.0f}, 0.4f);
    } else {
        scene = furnace(0.5f, 0.5f);
    }
    add(scene, sphere({0.0f, 0.0f, 0.0f}, 0.8f, 3, Facing::Outwards), material);
    return {(in_environment ? "environment_with_" : "furnace_with_") + name,
            scene,
            1.0,
            tolerance,
            {.max_depth = 1000},
            integrators,
            32};
}

std::vector<ClosedFormCase> lossless_body_cases() {
    /// The tabulated albedos of rough lobes are good to 0.5%.
    constexpr double kTables = 5e-3;
    const auto conductor = [](float roughness) {
        MaterialDesc m;
        m.override_model = ConductorDesc{"", roughness};
        return m;
    };
    const auto glass = [](float roughness) {
        MaterialDesc m;
        m.override_model = DielectricDesc{1.5f, roughness};
        return m;
    };
    MaterialDesc white_metal;
    white_metal.roughness = 0.4f;
    MaterialDesc white_plastic = white_metal;
    white_plastic.metallic = 0.0f;

    // Light paths cannot be connected to mirrors and smooth glass.
    const std::vector<std::string> rough = light_too(kFindAllBounces);
    std::vector<ClosedFormCase> cases;
    for (const bool in_environment : {false, true}) {
        // In the furnace mirrors show walls that light each other.
        const std::vector<std::string>& smooth = in_environment ? kFindAllMirrors : kFindAllBounces;
        cases.push_back(body_case("mirror", conductor(0.0f), 1e-4, in_environment, smooth));
        cases.push_back(body_case("rough_conductor", conductor(0.5f), kTables, in_environment, rough));
        cases.push_back(body_case("glass", glass(0.0f), 1e-4, in_environment, smooth));
        cases.push_back(body_case("rough_glass", glass(0.5f), kTables, in_environment, rough));
        cases.push_back(body_case("white_metal", white_metal, kTables, in_environment, rough));
        cases.push_back(body_case("white_plastic", white_plastic, kTables, in_environment, rough));
    }
    // (Not `whitted`, whose branches end at random.)
    // Roulette that forgets that refraction scales radiance ends paths in glass without need, and exactness with them.
    ClosedFormCase exact = body_case("glass_and_roulette_at_once", glass(0.0f), 1e-4, true);
    exact.lengths.roulette_depth = 1;
    exact.is_exact = true;
    cases.push_back(exact);

    // The camera in the glass. Most of what it sees is totally reflected, and leaves by few long ways that bring
    // much: many samples, for means to be as good as normal.
    ClosedFormCase inside = body_case("camera_in_glass", glass(0.0f), 1e-4, false);
    inside.scene.cameras.clear();
    look(inside.scene, {0.1f, 0.3f, 0.2f}, {0.0f, 0.0f, -1.0f}, 0.1f);
    inside.radiance = 1.5 * 1.5;
    inside.spp = 512;
    cases.push_back(inside);
    return cases;
}

/// A point light in a sphere of radius r: after the first bounce irradiance is the same everywhere (Ulbricht 1900), and
/// every further bounce brings albedo times the one before.
std::vector<ClosedFormCase> integrating_sphere_cases() {
    constexpr double kRho = 0.8;
    constexpr double kIntensity = 3.0;
    constexpr double kRadius = 2.0;
    // The facet that is looked at, at right angles, is the one through which -Z leaves.
    // With the light in the middle all of the sphere is as bright.
    const auto sphere_with_light = [](float light_z, float half_width) {
        SceneDesc scene;
        add(scene, sphere({0.0f, 0.0f, 0.0f}, 2.0f, 5, Facing::Inwards), diffuse(0.8f));
        add_light(scene, LightType::Point, 3.0f, {0.0f, 0.0f, light_z});
        look(scene, {0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, -1.0f}, half_width);
        return scene;
    };
    const double mean = kIntensity / (kRadius * kRadius);
    const double near = kIntensity / (1.5 * 1.5);
    const auto radiance = [](double irradiance) { return kRho * std::numbers::inv_pi * irradiance; };
    constexpr double kTessellation = 1e-3;  // the sphere's radius varies by 1.5e-4
    std::vector<ClosedFormCase> cases;
    cases.push_back({"integrating_sphere",
                     sphere_with_light(0.0f, 0.8f),
                     radiance(mean / (1.0 - kRho)),
                     kTessellation,
                     {.max_depth = 400},
                     light_too(kFindAllBouncesOfDeltaLights)});
    const SceneDesc off_centre = sphere_with_light(-0.5f, 1e-4f);
    cases.push_back({"integrating_sphere_one_bounce",
                     off_centre,
                     radiance(near),
                     kTessellation,
                     {.max_depth = 2},
                     kFindDeltaLights});
    cases.push_back({"integrating_sphere_two_bounces",
                     off_centre,
                     radiance(near + kRho * mean),
                     kTessellation,
                     {.max_depth = 3},
                     kFindAllBouncesOfDeltaLights});
    cases.push_back({"integrating_sphere_off_centre",
                     off_centre,
                     radiance(near + kRho * mean / (1.0 - kRho)),
                     kTessellation,
                     {.max_depth = 400},
                     kFindAllBouncesOfDeltaLights});
    return cases;
}

/// A white square under a white sky, its normals leaning by `lean` degrees towards +X, seen from `view` degrees.
ClosedFormCase leaning_case(const std::string& name, const MaterialDesc& material, float lean, float view,
                            std::vector<std::string> integrators) {
    const auto at = [](float degrees) {
        const float angle = degrees * kPi / 180.0f;
        return Vec3f(std::sin(angle), std::cos(angle), 0.0f);
    };
    SceneDesc scene;
    set_environment(scene);
    PrimitiveDesc square = quad_facing_up({0.0f, 0.0f, 0.0f}, 2.0f);
    square.normals.assign(square.positions.size(), at(lean));
    MaterialDesc two_sided = material;
    two_sided.double_sided = true;
    add(scene, square, two_sided);
    look(scene, at(view) * 2.0f, -at(view), 0.1f);
    // What the tables of rough lobes and the share of diffuse light that the surface hides are good to.
    return {name, scene, 1.0, 5e-3, {.max_depth = 8}, std::move(integrators), 64};
}

}  // namespace

std::vector<ClosedFormCase> leaning_normal_cases() {
    MaterialDesc diffuse;
    diffuse.override_model = DiffuseDesc{Rgb(1.0f)};
    MaterialDesc mirror;
    mirror.override_model = ConductorDesc{"", 0.0f};
    MaterialDesc metal;
    metal.roughness = 0.5f;
    const std::vector<std::string> all = light_too(kFindAllBounces);
    return {leaning_case("leaning_diffuse", diffuse, 40.0f, 10.0f, all),
            leaning_case("leaning_diffuse_seen_from_behind", diffuse, 60.0f, -70.0f, all),
            leaning_case("leaning_metal", metal, 40.0f, 10.0f, all),
            leaning_case("leaning_metal_towards_the_eye", metal, 50.0f, 75.0f, all),
            leaning_case("leaning_metal_seen_from_behind", metal, 60.0f, -70.0f, all),
            leaning_case("leaning_mirror", mirror, 60.0f, 30.0f, kFindAllMirrors),
            leaning_case("leaning_mirror_seen_from_behind", mirror, 60.0f, -70.0f, kFindAllMirrors)};
}

std::vector<ClosedFormCase> furnace_cases() {
    std::vector<ClosedFormCase> cases = empty_furnace_cases();
    for (ClosedFormCase& c : lossless_body_cases()) cases.push_back(std::move(c));
    for (ClosedFormCase& c : integrating_sphere_cases()) cases.push_back(std::move(c));
    return cases;
}

}  // namespace etendue::test
