#include "world/surface_point.h"

#include "core/position_error.h"
#include "world/cone_section.h"
#include "world/gltf_surface.h"
#include "world/interpolation.h"
#include "world/material_evaluation.h"
#include "world/motion.h"
#include "world/relief_spread.h"
#include "world/section_ellipse.h"
#include "world/triangle_point.h"
#include "world/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

namespace etendue {

namespace {

/// Where a moving triangle is at one time, in the space of its mesh.
struct MovedTriangle {
    std::array<Vec3f, 3> p{};
    Vec3f extent{0.0f};  ///< largest coordinates, absolute, of what `p` was made from
    Vec3f normal{0.0f};  ///< interpolated, if there are any
};

MovedTriangle move_triangle(const Geometry& geometry, const std::array<std::uint32_t, 3>& triangle, Vec2f barycentric,
                            float time) {
    const MotionSegment segment = motion_segment(geometry.motion.size(), time);
    const VertexStep& before = geometry.motion[segment.first];
    const VertexStep& after = geometry.motion[segment.first + 1];
    const auto between = [t = segment.t](const Vec3f& a, const Vec3f& b) { return a * (1.0f - t) + b * t; };
    MovedTriangle moved;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3f& a = before.positions[triangle[i]];
        const Vec3f& b = after.positions[triangle[i]];
        moved.p[i] = between(a, b);
        moved.extent = max_components(moved.extent, max_components(abs_components(a), abs_components(b)));
    }
    if (!before.normals.empty())
        moved.normal = between(interpolate(before.normals, triangle, barycentric),
                               interpolate(after.normals, triangle, barycentric));
    return moved;
}

/// Rounding between two steps of a motion goes with where they are, however close to the origin what lies between is.
Vec3f step_error(const Vec3f& extent, const TransformMotion& steps, float time) {
    const std::size_t first = motion_segment(steps.size(), time).first;
    return max_components(position_error(extent, steps[first]), position_error(extent, steps[first + 1]));
}

/// Sets how much rougher the base is for the relief that its normal map averages, and turns the frame to its axes.
void apply_base_spread(const WorldData& data, const Material& material, const Frame& interpolated, float bitangent_sign,
                       SurfacePoint& point) {
    const auto* model = std::get_if<GltfModel>(&material.model);
    // Light goes straight through a thin sheet, whatever its normal is there.
    if (model != nullptr && model->transmission > 0.0f && !model->refracts) return;
    const SlopeCovariance relief = relief_below(data, material.normal_texture, material.normal_scale, point,
                                                interpolated, bitangent_sign, point.shading);
    if (relief.is_zero()) return;
    const Vec2f alpha =
        material.is_anisotropic && model != nullptr ? evaluate_alpha(data, *model, point) : Vec2f(0.0f, 0.0f);
    const RoughnessAxes axes = roughness_axes(alpha, relief);
    point.shading = Frame::from_normal_and_tangent(
        point.shading.normal, point.shading.tangent * axes.direction.x + point.shading.bitangent * axes.direction.y);
    point.slope_variance = axes.added_variance;
}

/// Makes of the interpolated frame what the material's maps say. The base's relief does not show in a coat over it.
void apply_relief(const WorldData& data, const Material& material, float bitangent_sign, SurfacePoint& point) {
    const Frame interpolated = point.shading;
    if (material.normal_texture.valid())
        point.shading =
            apply_normal_map(data, material.normal_texture, material.normal_scale, point, interpolated, bitangent_sign);
    if (material.is_anisotropic) point.shading = apply_anisotropy(data, material, point, point.shading, bitangent_sign);
    if (material.normal_texture.valid()) apply_base_spread(data, material, interpolated, bitangent_sign, point);
    if (!material.has_coat) return;
    point.coat_normal = interpolated.normal;
    if (!material.coat_normal_texture.valid()) return;
    const Frame coat = apply_normal_map(data, material.coat_normal_texture, material.coat_normal_scale, point,
                                        interpolated, bitangent_sign);
    point.coat_normal = coat.normal;
    point.coat_slope_variance = 0.5f * relief_below(data, material.coat_normal_texture, material.coat_normal_scale,
                                                    point, interpolated, bitangent_sign, coat)
                                           .trace();
}

/// Returns a point of this triangle, of which nothing else is known yet.
SurfacePoint begin_point(const WorldData& data, std::uint32_t instance, std::uint32_t geometry,
                         std::uint32_t triangle) {
    SurfacePoint point;
    point.material = &data.materials[data.geometries[geometry].material];
    point.instance = instance;
    point.geometry = geometry;
    point.triangle = triangle;
    return point;
}

/// Returns the mesh's tangent at a point of it and, as `w`, the sign of its bitangent; a tangent of length 0 if it has
/// none.
Vec4f mesh_tangent(const Geometry& geometry, const std::array<std::uint32_t, 3>& triangle, Vec2f barycentric) {
    if (geometry.tangents.empty()) return {0.0f, 0.0f, 0.0f, 1.0f};
    const Vec4f tangent = interpolate(geometry.tangents, triangle, barycentric);
    return {tangent.x, tangent.y, tangent.z, geometry.tangents[triangle[0]].w};
}

/// Returns the frame around `normal` along `tangent`, or along anything if that has length 0.
Frame frame_around(const Vec3f& normal, const Vec3f& tangent) {
    return length_squared(tangent) > 0.0f ? Frame::from_normal_and_tangent(normal, tangent)
                                          : Frame::from_normal(normal);
}

/// `Moves` is false for what neither moves nor deforms, so that it does not pay for what does.
template <bool Moves>
SurfacePoint make_point(const WorldData& data, std::uint32_t instance_index, std::uint32_t geometry_index,
                        std::uint32_t triangle_index, Vec2f barycentric, float time, const ConeSection& section) {
    const Instance& instance = data.instances[instance_index];
    const Geometry& geometry = data.geometries[geometry_index];
    const auto& triangle = geometry.triangles[triangle_index];
    SurfacePoint point = begin_point(data, instance_index, geometry_index, triangle_index);
    const Material& material = *point.material;

    const bool deforms = Moves && !geometry.motion.empty();
    MovedTriangle moved;
    if (deforms) moved = move_triangle(geometry, triangle, barycentric, time);
    const Vec3f p0 = deforms ? moved.p[0] : geometry.positions[triangle[0]];
    const Vec3f e1 = (deforms ? moved.p[1] : geometry.positions[triangle[1]]) - p0;
    const Vec3f e2 = (deforms ? moved.p[2] : geometry.positions[triangle[2]]) - p0;
    const TrianglePoint<float> on_triangle(p0, e1, e2, barycentric);
    point.position = on_triangle.position;
    Vec3f geometric = on_triangle.normal;
    Vec3f extent = on_triangle.extent;
    if (deforms) extent = max_components(extent, moved.extent);
    const bool is_smooth = !(deforms ? geometry.motion.front().normals : geometry.normals).empty();
    Vec3f shading = !is_smooth ? geometric
                    : deforms  ? moved.normal
                               : interpolate(geometry.normals, triangle, barycentric);

    point.uv[0] = interpolate_uv(geometry.uv0, triangle, barycentric);
    point.uv[1] = interpolate_uv(geometry.uv1, triangle, barycentric);
    if (!geometry.colors.empty()) point.color = interpolate(geometry.colors, triangle, barycentric);

    const Vec4f signed_tangent = mesh_tangent(geometry, triangle, barycentric);
    Vec3f tangent(signed_tangent.x, signed_tangent.y, signed_tangent.z);
    float bitangent_sign = signed_tangent.w;

    const bool moves = Moves && instance.motion != kNone;
    const Mat4f moved_to_world =
        moves ? transform_at(data.motions[instance.motion], time) : Mat4f(Imath::UNINITIALIZED);
    const Mat4f& to_world = moves ? moved_to_world : instance.to_world;
    if (!instance.baked) {
        const Mat4f moved_to_local = moves ? to_world.inverse() : Mat4f(Imath::UNINITIALIZED);
        const Mat4f& to_local = moves ? moved_to_local : instance.to_local;
        point.position = transform_point(to_world, point.position);
        geometric = transform_normal(to_local, geometric);
        shading = transform_normal(to_local, shading);
        tangent = transform_vector(to_world, tangent);
        if (instance.mirrors) bitangent_sign = -bitangent_sign;
    }
    point.geometric_normal = instance.baked ? geometric : normalize(geometric);
    Vec3f error = instance.baked ? position_error(extent) : position_error(extent, to_world);
    if (moves) error = max_components(error, step_error(extent, data.motions[instance.motion], time));
    point.clearance = clearance(point.geometric_normal, error);
    if (section.width > 0.0f) {
        const auto to_scene = [&](const Vec3f& edge) {
            return instance.baked ? edge : transform_vector(to_world, edge);
        };
        add_footprints(geometry, to_scene(e1), to_scene(e2), section, point);
    }
    const Vec3f normal = is_smooth ? usable_normal(shading, point.geometric_normal) : point.geometric_normal;
    point.shading = frame_around(normal, tangent);
    if (material.needs_tangents() || material.has_coat) apply_relief(data, material, bitangent_sign, point);
    return point;
}

/// Makes the point of a shape, which is smooth: its geometric normal is the shading normal, too.
SurfacePoint make_point_of_shape(const WorldData& data, std::uint32_t instance_index, std::uint32_t geometry_index,
                                 std::uint32_t triangle_index, Vec2f barycentric, float time,
                                 const ConeSection& section) {
    const Instance& instance = data.instances[instance_index];
    const Geometry& geometry = data.geometries[geometry_index];
    SurfacePoint point = begin_point(data, instance_index, geometry_index, triangle_index);
    const Material& material = *point.material;

    ShapePoint on_shape = geometry.shape->point(shape_place(triangle_index, barycentric));
    Vec3f extent(0.0f);
    for (const Vec3f& corner : geometry.positions) extent = max_components(extent, abs_components(corner));
    Vec3f error = position_error(extent);
    if (!instance.baked) {
        const bool moves = instance.motion != kNone;
        const Mat4f to_world = moves ? transform_at(data.motions[instance.motion], time) : instance.to_world;
        error = position_error(extent, to_world);
        if (moves) error = max_components(error, step_error(extent, data.motions[instance.motion], time));
        on_shape.position = transform_point(to_world, on_shape.position);
        on_shape.normal = normalize(transform_normal(moves ? to_world.inverse() : instance.to_local, on_shape.normal));
        on_shape.along_u = transform_vector(to_world, on_shape.along_u);
        on_shape.along_v = transform_vector(to_world, on_shape.along_v);
    }
    point.position = on_shape.position;
    point.geometric_normal = on_shape.normal;
    point.clearance = clearance(point.geometric_normal, error);
    point.uv[0] = point.uv[1] = on_shape.uv;
    if (section.width > 0.0f) {
        const SectionEllipse<float> ellipse(section.direction, section.width, point.geometric_normal);
        const TextureEllipse<float> in_texture(ellipse, on_shape.along_u, on_shape.along_v, point.geometric_normal,
                                               {1.0f, 0.0f}, {0.0f, 1.0f});
        point.footprint[0] = point.footprint[1] = {{in_texture.along, in_texture.across}};
    }
    // Along the image of the texture as it lies on the shape, its transform included.
    Vec3f tangent = on_shape.along_u;
    Vec3f down = on_shape.along_v;
    if (const TextureSlot* slot = material.tangent_texture()) {
        const float determinant = slot->row0.x * slot->row1.y - slot->row0.y * slot->row1.x;
        const float sign = determinant < 0.0f ? -1.0f : 1.0f;
        tangent = (on_shape.along_u * slot->row1.y - on_shape.along_v * slot->row1.x) * sign;
        down = (on_shape.along_v * slot->row0.x - on_shape.along_u * slot->row0.y) * sign;
    }
    point.shading = Frame::from_normal_and_tangent(
        point.geometric_normal, tangent * (1.0f / std::max(max_abs(tangent), std::numeric_limits<float>::min())));
    const float bitangent_sign = dot(point.shading.bitangent, down) > 0.0f ? -1.0f : 1.0f;
    if (material.needs_tangents() || material.has_coat) apply_relief(data, material, bitangent_sign, point);
    return point;
}

}  // namespace

SurfacePoint make_surface_point(const WorldData& data, std::uint32_t instance, std::uint32_t geometry,
                                std::uint32_t triangle, Vec2f barycentric, float time, const ConeSection& section) {
    if (data.geometries[geometry].shape)
        return make_point_of_shape(data, instance, geometry, triangle, barycentric, time, section);
    const bool moves = data.instances[instance].motion != kNone || !data.geometries[geometry].motion.empty();
    return moves ? make_point<true>(data, instance, geometry, triangle, barycentric, time, section)
                 : make_point<false>(data, instance, geometry, triangle, barycentric, time, section);
}

}  // namespace etendue
