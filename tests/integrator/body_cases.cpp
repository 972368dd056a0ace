// Bodies and what fills them. Slabs whose index is that of what surrounds them let light through as exp(-σ d); lossless
// bodies, however they nest, overlap, disperse or scatter, do not show in a white environment.
#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"
#include "medium/homogeneous_medium.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

namespace etendue::test {

namespace {

/// A body of glTF's material that nothing reflects, of which a quarter of the light passes one metre.
MaterialDesc tinted_air(int priority = 0, float left = 0.25f) {
    MaterialDesc m;
    m.metallic = 0.0f;
    m.roughness = 0.0f;
    m.transmission = 1.0f;
    m.ior = 1.0f;
    m.volume = {.closed = true, .attenuation_color = Rgb(left), .attenuation_distance = 1.0f, .priority = priority};
    return m;
}

/// A box 4 metres wide whose faces at z = `front` and `back` the camera looks through.
PrimitiveDesc slab(float front, float back) {
    return box({-2.0f, -2.0f, back}, {2.0f, 2.0f, front});
}

SceneDesc empty_in_environment() {
    SceneDesc scene;
    set_environment(scene);
    look(scene, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f});
    return scene;
}

/// Not for `light`, which cannot be connected to smooth boundaries.
ClosedFormCase exact_case(const std::string& name, SceneDesc scene, double exponent) {
    ClosedFormCase c{name, std::move(scene), std::pow(0.25, exponent), 1e-4, {.max_depth = 100}, kFindAllMirrors, 16};
    // Roulette would end some of the paths.
    c.lengths.roulette_depth = 1000;
    c.is_exact = true;
    return c;
}

std::vector<ClosedFormCase> absorption_cases() {
    std::vector<ClosedFormCase> cases;
    SceneDesc one = empty_in_environment();
    add(one, slab(-1.0f, -1.7f), tinted_air());
    cases.push_back(exact_case("slab_absorbs", one, 0.7));

    SceneDesc inside = empty_in_environment();
    add(inside, slab(0.5f, -1.5f), tinted_air());
    cases.push_back(exact_case("camera_in_a_slab", inside, 1.5));

    SceneDesc nested = empty_in_environment();
    add(nested, slab(-1.0f, -4.0f), tinted_air());
    add(nested, slab(-2.0f, -3.0f), tinted_air(0, 0.0625f));
    cases.push_back(exact_case("the_smaller_slab_fills_the_larger", nested, 2.0 + 2.0));

    // From -2 to -3 both are there.
    for (const int priority : {-1, 1}) {
        SceneDesc overlapping = empty_in_environment();
        add(overlapping, slab(-1.0f, -3.0f), tinted_air(priority));
        add(overlapping, slab(-2.0f, -4.0f), tinted_air(0, 0.0625f));
        cases.push_back(exact_case(priority > 0 ? "the_first_slab_has_priority" : "the_second_slab_has_priority",
                                   overlapping, priority > 0 ? 2.0 + 2.0 : 1.0 + 4.0));
    }

    // The far plane lies in the slab; behind it is a wall, which is not seen.
    for (const float front : {0.5f, -0.5f}) {
        SceneDesc cut = empty_in_environment();
        add(cut, slab(front, -3.0f), tinted_air());
        add(cut, parallelogram({0.0f, 0.0f, -2.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}), diffuse(0.5f));
        cut.cameras.back().clip.end = 1.5f;
        cases.push_back(exact_case(front > 0.0f ? "camera_in_a_slab_sees_to_the_far_plane" : "far_plane_in_a_slab", cut,
                                   front > 0.0f ? 1.5 : 1.0));
    }

    // An opaque wall in the medium, lit from within it.
    SceneDesc wall = empty_in_environment();
    wall.environment.enabled = false;
    add(wall, slab(0.5f, -2.0f), tinted_air());
    add(wall, parallelogram({0.0f, 0.0f, -1.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}), diffuse(0.5f));
    add_light(wall, LightType::Point, 2.0f, {0.0f, 0.0f, 0.25f});
    ClosedFormCase lit{"light_is_absorbed_on_its_way",
                       wall,
                       0.5 * std::numbers::inv_pi * 2.0 / (1.25 * 1.25) * std::pow(0.25, 1.25 + 1.0),
                       1e-4,
                       {.max_depth = 100},
                       kFindDeltaLights,
                       16};
    cases.push_back(lit);
    return cases;
}

/// A body that light passes only by diffuse transmission, of which a quarter is left after one metre.
MaterialDesc frosted_air() {
    MaterialDesc m = tinted_air();
    m.transmission = 0.0f;
    m.specular = 0.0f;
    m.roughness = 1.0f;
    m.diffuse_transmission.factor = 1.0f;
    return m;
}

/// Light that is sampled for a boundary comes from the side that the path does not, through what fills that one.
std::vector<ClosedFormCase> diffuse_boundary_cases() {
    std::vector<ClosedFormCase> cases;
    const auto with_lamp = [&](const std::string& name, const PrimitiveDesc& body, float lamp, double radiance) {
        SceneDesc scene = empty_in_environment();
        scene.environment.enabled = false;
        add(scene, body, frosted_air());
        add_light(scene, LightType::Point, 2.0f, {0.0f, 0.0f, lamp});
        cases.push_back({name, scene, radiance, 1e-4, {.max_depth = 2}, kFindDeltaLights, 16});
    };
    with_lamp("lamp_behind_a_diffuse_boundary", slab(-1.0f, -3.0f), -2.0f, 2.0 / kPiD * 0.25);
    with_lamp("lamp_before_a_diffuse_boundary", slab(0.5f, -1.0f), -3.0f, 2.0 / kPiD / 4.0 * 0.25);
    return cases;
}

// From a floor in two bodies at once, of which the one with priority goes on beyond the boundary of the other. Light
// samples pass that only if it is clear; what a path meets behind another counts in full. All around is as bright.
ClosedFormCase hidden_boundary_case(const std::string& name, float ior, float tint = 1.0f) {
    MaterialDesc hidden = tinted_air(0, 1.0f);
    hidden.ior = ior;
    hidden.base_color = Rgb(tint);
    SceneDesc scene = empty_in_environment();
    scene.environment.enabled = false;
    add(scene, sphere({0.0f, 0.0f, 0.0f}, 5.0f, 2, Facing::Inwards), emitter(1.0f));
    add(scene, sphere({0.0f, 0.0f, 0.0f}, 9.0f, 2, Facing::Outwards), tinted_air(1, 1.0f));
    add(scene, slab(0.5f, -2.0f), hidden);
    add(scene, parallelogram({0.0f, 0.0f, -1.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}), diffuse(kAlbedo));
    return {name, scene, kRho, 1e-5, {.max_depth = 2}, kFindAllBounces, 16};
}

/// Camera rays begin in and beside a slab that ends two metres before the camera, before a wall that shines.
std::vector<ClosedFormCase> divided_camera_cases() {
    std::vector<ClosedFormCase> cases;
    const auto divided = [&](const std::string& name, double share, std::vector<std::string> integrators,
                             const auto& change) {
        SceneDesc scene = empty_in_environment();
        scene.environment.enabled = false;
        add(scene, box({-0.5f, -9.0f, -2.0f}, {9.0f, 9.0f, 2.0f}), tinted_air());
        add(scene, parallelogram({0.0f, 0.0f, -3.0f}, {5.0f, 0.0f, 0.0f}, {0.0f, 5.0f, 0.0f}), emitter(1.0f));
        change(scene);
        cases.push_back(
            {name, scene, 0.0625 * share + (1.0 - share), 1e-3, {.max_depth = 4}, std::move(integrators), 16});
    };
    const auto at = [](float x) { return Mat4f(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1); };
    divided("camera_plane_cuts_a_slab", 0.75, light_too(kFindAllMirrors), [](SceneDesc& scene) {
        scene.cameras.clear();
        look(scene, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, 1.0f);
    });
    divided("camera_passes_into_a_slab", 0.75, kFindAllMirrors, [&](SceneDesc& scene) {
        CameraDesc& camera = scene.cameras.back();
        camera.motion = {camera.to_world * at(-1.0f), camera.to_world * at(1.0f)};
    });
    divided("slab_passes_over_the_camera", 0.75, kFindAllMirrors, [&](SceneDesc& scene) {
        scene.instances.front().motion = {at(1.0f), at(-1.0f)};
    });
    return cases;
}

/// Light from outside clear bodies, which light samples pass.
std::vector<ClosedFormCase> clear_body_cases() {
    std::vector<ClosedFormCase> cases;
    const auto without_sky = [] {
        SceneDesc scene = empty_in_environment();
        scene.environment.enabled = false;
        return scene;
    };
    const PrimitiveDesc wall = parallelogram({0.0f, 0.0f, -2.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f});
    // A metre of air before the wall, which the sun crosses with a cosine of 0.8.
    SceneDesc sun = without_sky();
    add(sun, wall, diffuse(kAlbedo));
    add_light(sun, LightType::Directional, kPi, {0.0f, 0.0f, 5.0f}, {0.6f, 0.0f, -0.8f});
    SceneDesc one = sun;
    add(one, slab(-0.5f, -1.5f), tinted_air());
    const double passed = kAlbedo * 0.8 * std::pow(0.25, 1.0 + 1.0 / 0.8);
    cases.push_back({"sun_through_tinted_air", one, passed, 1e-5, {.max_depth = 2}, kFindDeltaLights, 16});
    SceneDesc three = sun;
    add(three, slab(-0.5f, -1.5f), tinted_air(0, 0.5f));
    add(three, slab(-0.8f, -1.2f), tinted_air(1, 1.0f));
    add(three, slab(-1.5f, -1.9f), tinted_air(0, 0.125f));
    // Of the first, 0.6 m are left; what has priority absorbs nothing; the third touches the first.
    const double layers = kAlbedo * 0.8 * std::pow(std::pow(0.5, 0.6) * std::pow(0.125, 0.4), 1.0 + 1.0 / 0.8);
    cases.push_back({"sun_through_layers_of_air", three, layers, 1e-5, {.max_depth = 2}, kFindDeltaLights, 16});

    // A lamp all around, which paths meet, too: every way to the point is a metre of air.
    SceneDesc lamp = without_sky();
    add(lamp, wall, diffuse(kAlbedo));
    add(lamp, sphere({0.0f, 0.0f, -2.0f}, 5.0f, 2, Facing::Inwards), emitter(1.0f));
    add(lamp, sphere({0.0f, 0.0f, -2.0f}, 1.0f, 5, Facing::Outwards), tinted_air());
    cases.push_back({"lamp_through_tinted_air", lamp, kRho * 0.25 * 0.25, 5e-3, {.max_depth = 2}, kFindAllBounces});

    // Air that scatters a thousandth of what it takes, seen from outside; the sun shines through two metres of it.
    MaterialDesc mist = tinted_air(0, static_cast<float>(std::exp(-1.0)));
    mist.volume.multiscatter_color = Rgb(2.5e-4f);
    mist.volume.scatter_anisotropy = 0.3f;
    const double albedo = static_cast<double>(HomogeneousMedium::albedo_from_multiscatter(Rgb(2.5e-4f), 0.3f).g);
    const double phase = (1.0 - 0.09) / (4.0 * kPiD * std::pow(1.0 + 0.09, 1.5));
    SceneDesc cloud = without_sky();
    add(cloud, slab(-1.0f, -2.0f), mist);
    add_light(cloud, LightType::Directional, kPi, {0.0f, 5.0f, 0.0f}, {0.0f, -1.0f, 0.0f});
    const double scattered = albedo * phase * kPiD * std::exp(-2.0) * (1.0 - std::exp(-1.0));
    cases.push_back({"sun_in_thin_mist", cloud, scattered, 3e-3, {.max_depth = 4}, kFindAllBouncesOfDeltaLights, 256});
    return cases;
}

ClosedFormCase lossless(const std::string& name, SceneDesc scene, double tolerance,
                        const std::vector<std::string>& integrators, std::uint32_t spp = 32) {
    scene.cameras.clear();
    look(scene, {0.0f, 0.0f, 3.0f}, {0.0f, 0.0f, -1.0f}, 0.4f);
    return {name, std::move(scene), 1.0, tolerance, {.max_depth = 1000}, integrators, spp};
}

MaterialDesc dielectric(float ior, float roughness = 0.0f, VolumeDesc volume = {.closed = true}) {
    MaterialDesc m;
    m.override_model = DielectricDesc{ior, roughness, volume};
    return m;
}

std::vector<ClosedFormCase> lossless_cases() {
    // Light paths cannot be connected to smooth boundaries.
    const std::vector<std::string> rough = light_too(kFindAllBounces);
    std::vector<ClosedFormCase> cases;
    const auto ball = [](const Vec3f& center, float radius) { return sphere(center, radius, 3, Facing::Outwards); };

    for (const float roughness : {0.0f, 0.4f}) {
        SceneDesc ice = empty_in_environment();
        add(ice, ball({0.0f, 0.0f, 0.0f}, 1.0f), dielectric(1.33f, roughness));
        add(ice, ball({0.1f, 0.0f, 0.1f}, 0.6f), dielectric(1.6f, roughness));
        add(ice, ball({0.1f, 0.1f, 0.2f}, 0.3f), dielectric(1.01f, roughness));
        cases.push_back(lossless(roughness > 0.0f ? "rough_bodies_in_bodies" : "bodies_in_bodies", ice,
                                 roughness > 0.0f ? 1e-2 : 1e-4, roughness > 0.0f ? rough : kFindAllMirrors));
    }
    for (const int priority : {-1, 0, 1}) {
        SceneDesc overlap = empty_in_environment();
        add(overlap, ball({0.3f, 0.0f, 0.0f}, 0.8f), dielectric(1.5f, 0.0f, {.closed = true, .priority = priority}));
        add(overlap, ball({-0.3f, 0.1f, 0.2f}, 0.7f), dielectric(1.33f));
        cases.push_back(lossless("bodies_overlap_with_priority_" + std::string(priority < 0   ? "below"
                                                                               : priority > 0 ? "above"
                                                                                              : "equal"),
                                 overlap, 1e-4, kFindAllMirrors));
    }
    for (const float roughness : {0.0f, 0.3f}) {
        SceneDesc prism = empty_in_environment();
        add(prism, ball({0.0f, 0.0f, 0.0f}, 0.9f), dielectric(1.6f, roughness, {.closed = true, .dispersion = 1.0f}));
        cases.push_back(lossless(roughness > 0.0f ? "rough_dispersive_body" : "dispersive_body", prism,
                                 roughness > 0.0f ? 1e-2 : 1e-4, roughness > 0.0f ? rough : kFindAllMirrors, 128));
    }

    VolumeDesc milk{.closed = true,
                    .attenuation_color = {0.2f, 0.3f, 0.5f},
                    .attenuation_distance = 0.3f,
                    .multiscatter_color = Rgb(1.0f),
                    .scatter_anisotropy = 0.4f};
    SceneDesc glass_of_milk = empty_in_environment();
    add(glass_of_milk, ball({0.0f, 0.0f, 0.0f}, 0.9f), dielectric(1.3f, 0.0f, milk));
    cases.push_back(lossless("milk_in_glass", glass_of_milk, 1e-3, kFindAllBounces));

    MaterialDesc cloud = tinted_air();
    cloud.volume = milk;
    SceneDesc clouds = empty_in_environment();
    add(clouds, ball({0.0f, 0.0f, 0.0f}, 0.9f), cloud);
    add(clouds, ball({0.3f, 0.5f, 0.3f}, 0.7f), cloud);
    cases.push_back(lossless("clouds", clouds, 1e-3, kFindAllBounces));

    MaterialDesc wax;
    wax.metallic = 0.0f;
    wax.roughness = 0.5f;
    wax.diffuse_transmission.factor = 1.0f;
    wax.volume = milk;
    SceneDesc candle = empty_in_environment();
    add(candle, ball({0.0f, 0.0f, 0.0f}, 0.9f), wax);
    cases.push_back(lossless("wax", candle, 5e-3, rough));

    // The number of scatterings after which light leaves a snowball has a long tail: some paths have 10,000.
    MaterialDesc snow;
    snow.override_model = SubsurfaceDesc{.albedo = Rgb(1.0f), .radius = Rgb(0.01f), .ior = 1.0f};
    SceneDesc snowball = empty_in_environment();
    add(snowball, ball({0.0f, 0.0f, 0.0f}, 0.9f), snow);
    cases.push_back(lossless("snowball", snowball, 1e-3, kFindAllBounces));

    MaterialDesc partly;
    partly.metallic = 0.3f;
    partly.roughness = 0.3f;
    partly.transmission = 0.6f;
    partly.volume.closed = true;
    SceneDesc mixed = empty_in_environment();
    add(mixed, ball({0.0f, 0.0f, 0.0f}, 0.9f), partly);
    cases.push_back(lossless("partly_metal_body", mixed, 5e-3, rough));
    return cases;
}

}  // namespace

std::vector<ClosedFormCase> body_cases() {
    std::vector<ClosedFormCase> cases = absorption_cases();
    for (ClosedFormCase& c : lossless_cases()) cases.push_back(std::move(c));
    for (ClosedFormCase& c : diffuse_boundary_cases()) cases.push_back(std::move(c));
    cases.push_back(hidden_boundary_case("lamp_behind_a_hidden_boundary", 1.5f));
    cases.push_back(hidden_boundary_case("lamp_behind_a_hidden_clear_boundary", 1.0f));
    cases.push_back(hidden_boundary_case("lamp_behind_a_hidden_tinted_boundary", 1.0f, 0.25f));
    for (ClosedFormCase& c : clear_body_cases()) cases.push_back(std::move(c));
    for (ClosedFormCase& c : divided_camera_cases()) cases.push_back(std::move(c));
    return cases;
}

}  // namespace etendue::test
