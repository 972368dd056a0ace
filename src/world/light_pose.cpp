#include "world/light_pose.h"

#include "light/light.h"
#include "world/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

namespace {

/// Limits how much a rigid motion may stretch and shear a light, as a share of lengths.
constexpr float kRigid = 2e-3f;

/// Returns whether `m` is a rotation and a translation, within kRigid.
bool is_rigid(const Mat4f& m) {
    const Vec3f x(m[0][0], m[0][1], m[0][2]);
    const Vec3f y(m[1][0], m[1][1], m[1][2]);
    const Vec3f z(m[2][0], m[2][1], m[2][2]);
    const auto is_unit = [](const Vec3f& axis) { return std::abs(length(axis) - 1.0f) <= kRigid; };
    const auto are_square = [](const Vec3f& a, const Vec3f& b) { return std::abs(dot(a, b)) <= kRigid; };
    return is_unit(x) && is_unit(y) && is_unit(z) && are_square(x, y) && are_square(y, z) && are_square(z, x) &&
           dot(cross(x, y), z) > 0.0f;
}

/// Returns the angle, in radians, by which the rigid transform `m` rotates.
double rotation_angle(const Mat4f& m) {
    const auto off = [&m](int i, int j) { return static_cast<double>(m[i][j]) - static_cast<double>(m[j][i]); };
    const double trace = static_cast<double>(m[0][0]) + static_cast<double>(m[1][1]) + static_cast<double>(m[2][2]);
    return std::atan2(std::hypot(off(1, 2), off(2, 0), off(0, 1)), trace - 1.0);
}

}  // namespace

LightPose::LightPose(const TransformMotion& motion, float time)
    : to_world_(transform_at(motion, time)), to_frame_(to_world_.inverse()) {}

void LightPose::to_world(LightSample& sample) const {
    if (is_black(sample.radiance)) return;
    const Vec3f to_light = transform_vector(to_world_, sample.wi * sample.distance);
    sample.distance = length(to_light);
    sample.wi = to_light * (1.0f / sample.distance);
    sample.end = transform_point(to_world_, sample.end);
}

void LightPose::to_world(EmissionSample& sample) const {
    sample.position = transform_point(to_world_, sample.position);
    sample.offset = transform_vector(to_world_, sample.offset);
    sample.direction = normalize(transform_vector(to_world_, sample.direction));
}

Mat4f frame_of(const TransformMotion& motion) {
    Mat4f frame = motion[(motion.size() - 1) / 2];
    const Mat4f middle = transform_at(motion, kMidShutter);
    for (int i = 0; i < 3; ++i) frame[3][i] = middle[3][i];
    return frame;
}

std::optional<TransformMotion> rigid_motion(const TransformMotion& motion) {
    const Mat4f to_frame = frame_of(motion).inverse();
    TransformMotion relative;
    for (const Mat4f& step : motion) relative.push_back(to_frame * step);
    for (std::size_t i = 0; i < relative.size(); ++i) {
        // Linear interpolation shrinks rotations most in the middle between two steps.
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
        bounds->box.extend(placed(still, step));
        most = std::max(most, rotation_angle(step));
    }
    bounds->cone.theta_o = std::min(std::numbers::pi, bounds->cone.theta_o + most);
    return bounds;
}

}  // namespace etendue
