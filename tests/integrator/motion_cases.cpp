// Scenes in which something moves while the shutter is open: the radiance is the mean over that time.
#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"

#include <cmath>
#include <numbers>

namespace etendue::test {

namespace {

Mat4f translation(const Vec3f& t) {
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, t.x, t.y, t.z, 1};
}

/// A floor at y = 0 of albedo 0.6, seen from above at the origin.
SceneDesc floor() {
    SceneDesc scene;
    add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 100.0f), diffuse(0.6f));
    look(scene, {0.0f, 0.2f, 0.013f}, {0.0f, -1.0f, 0.0f});
    return scene;
}

/// An emitter of side 1 passes the line of sight: it is there for half of the time.
ClosedFormCase passing_emitter() {
    SceneDesc scene;
    add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 1.0f), emitter(3.0f));
    scene.instances.back().motion = {translation({-1.0f, 0.0f, 0.0f}), translation({1.0f, 0.0f, 0.0f})};
    look(scene, {0.0f, 1.0f, 0.0f}, {0.0f, -1.0f, 0.0f});
    return {"passing_emitter", scene, 1.5, 1e-3};
}

/// A one-sided emitter turns once about an axis in its plane: it shows its front for half of the time. Its vertices
/// move, not its transform.
ClosedFormCase turning_emitter() {
    SceneDesc scene;
    add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 1.0f), emitter(3.0f));
    PrimitiveDesc& primitive = scene.meshes.back().primitives.back();
    constexpr int kSteps = 129;
    for (int i = 0; i < kSteps; ++i) {
        const float angle = 2.0f * kPi * static_cast<float>(i) / (kSteps - 1);
        const auto turned = [angle](const Vec3f& v) {
            return Vec3f(v.x * std::cos(angle) - v.y * std::sin(angle), v.x * std::sin(angle) + v.y * std::cos(angle),
                         v.z);
        };
        VertexStep step;
        for (const Vec3f& p : primitive.positions) step.positions.push_back(turned(p));
        for (const Vec3f& n : primitive.normals) step.normals.push_back(turned(n));
        primitive.motion.push_back(std::move(step));
    }
    look(scene, {0.0f, 1.0f, 0.01f}, {0.0f, -1.0f, 0.0f});
    return {"turning_emitter", scene, 1.5, 2e-3};
}

/// A lamp above a floor is hidden by a card of width 1 for a quarter of the card's way.
ClosedFormCase passing_shadow() {
    SceneDesc scene = floor();
    add_light(scene, LightType::Point, 5.0f, {0.0f, 2.0f, 0.013f});
    add(scene, quad_facing_down({0.0f, 1.0f, 0.0f}, 1.0f), black_card(1.0f, AlphaMode::Opaque));
    scene.instances.back().motion = {translation({-2.0f, 0.0f, 0.0f}), translation({2.0f, 0.0f, 0.0f})};
    return {"passing_shadow", scene, 0.75 * 0.6 * 5.0 / 4.0 / std::numbers::pi, 1e-3, {}, kFindDeltaLights};
}

/// A disk of radius r rises from height a to b above a floor: the mean of its form factor r² / (r² + h²) is
/// r / (b - a) (atan(b / r) - atan(a / r)).
ClosedFormCase rising_lamp() {
    constexpr double kRadius = 0.5;
    constexpr double kLow = 0.5;
    constexpr double kHigh = 2.5;
    SceneDesc scene = floor();
    add(scene, disk_facing_down({0.0f, 0.0f, 0.013f}, static_cast<float>(kRadius), 1024), emitter(3.0f));
    scene.instances.back().motion = {translation({0.0f, static_cast<float>(kLow), 0.0f}),
                                     translation({0.0f, static_cast<float>(kHigh), 0.0f})};
    const double mean = kRadius / (kHigh - kLow) * (std::atan(kHigh / kRadius) - std::atan(kLow / kRadius));
    return {"rising_lamp", scene, 0.6 * 3.0 * mean, 1e-3};
}

