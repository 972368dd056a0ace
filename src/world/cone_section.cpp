#include "world/cone_section.h"

#include "world/section_ellipse.h"
#include "world/world.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace etendue {

void add_footprints(const Geometry& geometry, const Vec3f& edge1, const Vec3f& edge2, const ConeSection& section,
                    SurfacePoint& point) {
    const auto& triangle = geometry.triangles[point.triangle];
    const Vec3f& normal = point.geometric_normal;
    const SectionEllipse<float> ellipse(section.direction, section.width, normal);
    const auto to_texture = [&](const std::vector<Vec2f>& uv) -> TextureFootprint {
        const TextureEllipse<float> in_texture(ellipse, edge1, edge2, normal, uv[triangle[1]] - uv[triangle[0]],
                                               uv[triangle[2]] - uv[triangle[0]]);
        return {{in_texture.along, in_texture.across}};
    };
    if (!geometry.uv0.empty()) point.footprint[0] = to_texture(geometry.uv0);
    if (!geometry.uv1.empty()) point.footprint[1] = to_texture(geometry.uv1);
}

float mean_curvature(const WorldData& data, const Hit& hit) {
    const Geometry& geometry = data.geometries[hit.geometry];
    const Instance& instance = data.instances[hit.instance];
    if (geometry.shape)
        return geometry.shape->mean_curvature(shape_place(hit.triangle, {hit.u, hit.v}), instance.to_world);
    if (geometry.normals.empty()) return 0.0f;
    const auto& triangle = geometry.triangles[hit.triangle];
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
