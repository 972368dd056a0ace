#include "world/material_evaluation.h"

#include "world/interpolation.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

Texel lookup(const WorldData& data, const TextureSlot& slot, const Vec2f (&uv)[2]) {
    const Vec2f c = uv[slot.texcoord];
    const Vec2f transformed{slot.row0.x * c.x + slot.row0.y * c.y + slot.row0.z,
                            slot.row1.x * c.x + slot.row1.y * c.y + slot.row1.z};
    return data.textures[static_cast<std::size_t>(slot.texture)].lookup(transformed);
}

Rgb clamp_unit(const Rgb& c) {
    return {std::clamp(c.r, 0.0f, 1.0f), std::clamp(c.g, 0.0f, 1.0f), std::clamp(c.b, 0.0f, 1.0f)};
}

}  // namespace

float evaluate_opacity(const WorldData& data, std::uint32_t geometry_index, std::uint32_t triangle_index,
                       Vec2f barycentric) {
    const Geometry& geometry = data.geometries[geometry_index];
    const Material& material = data.materials[geometry.material];
    if (material.alpha_test == AlphaTest::Opaque) return 1.0f;
    const auto& triangle = geometry.triangles[triangle_index];
    float alpha = material.alpha_factor;
    if (!geometry.colors.empty()) alpha *= interpolate(geometry.colors, triangle, barycentric).w;
    if (material.alpha_texture.valid()) {
        const Vec2f uv[2] = {interpolate_uv(geometry.uv0, triangle, barycentric),
                             interpolate_uv(geometry.uv1, triangle, barycentric)};
        alpha *= lookup(data, material.alpha_texture, uv).alpha;
    }
    if (material.alpha_test == AlphaTest::Mask) return alpha >= material.alpha_cutoff ? 1.0f : 0.0f;
    return std::clamp(alpha, 0.0f, 1.0f);
}

Rgb evaluate_base_color(const WorldData& data, const GltfModel& model, const SurfacePoint& point) {
    Rgb color = model.base_color * Rgb(point.color.x, point.color.y, point.color.z);
    if (model.base_color_texture.valid()) color *= lookup(data, model.base_color_texture, point.uv).rgb;
    return clamp_unit(data.from_rec709(color));
}

namespace {

/// KHR_materials_specular: tints the reflectance at normal incidence, then scales all of it.
void evaluate_specular(const WorldData& data, const GltfModel& model, const SurfacePoint& point,
                       MetallicRoughness& lobe) {
    lobe.f90 = model.specular;
    if (model.specular_texture.valid()) lobe.f90 *= lookup(data, model.specular_texture, point.uv).alpha;
    Rgb tint = model.specular_color;
    if (model.specular_color_texture.valid()) tint *= lookup(data, model.specular_color_texture, point.uv).rgb;
    const bool is_tinted = !(tint == Rgb(1.0f));
    lobe.f0 = (is_tinted ? clamp_unit(data.from_rec709(tint) * model.f0) : Rgb(model.f0)) * lobe.f90;
}

}  // namespace

Bsdf evaluate_gltf_model(const WorldData& data, const GltfModel& model, const SurfacePoint& point) {
    MetallicRoughness lobe;
    lobe.base = evaluate_base_color(data, model, point);
    float roughness = model.roughness;
    lobe.metallic = model.metallic;
    if (model.metallic_roughness_texture.valid()) {
        const Rgb texel = lookup(data, model.metallic_roughness_texture, point.uv).rgb;
        roughness *= texel.g;
        lobe.metallic *= texel.b;
    }
    lobe.metallic = std::clamp(lobe.metallic, 0.0f, 1.0f);
    roughness = std::clamp(roughness, 0.0f, 1.0f);
    lobe.alpha = roughness * roughness;
    evaluate_specular(data, model, point, lobe);
    lobe.transmission = model.transmission;
    if (model.transmission_texture.valid())
        lobe.transmission *= lookup(data, model.transmission_texture, point.uv).rgb.r;
    return lobe;
}

Rgb evaluate_emission(const WorldData& data, const Material& material, const SurfacePoint& point) {
    if (!material.emission_texture.valid()) return material.emission;
    return clamp_negative(data.from_rec709(material.emission * lookup(data, material.emission_texture, point.uv).rgb));
}

Frame apply_normal_map(const WorldData& data, const Material& material, const SurfacePoint& point,
                       float bitangent_sign) {
    const Rgb texel = lookup(data, material.normal_texture, point.uv).rgb;
    const Vec3f mapped{(2.0f * texel.r - 1.0f) * material.normal_scale, (2.0f * texel.g - 1.0f) * material.normal_scale,
                       2.0f * texel.b - 1.0f};
    const Frame& frame = point.shading;
    const Vec3f normal = frame.tangent * mapped.x + cross(frame.normal, frame.tangent) * (mapped.y * bitangent_sign) +
                         frame.normal * mapped.z;
    // A mapped normal below the surface is no normal; the interpolated one stands.
    if (!(dot(normal, frame.normal) > 1e-3f * length(normal))) return frame;
    return Frame::from_normal_and_tangent(normalize(normal), frame.tangent);
}

}  // namespace etendue
