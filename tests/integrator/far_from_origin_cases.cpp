// The same light far from the origin, close to a surface, on large triangles and in meshes that lie far from their own
// origin: where rounding makes rays meet the surface they start from, or the light they go to.
#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"
#include "integrator/form_factors.h"

#include <cmath>

namespace etendue::test {

namespace {

/// A floor under a disk light at `height`, all of it moved by `offset`. The camera looks past the disk.
ClosedFormCase moved_lamp(const std::string& name, const Vec3f& offset, float radius, float height, float aside,
                          double tolerance) {
    SceneDesc scene;
    add(scene, quad_facing_up(offset, 10.0f), diffuse(kAlbedo));
    add(scene, disk_facing_down(offset + Vec3f(aside, height, 0.0f), radius, 1024), emitter(3.0f));
    look(scene, offset + Vec3f(0.0f, 0.5f * height, 0.0f), {0.0f, -1.0f, 0.0f});
    const double form_factor =
        disk_form_factor(static_cast<double>(radius), static_cast<double>(height), static_cast<double>(aside));
    // `naive` meets the disk too, but seldom.
    return {name, scene, kRho * 3.0 * form_factor, tolerance, {}, kFindDeltaLights};
}

/// A square of `size` metres that leans by 20 degrees, in the sun, seen at 1 m beside its centre.
SceneDesc leaning_square(const Vec3f& center, float size) {
    const float c = std::cos(0.35f);
    const float s = std::sin(0.35f);
    SceneDesc scene;
    add(scene, parallelogram(center, Vec3f(0.0f, 0.0f, size), Vec3f(c, s, 0.0f) * size), diffuse(kAlbedo));
    add_light(scene, LightType::Directional, 3.0f, {0.0f, 5.0f, 0.0f}, {0.6f, -0.8f, 0.0f});
    return scene;
}

/// What the leaning square sends back.
double sunlit() {
    return kRho / kPiD * 3.0 * (0.6 * std::sin(0.35) + 0.8 * std::cos(0.35));
}

}  // namespace

std::vector<ClosedFormCase> far_from_origin_cases() {
    std::vector<ClosedFormCase> cases{
        moved_lamp("lamp_at_30m", {30.0f, 0.0f, 0.0f}, 0.5f, 1.0f, 0.0f, 1e-4),
        moved_lamp("lamp_at_1km", {1000.0f, 3.0f, -500.0f}, 0.5f, 1.0f, 0.0f, 1e-3),
        moved_lamp("lamp_close_to_the_desk", {3.0f, 1.0f, 2.0f}, 0.02f, 0.05f, 0.05f, 1e-3),
    };
    for (const float size : {200.0f, 2000.0f, 20000.0f}) {
        SceneDesc scene = leaning_square(Vec3f(0.0f), size);
        look(scene, {0.7f, 2.0f, 0.3f}, {0.0f, -1.0f, 0.0f}, 0.5f);
        cases.push_back(
            {"leaning_" + std::to_string(static_cast<int>(size)) + "m", scene, sunlit(), 1e-4, {}, kFindDeltaLights});
    }
    for (const float far : {100.0f, 10000.0f}) {
        SceneDesc scene = leaning_square(Vec3f(far), 4.0f);
        Mat4f back;
        back.setTranslation(Vec3f(-far));
        // Twice, so that it stays in its own space.
        scene.instances.front().to_world = back;
        scene.instances.push_back(scene.instances.front());
        scene.instances.back().to_world[3][1] -= 50.0f;
        look(scene, {0.2f, 1.0f, 0.3f}, {0.0f, -1.0f, 0.0f}, 0.5f);
        cases.push_back({"instance_" + std::to_string(static_cast<int>(far)) + "m_from_its_origin",
                         scene,
                         sunlit(),
                         1e-4,
                         {},
                         kFindDeltaLights});
    }
    return cases;
}

}  // namespace etendue::test
