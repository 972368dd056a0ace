#include "world/gltf_surface.h"

#include "bsdf/widening.h"
#include "world/lookup.h"
#include "world/material_evaluation.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

float red(const Texel& t) {
    return t.rgb.r;
}
float green(const Texel& t) {
    return t.rgb.g;
}
float blue(const Texel& t) {
    return t.rgb.b;
}
float alpha(const Texel& t) {
    return t.alpha;
}

/// Textures of floating point hold what they like, also what is no number.
float unit(float v) {
    return v > 0.0f ? std::min(v, 1.0f) : 0.0f;
}

float squared(float v) {
    return v * v;
}

/// KHR_materials_specular: tints the reflectance at normal incidence, then scales all of it.
struct Specular {
    float weight;
    Rgb tint;  ///< linear Rec.709

    Specular(const WorldData& data, const GltfModel& model, const SurfacePoint& point)
        : weight(unit(scaled(data, model.specular, model.specular_texture, point, alpha))),
          tint(scaled(data, model.specular_color, model.specular_color_texture, point)) {}

    [[nodiscard]] bool is_tinted() const { return !(tint == Rgb(1.0f)); }
    /// KHR_materials_pbrSpecularGlossiness leaves this share of the base colour.
    [[nodiscard]] float not_reflected() const { return 1.0f - unit(max_component(tint)); }
    [[nodiscard]] Rgb f0(const WorldData& data, float f0) const {
        return (is_tinted() ? clamp_unit(data.from_rec709(tint * f0)) : Rgb(f0)) * weight;
    }
    [[nodiscard]] InterfaceFresnel on_interface(const WorldData& data, const ThinFilm& film) const {
        return {
            .tint = is_tinted() ? clamp_negative(data.from_rec709(tint)) : Rgb(1.0f), .weight = weight, .film = film};
    }
};

ThinFilm evaluate_film(const WorldData& data, const GltfLayers& layers, const SurfacePoint& point) {
    if (!(layers.iridescence > 0.0f)) return {};
    float thickness = layers.film_thickness_maximum_nm;
    if (layers.film_thickness_texture.valid()) {
        const float t = lookup(data, layers.film_thickness_texture, point).rgb.g;
        thickness = layers.film_thickness_minimum_nm +
                    (layers.film_thickness_maximum_nm - layers.film_thickness_minimum_nm) * t;
    }
    if (!(thickness > 0.0f)) return {};
    return {.strength = unit(scaled(data, layers.iridescence, layers.iridescence_texture, point, red)),
            .ior = layers.film_ior,
            .thickness_nm = thickness,
            .xyz_to_working = &data.xyz_to_working};
}

/// Adds to `lobe` what the extensions say of the base.
void evaluate_base_layers(const WorldData& data, const GltfLayers& layers, const SurfacePoint& point,
                          MetallicRoughness& lobe) {
    lobe.film = evaluate_film(data, layers, point);
    lobe.diffuse_roughness = unit(scaled(data, layers.diffuse_roughness, layers.diffuse_roughness_texture, point, red));
    lobe.diffuse_transmission =
        unit(scaled(data, layers.diffuse_transmission, layers.diffuse_transmission_texture, point, alpha));
    if (lobe.diffuse_transmission > 0.0f)
        lobe.diffuse_transmission_color = clamp_unit(data.from_rec709(
            scaled(data, layers.diffuse_transmission_color, layers.diffuse_transmission_color_texture, point)));
}

/// The frame's x axis lies along the direction in which the surface is rougher.
void set_anisotropy(const WorldData& data, const GltfLayers& layers, const SurfacePoint& point,
                    MetallicRoughness& lobe) {
    const float strength = unit(scaled(data, layers.anisotropy, layers.anisotropy_texture, point, blue));
    lobe.alpha_x += (1.0f - lobe.alpha_x) * squared(strength);
}

Rgb metallic_roughness_texel(const WorldData& data, const GltfModel& model, const SurfacePoint& point) {
    if (model.glossiness)
        return Rgb(1.0f - unit(scaled(data, *model.glossiness, model.specular_color_texture, point, alpha)));
    return scaled(data, Rgb(1.0f), model.metallic_roughness_texture, point);
}

/// The surface of a closed body; `lobe` as it would be on a thin sheet.
DielectricBody make_body(const MetallicRoughness& lobe, float relative_ior, const InterfaceFresnel& fresnel) {
    DielectricBody body{.interface = make_interface(relative_ior, {lobe.alpha_x, lobe.alpha_y}, lobe.base, fresnel),
                        .opaque = lobe,
                        .interface_share = (1.0f - lobe.metallic) * lobe.transmission};
    body.opaque.transmission = 0.0f;
    if (body.interface_share < 1.0f)
        body.opaque.metallic = std::min(1.0f, lobe.metallic / (1.0f - body.interface_share));
    return body;
}

