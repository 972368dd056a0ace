// Exact shapes: form factors of lamps without the error of facets, and bodies that neither add nor lose light.
#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"
#include "integrator/form_factors.h"
#include "world/test_scene.h"

#include <cmath>
#include <string>
#include <vector>

namespace etendue::test {

namespace {

constexpr double kExact = 1e-5;

SceneDesc floor_under_shapes(float x) {
    SceneDesc scene;
    add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 100.0f), diffuse(kAlbedo));
    look(scene, {x, 0.4f, 0.0f}, {0.0f, -1.0f, 0.0f});
    return scene;
}

/// A quarter of a turn around x takes a front towards -z downwards.
Mat4f facing_down(const Vec3f& at) {
    Mat4f turn;
    turn.setEulerAngles(Vec3f(-0.5f * kPi, 0.0f, 0.0f));
    return turn * translation(at);
}

std::vector<ClosedFormCase> shape_lamp_cases() {
    std::vector<ClosedFormCase> cases;
    SceneDesc globe = floor_under_shapes(0.75f);
    add(globe, exact(ShapeKind::Sphere, Vec3f(0.4f)), emitter(3.0f), translation({0.0f, 1.0f, 0.0f}));
    const double to_globe = std::hypot(0.75, 1.0);
    cases.push_back({"exact_globe", globe, kRho * 3.0 * 0.16 / std::pow(to_globe, 3.0), kExact});

    SceneDesc disk = floor_under_shapes(0.8f);
    add(disk, exact(ShapeKind::Disk, Vec3f(0.6f)), emitter(3.0f), facing_down({0.0f, 0.5f, 0.0f}));
    cases.push_back({"exact_disk", disk, kRho * 3.0 * disk_form_factor(0.6, 0.5, 0.8), kExact});

    // As an instance, and as an ellipse that is scaled to a circle.
    SceneDesc instances = floor_under_shapes(0.8f);
    add(instances, exact(ShapeKind::Disk, {1.2f, 0.3f, 1.0f}), emitter(1.5f),
        scaling({0.5f, 2.0f, 1.0f}) * facing_down({0.0f, 0.5f, 0.0f}));
    instances.instances.push_back(instances.instances.back());
    instances.instances.back().to_world = scaling({0.5f, -2.0f, 1.0f}) * facing_down({1.6f, 0.5f, 0.0f});
    cases.push_back({"exact_disk_instances", instances, 2.0 * kRho * 1.5 * disk_form_factor(0.6, 0.5, 0.8), kExact});

    // From a point of its axis, half the angle under which a spheroid is seen has this squared sine.
    SceneDesc spheroid = floor_under_shapes(0.0f);
    add(spheroid, exact(ShapeKind::Sphere, {0.6f, 0.3f, 0.6f}), emitter(3.0f), translation({0.0f, 1.0f, 0.0f}));
    cases.push_back({"exact_spheroid", spheroid, kRho * 3.0 * 0.36 / (0.36 + 1.0 - 0.09), kExact});

    // From within, places are chosen by the area of the unit sphere.
    SceneDesc ellipsoid = floor_under_shapes(0.0f);
    MaterialDesc dome = emitter(1.0f);
    dome.double_sided = true;
    add(ellipsoid, exact(ShapeKind::Sphere, {4.0f, 2.0f, 3.0f}), dome);
    cases.push_back({"exact_ellipsoid_from_inside", ellipsoid, kRho, kExact, {.max_depth = 2}});

    // A tube above the floor that is long enough to be endless: the sine of half the angle under which it is seen.
    SceneDesc tube = floor_under_shapes(0.0f);
    Mat4f lying;
    lying.setEulerAngles(Vec3f(0.0f, 0.0f, 0.5f * kPi));
    add(tube, exact(ShapeKind::Cylinder, {0.2f, 200.0f, 0.2f}), emitter(3.0f), lying * translation({0.0f, 1.0f, 0.0f}));
    // `naive` meets what few of its paths look at.
    cases.push_back({"exact_tube", tube, kRho * 3.0 * 0.2, 1e-4, {}, {"path", "direct", "bdpt", "whitted"}, 256});
    return cases;
}

MaterialDesc glass_of(float ior) {
    MaterialDesc m;
    m.override_model = DielectricDesc{ior, 0.0f};
    return m;
}

