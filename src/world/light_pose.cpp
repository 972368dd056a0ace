#include "world/light_pose.h"

#include "light/light.h"
#include "world/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

namespace {

/// Is how much a motion may stretch and shear a light that is taken to be rigid.
constexpr float kRigid = 2e-3f;

/// Returns whether `m` turns and shifts alone.
bool is_rigid(const Mat4f& m) {
    const Vec3f x(m[0][0], m[0][1], m[0][2]);
    const Vec3f y(m[1][0], m[1][1], m[1][2]);
    const Vec3f z(m[2][0], m[2][1], m[2][2]);
    const auto is_unit = [](const Vec3f& axis) { return std::abs(length(axis) - 1.0f) <= kRigid; };
    const auto are_square = [](const Vec3f& a, const Vec3f& b) { return std::abs(dot(a, b)) <= kRigid; };
    return is_unit(x) && is_unit(y) && is_unit(z) && are_square(x, y) && are_square(y, z) && are_square(z, x) &&
           dot(cross(x, y), z) > 0.0f;
}

/// Returns the angle by which `m`, rigid, turns, radians.
double turn(const Mat4f& m) {
    const double trace = static_cast<double>(m[0][0]) + static_cast<double>(m[1][1]) + static_cast<double>(m[2][2]);
    return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

}  // namespace

LightPose::LightPose(const TransformMotion& motion, float time)
    : to_world_(transform_at(motion, time)), to_frame_(to_world_.inverse()) {}

void LightPose::to_world(LightSample& sample, const Vec3f& point) const {
    const Vec3f on_light = transform_point(to_world_, point_in_frame(point) + sample.wi * sample.distance);
    const Vec3f to_light = on_light - point;
    sample.distance = length(to_light);
    sample.wi = to_light * (1.0f / sample.distance);
    sample.end = transform_point(to_world_, sample.end);
}

void LightPose::to_world(EmissionSample& sample) const {
    sample.position = transform_point(to_world_, sample.position);
    sample.offset = transform_vector(to_world_, sample.offset);
    sample.direction = normalize(transform_vector(to_world_, sample.direction));
}

std::optional<TransformMotion> rigid_motion(const TransformMotion& motion) {
    const Mat4f to_frame = transform_at(motion, kMidShutter).inverse();
    TransformMotion relative;
    for (const Mat4f& step : motion) relative.push_back(to_frame * step);
    for (std::size_t i = 0; i < relative.size(); ++i) {
        // Turns are cut short most in the middle between two steps.
        const bool is_last = i + 1 == relative.size();
        if (!is_rigid(relative[i]) || (!is_last && !is_rigid((relative[i] + relative[i + 1]) * 0.5f))) return {};
    }
    return relative;
}

std::optional<LightBounds> swept_bounds(const WorldData& data, std::uint32_t light) {
    std::optional<LightBounds> bounds = light_bounds(data.lights[light]);
    const TransformMotion* const motion = data.motion_of(light);
    if (!bounds || motion == nullptr) return bounds;
    const Bounds still = bounds->box;
    double most = 0.0;
    for (const Mat4f& step : *motion) {
        for (int corner = 0; corner < 8; ++corner)
            bounds->box.extend(transform_point(
                step, {(corner & 1) != 0 ? still.max.x : still.min.x, (corner & 2) != 0 ? still.max.y : still.min.y,
                       (corner & 4) != 0 ? still.max.z : still.min.z}));
        most = std::max(most, turn(step));
    }
    bounds->cone.theta_o = std::min(std::numbers::pi, bounds->cone.theta_o + most);
    return bounds;
}

}  // namespace etendue
