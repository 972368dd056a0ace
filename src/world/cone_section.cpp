#include "world/cone_section.h"

#include "world/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace etendue {

namespace {

/// The two diameters of the ellipse that the cone cuts out of the surface's plane, metres: along the ray and across it
/// (Akenine-Möller et al. 2021, section 3.2).
struct SectionEllipse {
    Vec3f along;
    Vec3f across;
};

SectionEllipse cut(const ConeSection& section, const Vec3f& normal) {
    // At smaller cosines the ellipse is longer than anything that is filtered well.
    constexpr float kMinCosine = 1e-3f;
    const float cosine = dot(section.direction, normal);
    const Vec3f in_plane = section.direction - normal * cosine;
    const float sine = length(in_plane);
    const Vec3f along = sine > kMinCosine ? in_plane * (1.0f / sine) : Frame::from_normal(normal).tangent;
    return {along * (section.width / std::max(kMinCosine, std::abs(cosine))), cross(normal, along) * section.width};
}

/// `ellipse` in the texture coordinates of a triangle with these edges in world space, whose plane it lies in. A point
/// where the triangle is degenerate.
TextureFootprint to_texture(const SectionEllipse& ellipse, const Vec3f& e1, const Vec3f& e2, const Vec3f& normal,
                            const std::vector<Vec2f>& uv, const std::array<std::uint32_t, 3>& triangle) {
    const float area = dot(cross(e1, e2), normal);
    if (area == 0.0f) return {};
    const Vec2f d1 = (uv[triangle[1]] - uv[triangle[0]]) * (1.0f / area);
    const Vec2f d2 = (uv[triangle[2]] - uv[triangle[0]]) * (1.0f / area);
    const auto transformed = [&](const Vec3f& v) {
        return d1 * dot(cross(v, e2), normal) + d2 * dot(cross(e1, v), normal);
    };
    return {{transformed(ellipse.along), transformed(ellipse.across)}};
}

}  // namespace

void add_footprints(const Geometry& geometry, const Vec3f& edge1, const Vec3f& edge2, const ConeSection& section,
                    SurfacePoint& point) {
    const auto& triangle = geometry.triangles[point.triangle];
    const SectionEllipse ellipse = cut(section, point.geometric_normal);
    if (!geometry.uv0.empty())
        point.footprint[0] = to_texture(ellipse, edge1, edge2, point.geometric_normal, geometry.uv0, triangle);
    if (!geometry.uv1.empty())
        point.footprint[1] = to_texture(ellipse, edge1, edge2, point.geometric_normal, geometry.uv1, triangle);
}

float mean_curvature(const WorldData& data, const SurfacePoint& point) {
    const Geometry& geometry = data.geometries[point.geometry];
    if (geometry.normals.empty()) return 0.0f;
    const Instance& instance = data.instances[point.instance];
    const auto& triangle = geometry.triangles[point.triangle];
    Vec3f p[3];
    Vec3f n[3];
    for (std::size_t i = 0; i < 3; ++i) {
        p[i] = geometry.positions[triangle[i]];
        n[i] = geometry.normals[triangle[i]];
        if (instance.baked) continue;
        p[i] = transform_point(instance.to_world, p[i]);
        n[i] = normalize(transform_normal(instance.to_local, n[i]));
    }
    // Along each edge, the turn of the normal towards the edge per length (Akenine-Möller et al. 2021, section 3.4).
    float sum = 0.0f;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3f edge = p[(i + 1) % 3] - p[i];
        const float squared = length_squared(edge);
        if (squared > 0.0f) sum += dot(n[(i + 1) % 3] - n[i], edge) / squared;
    }
    return std::isfinite(sum) ? sum * (1.0f / 3.0f) : 0.0f;
}

}  // namespace etendue