Sheen evaluate_sheen(const WorldData& data, const GltfLayers& layers, const SurfacePoint& point) {
    if (is_black(layers.sheen_color)) return {};
    return {.color = clamp_unit(data.from_rec709(scaled(data, layers.sheen_color, layers.sheen_color_texture, point))),
            .alpha = squared(unit(scaled(data, layers.sheen_roughness, layers.sheen_roughness_texture, point, alpha)))};
}

/// Returns a normal of `point` in the frame of its surface. Seen from behind, the frame is turned about its bitangent,
/// and the normal is the opposite one (LayeredSurface::from_behind).
Vec3f in_frame(const SurfacePoint& point, const Vec3f& normal, bool from_back) {
    const Vec3f local = point.shading.to_local(normal);
    return {local.x, from_back ? -local.y : local.y, local.z};
}

Bsdf from_body(const DielectricBody& body) {
    if (body.interface_share < 1.0f) return body;
    return std::visit([](const auto& lobe) { return Bsdf(lobe); }, body.interface);
}

}  // namespace

ClearCoat evaluate_clear_coat(const WorldData& data, const GltfLayers& layers, const SurfacePoint& point,
                              bool from_back) {
    if (!(layers.clearcoat > 0.0f)) return {};
    ClearCoat coat;
    coat.strength = unit(scaled(data, layers.clearcoat, layers.clearcoat_texture, point, red));
    coat.alpha =
        squared(unit(scaled(data, layers.clearcoat_roughness, layers.clearcoat_roughness_texture, point, green)));
    coat.alpha = widened_alpha(coat.alpha, point.coat_slope_variance);
    coat.normal = in_frame(point, point.coat_normal, from_back);
    return coat;
}

void set_metallic_roughness(const GltfModel& model, const Rgb& texel, MetallicRoughness& lobe) {
    lobe.metallic = unit(model.metallic * texel.b);
    lobe.alpha_x = lobe.alpha_y = squared(unit(model.roughness * texel.g));
}

Vec2f evaluate_alpha(const WorldData& data, const GltfModel& model, const SurfacePoint& point) {
    MetallicRoughness lobe;
    set_metallic_roughness(model, metallic_roughness_texel(data, model, point), lobe);
    if (model.layers) set_anisotropy(data, *model.layers, point, lobe);
    return {lobe.alpha_x, lobe.alpha_y};
}

Bsdf evaluate_gltf_surface(const WorldData& data, const GltfModel& model, const SurfacePoint& point, float relative_ior,
                           bool from_back) {
    MetallicRoughness lobe;
    lobe.base = evaluate_base_color(data, model, point);
    set_metallic_roughness(model, metallic_roughness_texel(data, model, point), lobe);
    const Specular specular(data, model, point);
    if (model.glossiness) lobe.base *= specular.not_reflected();
    lobe.f90 = specular.weight;
    lobe.f0 = specular.f0(data, model.f0);
    lobe.transmission = unit(scaled(data, model.transmission, model.transmission_texture, point, red));
    if (model.layers) {
        evaluate_base_layers(data, *model.layers, point, lobe);
        set_anisotropy(data, *model.layers, point, lobe);
    }
    lobe.alpha_x = widened_alpha(lobe.alpha_x, point.slope_variance.x);
    lobe.alpha_y = widened_alpha(lobe.alpha_y, point.slope_variance.y);

    // Where a texture forbids refraction, light that entered the body elsewhere may still leave diffusely.
    const bool passes_diffusely = model.transmission > 0.0f && lobe.diffuse_transmission > 0.0f;
    const bool refracts = model.refracts && lobe.metallic < 1.0f && (lobe.transmission > 0.0f || passes_diffusely);
    DielectricBody body;
    if (refracts)
        body = make_body(lobe, relative_ior > 0.0f ? relative_ior : model.ior, specular.on_interface(data, lobe.film));
    if (model.layers) {
        const Sheen sheen = evaluate_sheen(data, *model.layers, point);
        const ClearCoat coat = evaluate_clear_coat(data, *model.layers, point, from_back && !refracts);
        if (sheen.exists() || coat.exists())
            return refracts
                       ? LayeredSurface::make(body, sheen, coat)
                       : LayeredSurface::make(lobe, sheen, coat, in_frame(point, point.geometric_normal, from_back));
    }
    if (refracts) return from_body(body);
    return lobe;
}

}  // namespace etendue
