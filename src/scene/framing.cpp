// The camera and light of a scene that brings none.

#include "scene/scene_desc.h"
#include "scene/studio.h"
#include "scene/swept_space.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace etendue {

namespace {

/// A three-quarter view from the front: +Z is a glTF model's front.
const Vec3f kViewDirection = normalize(Vec3f(0.45f, 0.35f, 1.0f));
constexpr float kFieldOfView = 0.6f;
constexpr float kMargin = 1.05f;

/// Distance from the centre of `bounds` at which a camera with these axes sees all eight corners.
float framing_distance(const Bounds& bounds, const Vec3f& right, const Vec3f& up, const Vec3f& back, float aspect) {
    const float tan_y = std::tan(0.5f * kFieldOfView);
    const float tan_x = tan_y * aspect;
    const Vec3f half = bounds.size() * 0.5f;
    float distance = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3f p((corner & 1) ? half.x : -half.x, (corner & 2) ? half.y : -half.y,
                      (corner & 4) ? half.z : -half.z);
        // The corner is inside the frame when |x| <= (distance - z) tan_x, and likewise for y.
        const float z = dot(p, back);
        distance = std::max({distance, z + abs_dot(p, right) / tan_x, z + abs_dot(p, up) / tan_y});
    }
    return distance * kMargin;
}

CameraDesc framing_camera(const Bounds& bounds, float aspect) {
    const Vec3f back = kViewDirection;
    const Vec3f right = normalize(cross(Vec3f(0.0f, 1.0f, 0.0f), back));
    const Vec3f up = cross(back, right);
    const float distance = framing_distance(bounds, right, up, back, aspect);

    CameraDesc camera;
    camera.name = "framed";
    camera.yfov = kFieldOfView;
    camera.focus_distance = distance > 0.0f && std::isfinite(distance) ? distance : 1.0f;
    const Vec3f eye = bounds.center() + back * camera.focus_distance;
    camera.to_world = Mat4f(right.x, right.y, right.z, 0.0f, up.x, up.y, up.z, 0.0f, back.x, back.y, back.z, 0.0f,
                            eye.x, eye.y, eye.z, 1.0f);
    return camera;
}

/// The element that `handle` refers to, or null: `inspect` shows scenes that did not pass validation too.
template <typename T>
const T* find(const std::vector<T>& elements, Handle<T> handle) {
    if (handle.index < 0 || static_cast<std::size_t>(handle.index) >= elements.size()) return nullptr;
    return &elements[static_cast<std::size_t>(handle.index)];
}

/// Returns whether an instance has a material for which `holds`.
template <typename Predicate>
bool shows_material(const SceneDesc& scene, const Predicate& holds) {
    const auto primitive_has = [&](const PrimitiveDesc& p) {
        const MaterialDesc* material = find(scene.materials, p.material);
        return material != nullptr && holds(*material);
    };
    return std::ranges::any_of(scene.instances, [&](const InstanceDesc& instance) {
        const MeshDesc* mesh = find(scene.meshes, instance.mesh);
        return mesh != nullptr && std::ranges::any_of(mesh->primitives, primitive_has);
    });
}

bool has_emissive_instance(const SceneDesc& scene) {
    return shows_material(scene, [](const MaterialDesc& material) { return material.emits(); });
}

bool has_light(const SceneDesc& scene) {
    const auto shines = [](const LightDesc& light) { return light.intensity > 0.0f && !is_black(light.color); };
    return scene.environment.enabled || std::ranges::any_of(scene.lights, shines) || has_emissive_instance(scene);
}

}  // namespace

Bounds compute_bounds(const SceneDesc& scene) {
    std::vector<Bounds> mesh_bounds(scene.meshes.size());
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        for (const PrimitiveDesc& primitive : scene.meshes[i].primitives) {
            for (const Vec3f& p : primitive.positions) mesh_bounds[i].extend(p);
        }
    }
    // The corners of each mesh's box stand for its vertices: exact without rotation, never too small with it.
    Bounds bounds;
    for (const InstanceDesc& instance : scene.instances) {
        if (find(scene.meshes, instance.mesh) == nullptr) continue;
        const Bounds& box = mesh_bounds[static_cast<std::size_t>(instance.mesh.index)];
        if (box.empty()) continue;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3f p((corner & 1) ? box.max.x : box.min.x, (corner & 2) ? box.max.y : box.min.y,
                          (corner & 4) ? box.max.z : box.min.z);
            bounds.extend(transform_point(instance.to_world, p));
        }
    }
    return bounds;
}

void add_missing_camera_and_light(SceneDesc& scene, ProblemList& problems) {
    add_missing_camera_and_light(scene, {}, problems);
}

void add_missing_camera_and_light(SceneDesc& scene, const SweptSpace& swept, ProblemList& problems) {
    const SourceLocation where{scene.file.string(), {}};
    const bool is_bare_model = scene.cameras.empty();
    if (is_bare_model) {
        const bool is_of_animation = !swept.bounds.empty();
        scene.cameras.push_back(
            framing_camera(is_of_animation ? swept.bounds : compute_bounds(scene), scene.settings.film.aspect()));
        problems.note(where, fmt::format("the scene has no camera: one was placed to frame the bounding box{}",
                                         is_of_animation ? " of its animation" : ""));
    }
    const std::optional<bool>& studio = scene.settings.studio;
    const bool is_dark = !has_light(scene);
    if (studio.value_or(is_dark)) add_studio(scene, swept, problems);
    if (is_dark && !studio)
        problems.note(where,
                      fmt::format("nothing in the scene emits light: it is lit by a studio{}; --environment gives "
                                  "other light",
                                  scene.settings.ground ? ", whose ground --no-ground leaves out" : ""));
    if (is_bare_model && !studio && scene.lights.empty() && has_emissive_instance(scene) && !scene.environment.enabled)
        problems.note(where, "only surfaces of the model emit light; --studio adds a studio");
    if (is_dark && studio && !*studio)
        problems.note(where, shows_material(scene, [](const MaterialDesc& material) { return material.unlit; })
                                 ? "nothing in the scene emits light: only unlit surfaces are not black"
                                 : "nothing in the scene emits light: the image is black");
}

}  // namespace etendue
