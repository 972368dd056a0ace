#include "scene/studio.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace etendue {

namespace {

/// Shines as a rectangle of light with soft edges, infinitely far away and upright.
struct Softbox {
    Vec3f towards;      ///< its middle, of unit length
    float half_width;   ///< tangent of half the angle under which it is seen
    float half_height;  ///< tangent of half the angle upwards
    float radiance;     ///< all together leave the irradiance pi on a level surface
};

Vec3f at_angles(float azimuth, float elevation) {
    return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation), std::cos(elevation) * std::cos(azimuth)};
}

/// Sets the width of the soft edge, in the units of the softbox's half sides.
constexpr float kEdge = 0.35f;

/// Sets the radiance of the sky above, where no softbox is.
constexpr float kTop = 0.16f;

/// Has the sine of the elevation up to which the sky is as bright as the ground.
constexpr float kBackdropEnds = 0.3f;
/// Has the sine of the elevation from which on the sky is as bright as above.
constexpr float kTopBegins = 0.7f;

/// Has the sine of the elevation below which no softbox shines, as the backdrop is to be even.
constexpr float kBoxesBegin = 0.06f;

float smooth_step(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// Returns the key to the left of the front, the fill to its right, and the rim behind.
const std::array<Softbox, 3>& softboxes() {
    static const std::array<Softbox, 3> boxes{{
        {at_angles(-0.7f, 0.7f), 0.5f, 0.45f, 3.418f},
        {at_angles(1.25f, 0.65f), 0.4f, 0.5f, 0.609f},
        {at_angles(2.75f, 0.75f), 0.8f, 0.2f, 2.066f},
    }};
    return boxes;
}

float radiance_of(const Softbox& box, const Vec3f& direction) {
    const float ahead = dot(direction, box.towards);
    if (!(ahead > 0.0f)) return 0.0f;
    const Vec3f right = normalize(cross(Vec3f(0.0f, 1.0f, 0.0f), box.towards));
    const Vec3f up = cross(box.towards, right);
    const auto share = [](float place, float half) {
        return 1.0f - smooth_step(1.0f - kEdge, 1.0f + kEdge, std::abs(place) / half);
    };
    return box.radiance * share(dot(direction, right) / ahead, box.half_width) *
           share(dot(direction, up) / ahead, box.half_height);
}

/// Returns the height of the lowest vertex; infinite if there is none.
float lowest_height(const SceneDesc& scene) {
    const auto height_of = [](const Mat4f& m, const Vec3f& p) { return transform_point(m, p).y; };
    std::vector<Bounds> boxes(scene.meshes.size());
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
        for (const PrimitiveDesc& primitive : scene.meshes[i].primitives)
            for (const Vec3f& p : primitive.positions) boxes[i].extend(p);
    // Corners of boxes lie no higher than the vertices within, so that most copies of a mesh need no look at it.
    std::vector<std::pair<float, const InstanceDesc*>> by_corner;
    for (const InstanceDesc& instance : scene.instances) {
        if (instance.mesh.index < 0 || static_cast<std::size_t>(instance.mesh.index) >= boxes.size()) continue;
        const Bounds& box = boxes[static_cast<std::size_t>(instance.mesh.index)];
        if (box.empty()) continue;
        float lowest = std::numeric_limits<float>::infinity();
        for (int corner = 0; corner < 8; ++corner)
            lowest = std::min(lowest, height_of(instance.to_world, {(corner & 1) != 0 ? box.max.x : box.min.x,
                                                                    (corner & 2) != 0 ? box.max.y : box.min.y,
                                                                    (corner & 4) != 0 ? box.max.z : box.min.z}));
        by_corner.emplace_back(lowest, &instance);
    }
    std::ranges::sort(by_corner, {}, &std::pair<float, const InstanceDesc*>::first);
    float lowest = std::numeric_limits<float>::infinity();
    for (const auto& [corner, instance] : by_corner) {
        if (corner >= lowest) break;
        for (const PrimitiveDesc& primitive : scene.meshes[static_cast<std::size_t>(instance->mesh.index)].primitives)
            for (const Vec3f& p : primitive.positions) lowest = std::min(lowest, height_of(instance->to_world, p));
    }
    return lowest;
}

constexpr std::size_t kCorners = 64;  ///< corners of each ring of the ground

/// Adds the rings of a disk of these `radii` about `centre`, each with its alpha; the first radius may be 0.
PrimitiveDesc make_rings(const Vec3f& centre, const std::vector<std::array<float, 2>>& radii_and_alphas) {
    PrimitiveDesc rings;
    for (const auto& [radius, alpha] : radii_and_alphas)
        for (std::size_t k = 0; k < kCorners; ++k) {
            const float angle = 2.0f * kPi * static_cast<float>(k) / static_cast<float>(kCorners);
            rings.positions.push_back(centre + Vec3f(std::sin(angle), 0.0f, std::cos(angle)) * radius);
            if (radii_and_alphas.back()[1] < 1.0f) rings.colors.push_back({1.0f, 1.0f, 1.0f, alpha});
        }
    const auto index = [](std::size_t ring, std::size_t k) {
        return static_cast<std::uint32_t>(ring * kCorners + k % kCorners);
    };
    for (std::size_t ring = 0; ring + 1 < radii_and_alphas.size(); ++ring)
        for (std::size_t k = 0; k < kCorners; ++k) {
            rings.triangles.push_back({index(ring, k), index(ring + 1, k), index(ring + 1, k + 1)});
            if (radii_and_alphas[ring][0] > 0.0f)
                rings.triangles.push_back({index(ring, k), index(ring + 1, k + 1), index(ring, k + 1)});
        }
    return rings;
}

template <typename T>
Handle<T> add_to(std::vector<T>& all, T one) {
    all.push_back(std::move(one));
    return {static_cast<int>(all.size()) - 1};
}

/// Adds a disk that is solid under the scene and fades away around it, so that no edge is seen even in a shadow.
void add_ground(const Vec3f& centre, float radius, SceneDesc& scene) {
    constexpr float kSolid = 2.0f;
    constexpr float kFaded = 5.0f;
    constexpr int kSteps = 6;
    MaterialDesc material;
    material.name = "studio ground";
    material.override_model = DiffuseDesc{.albedo = Rgb(kStudioBackdrop)};
    material.double_sided = true;
    MeshDesc mesh{.name = "studio ground", .primitives = {}, .location = {}};
    PrimitiveDesc solid = make_rings(centre, {{0.0f, 1.0f}, {kSolid * radius, 1.0f}});
    solid.material = add_to(scene.materials, material);
    std::vector<std::array<float, 2>> fading;
    for (int step = 0; step <= kSteps; ++step) {
        const float t = static_cast<float>(step) / static_cast<float>(kSteps);
        fading.push_back({radius * std::lerp(kSolid, kFaded, t), 1.0f - smooth_step(0.0f, 1.0f, t)});
    }
    PrimitiveDesc edge = make_rings(centre, fading);
    material.alpha_mode = AlphaMode::Blend;
    edge.material = add_to(scene.materials, std::move(material));
    mesh.primitives.push_back(std::move(solid));
    mesh.primitives.push_back(std::move(edge));
    InstanceDesc instance;
    instance.name = "studio ground";
    instance.mesh = add_to(scene.meshes, std::move(mesh));
    scene.instances.push_back(std::move(instance));
}

/// Returns how high the eye of the chosen camera is over the scene's origin; none without a camera.
std::optional<float> eye_height(const SceneDesc& scene) {
    if (const std::optional<CameraPlace>& place = scene.settings.camera_place)
        return static_cast<float>(place->eye.y - scene.origin.y);
    const CameraDesc* const first = scene.cameras.empty() ? nullptr : &scene.cameras.front();
    const std::string& name = scene.settings.camera;
    const CameraDesc* const camera = name.empty() ? first : find_camera(scene, name);
    return camera != nullptr ? std::optional(camera->to_world[3][1]) : std::nullopt;
}

}  // namespace