/// A sphere of radius r rises from height a to b above a floor: the mean of (r / h)² is r² / (a b).
ClosedFormCase rising_ball() {
    constexpr double kRadius = 0.3;
    constexpr double kLow = 0.6;
    constexpr double kHigh = 2.0;
    SceneDesc scene = floor();
    PrimitiveDesc ball;
    ball.shape = ShapeDesc{ShapeKind::Sphere, Vec3f(static_cast<float>(kRadius))};
    ball.positions = ball.shape->corners();
    add(scene, ball, emitter(3.0f));
    // `to_world` is the middle of the motion.
    scene.instances.back().motion = {translation({0.0f, static_cast<float>(kLow), 0.013f}),
                                     translation({0.0f, static_cast<float>(kHigh), 0.013f})};
    scene.instances.back().to_world = translation({0.0f, static_cast<float>(0.5 * (kLow + kHigh)), 0.013f});
    return {"rising_ball", scene, 0.6 * 3.0 * kRadius * kRadius / (kLow * kHigh), 1e-3};
}

/// A point of intensity I flies at height h over a floor, from -a to a: the mean of I h / (x² + h²)^1.5 is
/// I / (h (a² + h²)^0.5).
ClosedFormCase flying_point() {
    constexpr double kHeight = 0.7;
    constexpr double kFar = 1.5;
    SceneDesc scene = floor();
    LightDesc& light = add_light(scene, LightType::Point, 5.0f, {0.0f, static_cast<float>(kHeight), 0.013f});
    for (const double x : {-kFar, kFar})
        light.motion.push_back(light.to_world * translation({static_cast<float>(x), 0.0f, 0.0f}));
    return {"flying_point", scene, 0.6 / std::numbers::pi * 5.0 / (kHeight * std::hypot(kFar, kHeight)),
            1e-3,           {},    kFindDeltaLights};
}

/// A spot with a hard edge 0.5 rad from its axis turns by a half circle: it lights the point below for 1 / pi of the
/// time.
ClosedFormCase turning_spot() {
    constexpr double kAngle = 0.5;
    SceneDesc scene = floor();
    LightDesc& light = add_light(scene, LightType::Spot, 5.0f, {0.0f, 2.0f, 0.013f});
    light.inner_cone_angle = static_cast<float>(kAngle);
    light.outer_cone_angle = static_cast<float>(kAngle);
    constexpr int kSteps = 129;
    for (int i = 0; i < kSteps; ++i) {
        Mat4f turned;
        turned.setEulerAngles(Vec3f(0.0f, 0.0f, kPi * (static_cast<float>(i) / (kSteps - 1) - 0.5f)));
        Mat4f at_origin = light.to_world;
        at_origin[3][0] = at_origin[3][1] = at_origin[3][2] = 0.0f;
        light.motion.push_back(at_origin * turned * translation({0.0f, 2.0f, 0.013f}));
    }
    return {"turning_spot", scene, 0.6 / std::numbers::pi * 5.0 / 4.0 * (2.0 * kAngle / std::numbers::pi),
            2e-3,           {},    kFindDeltaLights};
}

/// The camera pans over an emitter that is half of what it sees, also over the width of its view.
ClosedFormCase moving_camera(const char* name, float half_width, const std::vector<std::string>& integrators) {
    SceneDesc scene;
    add(scene, quad_facing_up({-5.0f, 0.0f, 0.0f}, 10.0f), emitter(2.0f));
    look(scene, {0.0f, 1.0f, 0.0f}, {0.0f, -1.0f, 0.0f}, half_width);
    CameraDesc& camera = scene.cameras.back();
    for (const float x : {-1.0f, 3.0f}) camera.motion.push_back(camera.to_world * translation({x, 0.0f, 0.0f}));
    return {name, scene, 0.5, 1e-3, {}, integrators};
}

/// In a furnace everything is as bright as the walls, however it moves.
ClosedFormCase moving_furnace() {
    SceneDesc scene;
    set_environment(scene);
    add(scene, sphere({0.0f, 0.0f, 0.0f}, 1.0f, 2, Facing::Outwards), diffuse(1.0f));
    scene.instances.back().motion = {translation({-0.3f, 0.0f, 0.0f}), translation({0.3f, 0.2f, 0.1f})};
    look(scene, {0.0f, 3.0f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.3f);
    return {"moving_furnace", scene, 1.0, 1e-4, {}, light_too(kFindDirectLight)};
}

}  // namespace

std::vector<ClosedFormCase> motion_cases() {
    return {passing_emitter(), turning_emitter(), passing_shadow(), rising_lamp(), rising_ball(), flying_point(),
            turning_spot(), moving_camera("moving_camera", 1e-4f, kFindDirectLight),
            // Pixels differ, so that only means of images are compared.
            moving_camera("moving_wide_camera", 0.5f, {"light", "bdpt"}), moving_furnace()};
}

}  // namespace etendue::test
