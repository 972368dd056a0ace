#include "bsdf/metallic_roughness.h"

#include "bsdf/metallic_roughness_layers.h"
#include "bsdf/rough_diffuse.h"
#include "sampling/warp.h"

#include <algorithm>

namespace etendue {

namespace {

bool is_smooth(const MetallicRoughness& m) {
    return std::max(m.alpha_x, m.alpha_y) < kSmoothAlpha;
}

using UncoatedLayers = MetallicRoughnessLayers<float>;

UncoatedLayers layers_of(const MetallicRoughness& m, const Vec3f& wo) {
    const float under = 1.0f - m.metallic;
    const float stays = under * (1.0f - m.transmission);
    return {{std::max(m.alpha_x, kSmoothAlpha), std::max(m.alpha_y, kSmoothAlpha)},
            is_smooth(m),
            {m.f0, m.f90, m.film},
            {m.base, 1.0f, m.film},
            m.metallic,
            {m.base * (stays * (1.0f - m.diffuse_transmission)),
             m.diffuse_transmission_color * (stays * m.diffuse_transmission), m.base * (under * m.transmission)},
            wo};
}

BsdfParts evaluate_below(const MetallicRoughness& m, const UncoatedLayers& layers, const Vec3f& wo, const Vec3f& wi) {
    const Vec3f mirrored{wi.x, wi.y, -wi.z};
    BsdfParts value;
    if (layers.p_diffuse_transmitted > 0.0f) {
        const float cosine_pdf = cosine_hemisphere_pdf_solid_angle(mirrored);
        const GgxAlbedo albedo_i = layers.reflection.albedo(mirrored);
        value.diffuse = layers.below.diffuse_transmitted * (layers.coupling_with(albedo_i, mirrored.z) * cosine_pdf);
        if (m.diffuse_roughness > 0.0f)
            value.diffuse *= rough_over_lambertian(m.diffuse_transmission_color, m.diffuse_roughness, wo, mirrored);
        value.pdf_solid_angle = layers.p_diffuse_transmitted * cosine_pdf;
    }
    if (layers.smooth || layers.p_transmitted == 0.0f) return value;
    const GgxReflection::Value lobe = layers.reflection.evaluate(wo, mirrored);
    // What the facets do not reflect; with the reflected part it adds up to all of GGX's lobe.
    const float single = (1.0f - layers.layer_fresnel(lobe.cos_half)) * lobe.single;
    const float multiple = (1.0f - layers.dielectric_multiple) * lobe.multiple;
    value.specular = layers.below.transmitted * (single + multiple);
    value.pdf_solid_angle += layers.p_transmitted * lobe.pdf_solid_angle;
    return value;
}

float pdf_of_layers(const UncoatedLayers& layers, const Vec3f& wo, const Vec3f& wi) {
    const bool above = wi.z > 0.0f;
    const Vec3f w{wi.x, wi.y, std::abs(wi.z)};
    const float pdf = (above ? layers.p_diffuse : layers.p_diffuse_transmitted) * cosine_hemisphere_pdf_solid_angle(w);
    const float p_around = above ? layers.p_specular : layers.p_transmitted;
    if (layers.smooth || p_around == 0.0f) return pdf;
    return pdf + p_around * layers.reflection.pdf_solid_angle(wo, w, layers.reflection.ggx.d(normalize(wo + w)));
}

BsdfSample sample_smooth(const UncoatedLayers& layers, const Vec3f& wo, bool transmit) {
    if (transmit)
        return {.wi = -wo,
                .weight = layers.below.transmitted * (layers.coupling / layers.p_transmitted),
                .is_delta = true,
                .is_transmission = true};
    return {.wi = mirror_direction(wo), .weight = layers.fresnel(wo.z) / layers.p_specular, .is_delta = true};
}

BsdfParts evaluate_layers(const MetallicRoughness& m, const UncoatedLayers& layers, const Vec3f& wo, const Vec3f& wi) {
    if (wi.z < 0.0f) return evaluate_below(m, layers, wo, wi);
    BsdfParts value = layers.evaluate_above(wo, wi);
    if (m.diffuse_roughness > 0.0f) value.diffuse *= rough_over_lambertian(m.base, m.diffuse_roughness, wo, wi);
    return value;
}

}  // namespace

bool MetallicRoughness::has_non_delta() const {
    return !is_smooth(*this) || (metallic < 1.0f && transmission < 1.0f);
}

BsdfParts MetallicRoughness::evaluate_parts(const Vec3f& wo, const Vec3f& wi) const {
    if (wo.z <= 0.0f || wi.z == 0.0f) return {};
    return evaluate_layers(*this, layers_of(*this, wo), wo, wi);
}

float MetallicRoughness::pdf_solid_angle(const Vec3f& wo, const Vec3f& wi) const {
    if (wo.z <= 0.0f || wi.z == 0.0f) return 0.0f;
    return pdf_of_layers(layers_of(*this, wo), wo, wi);
}

float MetallicRoughness::passed_by_specular(float cos_theta) const {
    const float sine = std::sqrt(0.5f * std::max(0.0f, 1.0f - cos_theta * cos_theta));
    return layers_of(*this, {sine, sine, cos_theta}).coupling;
}

BsdfValue MetallicRoughness::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode) const {
    return evaluate_parts(wo, wi).sum();
}

BsdfSample MetallicRoughness::sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode) const {
    if (wo.z <= 0.0f) return {};
    const UncoatedLayers layers = layers_of(*this, wo);
    const float end_diffuse = layers.p_diffuse;
    const float end_diffuse_below = end_diffuse + layers.p_diffuse_transmitted;
    const float end_transmitted = end_diffuse_below + layers.p_transmitted;

    Vec3f wi;
    if (u_lobe < end_diffuse_below) {
        wi = square_to_cosine_hemisphere(u);
        if (u_lobe >= end_diffuse) wi.z = -wi.z;
    } else {
        const bool transmit = u_lobe < end_transmitted;
        // Rounding of the sums may select reflection although its probability is zero.
        if (!transmit && layers.p_specular == 0.0f) return {};
        if (layers.smooth) return sample_smooth(layers, wo, transmit);
        const float first = transmit ? end_diffuse_below : end_transmitted;
        const float share = transmit ? layers.p_transmitted : layers.p_specular;
        wi = layers.sample_around(wo, u_lobe, first, share, u);
        if (wi.z <= 0.0f) return {};
        if (transmit) wi.z = -wi.z;
    }
    if (wi.z == 0.0f) return {};
    const BsdfValue value = evaluate_layers(*this, layers, wo, wi).sum();
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    return {.wi = wi,
            .weight = value.f_cos / value.pdf_solid_angle,
            .pdf_solid_angle = value.pdf_solid_angle,
            .is_transmission = wi.z < 0.0f};
}

void MetallicRoughness::add_deltas(const Vec3f& wo, DeltaList& deltas) const {
    if (wo.z <= 0.0f || !is_smooth(*this)) return;
    const UncoatedLayers layers = layers_of(*this, wo);
    deltas.add({.wi = mirror_direction(wo), .weight = layers.fresnel(wo.z), .is_delta = true});
    deltas.add(
        {.wi = -wo, .weight = layers.below.transmitted * layers.coupling, .is_delta = true, .is_transmission = true});
}

}  // namespace etendue