float studio_radiance(const Vec3f& direction) {
    if (direction.y <= 0.0f) return kStudioBackdrop;
    float boxes = 0.0f;
    for (const Softbox& box : softboxes()) boxes += radiance_of(box, direction);
    const float sky = std::lerp(kStudioBackdrop, kTop, smooth_step(kBackdropEnds, kTopBegins, direction.y));
    return sky + boxes * smooth_step(kBoxesBegin, kBackdropEnds, direction.y);
}

void SweptSpace::extend(const SceneDesc& scene) {
    bounds.extend(compute_bounds(scene));
    lowest = std::min(lowest, lowest_height(scene));
}

void add_studio(SceneDesc& scene, const SweptSpace& swept, ProblemList& problems) {
    EnvironmentDesc& environment = scene.environment;
    environment.image.clear();
    environment.cube.reset();
    environment.enabled = true;
    environment.is_studio = true;
    // It takes the place of an environment that does not shine.
    if (is_black(environment.color * environment.scale)) {
        environment.color = EnvironmentDesc().color;
        environment.scale = EnvironmentDesc().scale;
    }
    if (!scene.settings.ground) return;
    SweptSpace taken = swept;
    if (taken.bounds.empty()) taken.extend(scene);
    const float radius = taken.bounds.empty() ? 0.0f : 0.5f * length(taken.bounds.size());
    if (!(radius > 0.0f) || !std::isfinite(radius) || !std::isfinite(taken.lowest)) return;
    // A little below, as what stands on it would otherwise lie in it.
    constexpr float kGap = 1e-3f;
    Vec3f centre = taken.bounds.center();
    centre.y = taken.lowest - kGap * radius;
    const std::optional<float> eye = eye_height(scene);
    if (eye && *eye <= centre.y) {
        problems.note({scene.file.string(), {}}, "the camera is below the scene: the studio has no ground");
        return;
    }
    add_ground(centre, radius, scene);
}

}  // namespace etendue