std::vector<ClosedFormCase> shape_body_cases() {
    std::vector<ClosedFormCase> cases;
    const auto in_environment = [](const std::string& name, const PrimitiveDesc& shape, const MaterialDesc& material,
                                   const Mat4f& to_world, const std::vector<std::string>& integrators) {
        SceneDesc scene;
        set_environment(scene);
        add(scene, shape, material, to_world);
        look(scene, {0.0f, 0.0f, 3.0f}, {0.0f, 0.0f, -1.0f}, 0.4f);
        return ClosedFormCase{name, scene, 1.0, 1e-4, {.max_depth = 1000}, integrators, 32};
    };
    Mat4f turned;
    turned.setEulerAngles(Vec3f(0.3f, 0.5f, 0.2f));
    const Mat4f uneven = turned * scaling({-1.3f, 0.8f, 1.1f});
    cases.push_back(in_environment("exact_glass_ball", exact(ShapeKind::Sphere, Vec3f(0.8f)), glass_of(1.5f), Mat4f(),
                                   kFindAllMirrors));
    cases.push_back(in_environment("exact_glass_ellipsoid", exact(ShapeKind::Sphere, Vec3f(0.8f)), glass_of(1.5f),
                                   uneven, kFindAllMirrors));
    Mat4f leaning;
    leaning.setEulerAngles(Vec3f(0.7f, 0.2f, 0.4f));
    cases.push_back(in_environment("exact_glass_cylinder", exact(ShapeKind::Cylinder, {0.5f, 0.6f, 0.5f}),
                                   glass_of(1.5f), leaning, kFindAllMirrors));
    MaterialDesc rough;
    rough.override_model = DielectricDesc{1.5f, 0.5f};
    ClosedFormCase rough_ball = in_environment("exact_rough_glass_ball", exact(ShapeKind::Sphere, Vec3f(0.8f)), rough,
                                               Mat4f(), light_too(kFindAllBounces));
    rough_ball.tolerance = 5e-3;
    cases.push_back(rough_ball);
    ClosedFormCase white_ball = in_environment("exact_white_ball", exact(ShapeKind::Sphere, Vec3f(0.8f)), diffuse(1.0f),
                                               Mat4f(), light_too(kFindAllBounces));
    cases.push_back(white_ball);

    // Within a body of index n, radiance is n² times that outside of it.
    ClosedFormCase inside = in_environment("camera_in_an_exact_glass_ball", exact(ShapeKind::Sphere, Vec3f(0.8f)),
                                           glass_of(1.5f), Mat4f(), {"path", "naive", "bdpt"});
    inside.scene.cameras.clear();
    look(inside.scene, {0.02f, 0.03f, 0.2f}, {0.0f, 0.0f, -1.0f}, 0.1f);
    inside.radiance = 2.25;
    cases.push_back(inside);

    // A body that absorbs, on the chord through its middle.
    MaterialDesc tinted;
    tinted.metallic = 0.0f;
    tinted.roughness = 0.0f;
    tinted.transmission = 1.0f;
    tinted.ior = 1.0f;
    tinted.volume = {.closed = true, .attenuation_color = Rgb(0.25f), .attenuation_distance = 1.0f};
    ClosedFormCase absorbs =
        in_environment("exact_ball_absorbs", exact(ShapeKind::Sphere, Vec3f(0.8f)), tinted, Mat4f(), kFindAllMirrors);
    absorbs.scene.cameras.clear();
    look(absorbs.scene, {0.0f, 0.0f, 3.0f}, {0.0f, 0.0f, -1.0f});
    absorbs.radiance = std::pow(0.25, 1.6);
    absorbs.lengths.roulette_depth = 1000;
    absorbs.spp = 16;
    absorbs.is_exact = true;
    cases.push_back(absorbs);

    // In a closed space whose walls emit e and reflect rho, L = e / (1 - rho).
    SceneDesc furnace;
    MaterialDesc walls = emitter(0.5f);
    walls.override_model = DiffuseDesc{Rgb(0.5f)};
    walls.double_sided = true;
    add(furnace, exact(ShapeKind::Sphere, Vec3f(2.0f)), walls);
    look(furnace, {0.0f, 0.0f, 1.5f}, {0.0f, 0.0f, -1.0f}, 0.3f);
    cases.push_back({"exact_furnace", furnace, 1.0, kExact, {.max_depth = 64}, light_too(kFindAllBounces)});

    // White wax: light enters and leaves by diffuse transmission and is scattered within. The tolerance is that of
    // `wax` in body_cases.cpp.
    MaterialDesc wax;
    wax.metallic = 0.0f;
    wax.roughness = 0.5f;
    wax.diffuse_transmission.factor = 1.0f;
    wax.volume = {.closed = true,
                  .attenuation_color = {0.2f, 0.3f, 0.5f},
                  .attenuation_distance = 0.5f,
                  .multiscatter_color = Rgb(1.0f),
                  .scatter_anisotropy = 0.4f};
    ClosedFormCase wax_ball = in_environment("exact_wax_ball", exact(ShapeKind::Sphere, Vec3f(0.8f)), wax, Mat4f(),
                                             light_too(kFindAllBounces));
    wax_ball.tolerance = 5e-3;
    cases.push_back(wax_ball);
    return cases;
}

}  // namespace

std::vector<ClosedFormCase> shape_cases() {
    std::vector<ClosedFormCase> cases = shape_lamp_cases();
    for (ClosedFormCase& c : shape_body_cases()) cases.push_back(std::move(c));
    return cases;
}

}  // namespace etendue::test
