#include "light/light_rectangle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace etendue {

namespace {

std::array<Vec3d, 3> corners_of(const LightTriangle& t) {
    const Vec3d p0(t.p0);
    return {p0, p0 + Vec3d(t.edge1), p0 + Vec3d(t.edge2)};
}

/// Bounds the solid angle, steradians, up to which a rectangle is sampled by area, which takes a fraction of the time.
constexpr float kLeastSolidAngle = 1.0f;

Vec3d front_of(const LightTriangle& t) {
    return Vec3d(t.edge1).cross(Vec3d(t.edge2));
}

}  // namespace

std::optional<LightRectangle> LightRectangle::find(std::span<const LightTriangle> triangles, float clearance) {
    constexpr double kTolerance = 1e-5;  // of sides and angles
    if (triangles.size() != 2) return std::nullopt;
    if (!(front_of(triangles[0]).dot(front_of(triangles[1])) > 0.0)) return std::nullopt;
    const std::array<Vec3d, 3> p = corners_of(triangles[0]);
    for (std::size_t c = 0; c < 3; ++c) {
        const Vec3d x = p[(c + 1) % 3] - p[c];
        const Vec3d y = p[(c + 2) % 3] - p[c];
        if (!(std::abs(x.dot(y)) <= kTolerance * x.length() * y.length())) continue;
        // Each vertex has to be a corner, the other triangle's those that face this one's.
        const double nearest = kTolerance * std::min(x.length(), y.length());
        LightRectangle found;
        std::array<std::array<Vec2f, 3>, 2> vertices;
        int corners = 0;
        for (std::size_t t = 0; t < 2; ++t) {
            const std::array<Vec3d, 3> q = corners_of(triangles[t]);
            for (std::size_t v = 0; v < 3; ++v)
                for (const auto& [i, j] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
                    if (!((q[v] - p[c] - x * i - y * j).length() <= nearest)) continue;
                    vertices[t][v] = {static_cast<float>(i), static_cast<float>(j)};
                    corners += (t == 1 && i + j == 0) ? 0 : 1;
                }
        }
        if (corners != 6) return std::nullopt;
        for (std::size_t t = 0; t < 2; ++t) {
            const Vec2f a = vertices[t][1] - vertices[t][0];
            const Vec2f b = vertices[t][2] - vertices[t][0];
            const float determinant = a.x * b.y - a.y * b.x;  // 1 or -1, unless two vertices are in one corner
            if (determinant == 0.0f) return std::nullopt;
            found.halves_[t] = {vertices[t][0], Vec2f(b.y, -b.x) / determinant, Vec2f(-a.y, a.x) / determinant};
        }
        found.corner_ = Vec3f(p[c]);
        found.axis_x_ = Vec3f(x.normalized());
        found.axis_y_ = Vec3f(y.normalized());
        found.normal_ = Vec3f(x.cross(y).normalized());
        found.size_ = {static_cast<float>(x.length()), static_cast<float>(y.length())};
        found.center_ = Vec3f(p[c] + (x + y) * 0.5);
        // The bound of `seen_nearby` is below area / d², where d is the distance from the nearest point.
        const double area = x.cross(y).length();
        const double near = 0.5 * (x + y).length() + std::sqrt(1.001 * area / static_cast<double>(kLeastSolidAngle));
        found.near_squared_ = static_cast<float>(near * near);
        // The points of other surfaces are rounded, too, and so is their distance.
        found.flat_ = 4.0f * clearance;
        return found;
    }
    return std::nullopt;
}

std::optional<SphericalRectangle> LightRectangle::seen_nearby(const Vec3f& point) const {
    const Vec3f to_corner = corner_ - point;
    const Vec3f corner(dot(to_corner, axis_x_), dot(to_corner, axis_y_), dot(to_corner, normal_));
    // A plane does not light itself: rounding alone would have half a sphere of it seen from each of its points.
    if (std::abs(corner.z) <= flat_) return std::nullopt;
    // The solid angle is the integral of |z| / d³ over the area, so at most its largest value times the area.
    const float x = std::max({corner.x, -corner.x - size_.x, 0.0f});
    const float y = std::max({corner.y, -corner.y - size_.y, 0.0f});
    const float nearest_squared = x * x + y * y + corner.z * corner.z;
    const float bound = size_.x * size_.y * std::abs(corner.z);
    if (!(bound > kLeastSolidAngle * nearest_squared * std::sqrt(nearest_squared))) return std::nullopt;
    const SphericalRectangle seen(corner, size_);
    if (!(seen.solid_angle() > 0.0)) return std::nullopt;
    return seen;
}

RectanglePlace LightRectangle::place(Vec2f along_sides) const {
    const std::uint32_t triangle = along_sides.x + along_sides.y <= 1.0f ? 0 : 1;
    const Half& half = halves_[triangle];
    const Vec2f away = along_sides - half.first;
    const auto bounded = [](float b) { return std::clamp(b, 0.0f, 1.0f); };
    return {triangle, {bounded(away.dot(half.to_second)), bounded(away.dot(half.to_third))}};
}

}  // namespace etendue
