#include "world/material_evaluation.h"

#include "world/interpolation.h"
#include "world/lookup.h"
#include "world/relief_spread.h"

#include <algorithm>
#include <cmath>

namespace etendue {

float evaluate_opacity(const WorldData& data, std::uint32_t geometry_index, std::uint32_t triangle_index,
                       Vec2f barycentric) {
    const Geometry& geometry = data.geometries[geometry_index];
    const Material& material = data.materials[geometry.material];
    if (material.alpha_test == AlphaTest::Opaque) return 1.0f;
    float alpha = material.alpha_factor;
    Vec2f uv[2];
    if (geometry.shape) {
        uv[0] = uv[1] = geometry.shape->uv(shape_place(triangle_index, barycentric));
    } else {
        const auto& triangle = geometry.triangles[triangle_index];
        if (!geometry.colors.empty()) alpha *= interpolate(geometry.colors, triangle, barycentric).w;
        uv[0] = interpolate_uv(geometry.uv0, triangle, barycentric);
        uv[1] = interpolate_uv(geometry.uv1, triangle, barycentric);
    }
    if (material.alpha_texture.valid()) alpha *= lookup_point(data, material.alpha_texture, uv).alpha;
    if (material.alpha_test == AlphaTest::Mask) return alpha >= material.alpha_cutoff ? 1.0f : 0.0f;
    return std::clamp(alpha, 0.0f, 1.0f);
}

Rgb evaluate_base_color(const WorldData& data, const GltfModel& model, const SurfacePoint& point) {
    Rgb color = model.base_color * Rgb(point.color.x, point.color.y, point.color.z);
    if (model.base_color_texture.valid()) color *= lookup(data, model.base_color_texture, point).rgb;
    return working_base_color(data, color);
}

Rgb working_base_color(const WorldData& data, const Rgb& color) {
    return clamp_unit(data.from_rec709(color));
}

Rgb evaluate_emission(const WorldData& data, const Material& material, const SurfacePoint& point) {
    if (!material.emission_texture.valid()) return material.emission;
    return clamp_negative(
        data.from_rec709(material.emission * lookup_point(data, material.emission_texture, point.uv).rgb));
}

Frame apply_normal_map(const WorldData& data, const TextureSlot& map, float scale, const SurfacePoint& point,
                       const Frame& frame, float bitangent_sign) {
    const Rgb texel = lookup(data, map, point).rgb;
    const Vec3f mapped{(2.0f * texel.r - 1.0f) * scale, (2.0f * texel.g - 1.0f) * scale, 2.0f * texel.b - 1.0f};
    const Vec3f normal =
        frame.tangent * mapped.x + frame.bitangent * (mapped.y * bitangent_sign) + frame.normal * mapped.z;
    // A mapped normal below the surface is no normal; the interpolated one stands.
    if (!(dot(normal, frame.normal) > 1e-3f * length(normal))) return frame;
    return Frame::from_normal_and_tangent(normalize(normal), frame.tangent);
}

SlopeCovariance relief_below(const WorldData& data, const TextureSlot& map, float scale, const SurfacePoint& point,
                             const Frame& frame, float bitangent_sign, const Frame& mapped) {
    const SlopeCovariance covariance = lookup_slope_covariance(data, map, point);
    if (covariance.is_zero()) return {};
    const SlopeCovariance scaled{covariance.xx * scale * scale, covariance.xy * scale * scale,
                                 covariance.yy * scale * scale};
    return tilted(scaled, {frame.tangent, frame.bitangent * bitangent_sign, frame.normal}, mapped);
}

Frame apply_anisotropy(const WorldData& data, const Material& material, const SurfacePoint& point, const Frame& frame,
                       float bitangent_sign) {
    Vec2f direction(1.0f, 0.0f);
    if (material.anisotropy_texture.valid()) {
        const Rgb texel = lookup(data, material.anisotropy_texture, point).rgb;
        direction = {2.0f * texel.r - 1.0f, 2.0f * texel.g - 1.0f};
    }
    const float c = std::cos(material.anisotropy_rotation);
    const float s = std::sin(material.anisotropy_rotation);
    const Vec3f rougher = frame.tangent * (direction.x * c - direction.y * s) +
                          frame.bitangent * ((direction.x * s + direction.y * c) * bitangent_sign);
    return Frame::from_normal_and_tangent(frame.normal, rougher);
}

}  // namespace etendue
