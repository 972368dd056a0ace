#include "light/light_aim.h"

#include "core/bounds.h"
#include "core/frame.h"
#include "core/trigonometry.h"
#include "sampling/warp.h"

#include <algorithm>
#include <utility>

namespace etendue {

namespace {

/// Returns a sphere around all of `spheres`.
AimSphere around(std::span<const AimSphere> spheres) {
    if (spheres.size() == 1) return spheres.front();
    Bounds bounds;
    for (const AimSphere& sphere : spheres) {
        bounds.extend(sphere.center - Vec3f(sphere.radius));
        bounds.extend(sphere.center + Vec3f(sphere.radius));
    }
    AimSphere all{bounds.center(), 0.0f};
    for (const AimSphere& sphere : spheres)
        all.radius = std::max(all.radius, length(sphere.center - all.center) + sphere.radius);
    return all;
}

/// Adds spheres around as many groups of `spheres` as `count`, halved along the longest extent of their centres.
void add_groups(std::span<AimSphere> spheres, std::size_t count, std::vector<AimSphere>& groups) {
    if (spheres.size() <= count) {
        groups.insert(groups.end(), spheres.begin(), spheres.end());
        return;
    }
    if (count == 1) {
        groups.push_back(around(spheres));
        return;
    }
    Bounds centers;
    for (const AimSphere& sphere : spheres) centers.extend(sphere.center);
    const Vec3f size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = spheres.size() / 2;
    std::ranges::stable_sort(spheres, {}, [axis](const AimSphere& sphere) { return sphere.center[axis]; });
    add_groups(spheres.first(middle), count / 2, groups);
    add_groups(spheres.subspan(middle), count - count / 2, groups);
}

}  // namespace

LightAim::LightAim(std::vector<AimSphere> spheres) {
    if (!spheres.empty()) add_groups(spheres, kMostSpheres, spheres_);
}

std::optional<Vec3f> LightAim::aim(const Vec3f& point, const LightCone<float>& cone, Vec2f& u) const {
    float solid = 0.0f;
    for (const AimSphere& sphere : spheres_) solid += view(sphere, point, cone).solid;
    if (!(solid > 0.0f)) return {};
    const float part = share(solid, 1.0f - cone.cos_half);
    if (u.x >= part) {
        u.x = std::min((u.x - part) / (1.0f - part), kOneMinusEpsilon);
        return {};
    }
    float left = u.x / part * solid;
    for (const AimSphere& sphere : spheres_) {
        const View<float> seen = view(sphere, point, cone);
        if (left >= seen.solid) {
            left -= seen.solid;
            continue;
        }
        // Uniform in one minus the cosine.
        const SinCos turn = sin_cos_turns(u.y);
        const float sine = std::sqrt(left * (2.0f - left));
        const Vec3f local{sine * turn.cos, sine * turn.sin, 1.0f - left};
        const float distance = length(seen.to);
        if (!(distance > 0.0f)) return local;
        return normalize(Frame::from_normal(seen.to * (1.0f / distance)).to_world(local));
    }
    return cone.axis;  // all that rounding leaves
}

float LightAim::pdf_area(const Vec3f& point, const Vec3f& direction, float own, bool is_aimed) const {
    float area = 0.0f;
    float around = 0.0f;
    for (const AimSphere& sphere : spheres_) {
        const Vec3f apart = point - sphere.center;
        area += sphere.radius * sphere.radius;
        if (length_squared(apart - direction * dot(apart, direction)) <= sphere.radius * sphere.radius) around += 1.0f;
    }
    if (!(area > 0.0f)) return own;
    if (is_aimed) around = std::max(around, 1.0f);
    const float part = share(area, kInvPi / own);
    return own + part * (around * kInvPi / area - own);
}

std::optional<Vec3f> LightAim::aim_from_afar(const Vec3f& direction, float own, Vec2f& u) const {
    float area = 0.0f;
    for (const AimSphere& sphere : spheres_) area += sphere.radius * sphere.radius;
    if (!(area > 0.0f)) return {};
    const float part = share(area, kInvPi / own);
    if (u.x >= part) {
        u.x = std::min((u.x - part) / (1.0f - part), kOneMinusEpsilon);
        return {};
    }
    float left = u.x / part * area;
    for (const AimSphere& sphere : spheres_) {
        const float squared = sphere.radius * sphere.radius;
        if (left >= squared) {
            left -= squared;
            continue;
        }
        const Vec2f d = square_to_disk({std::min(left / squared, kOneMinusEpsilon), u.y}) * sphere.radius;
        const Frame frame = Frame::from_normal(direction);
        return sphere.center + frame.tangent * d.x + frame.bitangent * d.y;
    }
    return spheres_.front().center;  // all that rounding leaves
}

}  // namespace etendue
