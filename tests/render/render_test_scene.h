// What the tests of scheduling render.
#pragma once

#include "render/render.h"
#include "render/whole_image.h"
#include "world/test_scene.h"

#include <atomic>
#include <cstring>
#include <vector>

namespace etendue::test {

/// A bit of everything: glass, metal, plastics, a translucent sheet, instances, a lamp, a spot, an environment, and
/// holes through which the background shows. If `moves`, all surfaces do.
inline SceneDesc busy_scene(int width, int height, bool moves = false) {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = width;
    scene.settings.film.height = height;
    MaterialDesc glass;
    glass.override_model = DielectricDesc{1.5f, 0.0f};
    MaterialDesc brushed;
    brushed.override_model = ConductorDesc{"Cu", 0.4f};
    MaterialDesc sheet = diffuse({0.2f, 0.6f, 0.3f});
    sheet.alpha_mode = AlphaMode::Blend;
    sheet.base_alpha = 0.4f;
    add_object(scene, sphere({-0.4f, 0.0f, -2.5f}, 0.35f, 10), add_material(scene, glass));
    add_object(scene, quad({0, 0, -1.5f}, {0.3f, 0, 0}, {0, 0.3f, 0}), add_material(scene, sheet));
    add_object(scene, quad({0, -0.6f, -3}, {1.2f, 0, 0}, {0, 0, -1.2f}), add_material(scene, diffuse(Rgb(0.7f))));
    add_object(scene, quad({0, 1.1f, -3}, {0.4f, 0, 0}, {0, 0, 0.4f}), add_material(scene, emissive(Rgb(6.0f))));
    for (const float roughness : {0.3f, 0.8f}) {
        MaterialDesc plastic;
        plastic.base_color = {0.6f, 0.3f, roughness};
        plastic.metallic = roughness < 0.5f ? 0.0f : 0.5f;
        plastic.roughness = roughness;
        add_object(scene, sphere({0.6f * roughness - 0.2f, -0.45f, -2.1f}, 0.14f, 8), add_material(scene, plastic));
    }
    PrimitiveDesc ball = sphere(Vec3f(0.0f), 0.2f, 8);
    ball.material = add_material(scene, brushed);
    const auto shared = add_mesh(scene, {ball});
    for (const float x : {0.3f, 0.8f}) place(scene, shared, translation({x, -0.3f, -2.8f}));
    if (moves)
        for (InstanceDesc& instance : scene.instances)
            for (int i = 0; i < 5; ++i) {
                const float x = 0.02f * static_cast<float>(i);
                instance.motion.push_back(instance.to_world * translation({x, x * x, 0.0f}));
            }
    LightDesc spot;
    spot.type = LightType::Spot;
    spot.intensity = 3.0f;
    scene.lights.push_back(spot);
    scene.environment.enabled = true;
    scene.environment.color = {0.2f, 0.3f, 0.5f};
    scene.environment.visible_to_camera = false;
    return scene;
}

inline RenderOptions options_for(int width, int height, std::uint32_t spp) {
    return whole_image(width, height, spp, 5);
}

inline RenderResult render_now(const World& world, const char* integrator, const RenderOptions& options, int threads,
                               const ProgressCallback& progress = {}) {
    const ThreadPool pool(threads);
    const std::atomic<bool> stop{false};
    return render(world, *make_integrator(integrator, {}), options, pool, stop, progress);
}

inline bool same_bytes(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace etendue::test
