#include "world/scene_camera.h"

#include "core/position_error.h"
#include "world/motion.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>

namespace etendue {

SceneCamera::SceneCamera(const WorldData& data, const SceneTraits& traits) : data_(data), traits_(traits) {
    for (const Light& light : data_.lights)
        std::visit(
            [&]<typename Kind>(const Kind& l) {
                if constexpr (kIsSurfaceLight<Kind>) lamp_bounds_.push_back(l.bounds().box);
            },
            light);
    constexpr std::size_t kMostBounds = 1024;
    if (lamp_bounds_.size() > kMostBounds) lamp_bounds_ = {data_.bounds};
}

Camera SceneCamera::at(float time) const {
    return with_pose(data_.camera, CameraPose::from_matrix(transform_at(data_.camera_motion, time)));
}

Ray SceneCamera::generate_ray(Vec2f film, Vec2f lens, float time) const {
    Ray ray = data_.camera_motion.empty() ? etendue::generate_ray(data_.camera, film, lens)
                                          : etendue::generate_ray(at(time), film, lens);
    ray.time = time;
    return ray;
}

void SceneCamera::generate_rays(std::span<const Vec2f> film, std::span<const Vec2f> lens, std::span<const float> times,
                                std::span<Ray> rays) const {
    if (data_.camera_motion.empty()) {
        etendue::generate_rays(data_.camera, film, lens, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i].time = times[i];
    } else {
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = generate_ray(film[i], lens[i], times[i]);
    }
}

CameraConnection SceneCamera::connect(const Vec3f& point, Vec2f lens, float time) const {
    return data_.camera_motion.empty() ? etendue::connect(data_.camera, point, lens)
                                       : etendue::connect(at(time), point, lens);
}

float SceneCamera::depth(const Vec3f& point, float time) const {
    return camera_depth(data_.camera_motion.empty() ? data_.camera : at(time), point);
}

std::optional<Vec2f> SceneCamera::project(const Vec3f& point, float time) const {
    return etendue::project(data_.camera_motion.empty() ? data_.camera : at(time), point);
}

Hit SceneCamera::cut_far(const Ray& ray, const Hit& hit) const {
    if (!hit.valid()) return hit;
    const float end = clip_of(data_.camera).end;
    const float at_hit = depth(ray.origin + ray.direction * hit.t, ray.time);
    if (!(at_hit > end)) return hit;
    // Depths grow evenly along rays of the camera.
    const float at_origin = depth(ray.origin, ray.time);
    return {.t = hit.t * (end - at_origin) / (at_hit - at_origin)};
}

Bounds SceneCamera::bounds_of_origins() const {
    Bounds still = etendue::bounds_of_origins(data_.camera);
    if (data_.camera_motion.empty()) return still;
    // However the camera turns, rays begin no farther from where it stands.
    const Vec3f& position = pose_of(data_.camera).position;
    const Vec3f reach(
        length(max_components(abs_components(still.min - position), abs_components(still.max - position))));
    Bounds moving;
    for (const Mat4f& step : data_.camera_motion) {
        moving.extend(transform_point(step, Vec3f(0.0f)) - reach);
        moving.extend(transform_point(step, Vec3f(0.0f)) + reach);
    }
    return moving;
}

bool SceneCamera::may_show_lamps(Vec2f least, Vec2f most) const {
    if (traits_.has_motion || traits_.has_lens || is_panoramic(data_.camera) || traits_.has_unsampled_emitters)
        return traits_.has_emitting_surfaces;
    const std::array<Vec2f, 4> corners{least, Vec2f(most.x, least.y), most, Vec2f(least.x, most.y)};
    const Ray middle = generate_ray((least + most) * 0.5f, Vec2f(0.5f, 0.5f), 0.0f);
    std::array<Ray, 4> rays;
    for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = generate_ray(corners[i], Vec2f(0.5f, 0.5f), 0.0f);
    // Planes through neighbouring corners' rays, whose normals point inwards.
    std::array<Vec3f, 4> normals;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Ray& next = rays[(i + 1) % rays.size()];
        const Vec3f normal = cross(rays[i].direction, next.origin + next.direction - rays[i].origin);
        normals[i] = dot(normal, middle.origin + middle.direction - rays[i].origin) < 0.0f ? -normal : normal;
    }
    return std::ranges::any_of(lamp_bounds_, [&](const Bounds& box) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Vec3f& n = normals[i];
            const Vec3f inmost{n.x < 0.0f ? box.min.x : box.max.x, n.y < 0.0f ? box.min.y : box.max.y,
                               n.z < 0.0f ? box.min.z : box.max.z};
            if (dot(n, inmost - rays[i].origin) < 0.0f) return false;
        }
        return true;
    });
}

}  // namespace etendue
