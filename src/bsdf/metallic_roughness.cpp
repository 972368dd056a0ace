#include "bsdf/metallic_roughness.h"

#include "bsdf/cosine_average.h"
#include "bsdf/facet_fresnel.h"
#include "bsdf/ggx_reflection.h"
#include "sampling/warp.h"

#include <algorithm>

namespace etendue {

namespace {

bool is_smooth(const MetallicRoughness& m) {
    return std::max(m.alpha_x, m.alpha_y) < kSmoothAlpha;
}

/// Everything that depends on the parameters and wo but not on wi.
struct Layers {
    GgxReflection reflection;
    bool smooth;
    FacetFresnel dielectric;
    FacetFresnel metal;
    FacetFresnel mixed;  ///< of the two, without film
    float metallic;
    Rgb multiple_fresnel;
    float coupling;             ///< (1 - E_d(o)) of the dielectric's specular layer
    float coupling_average;     ///< 1 - E_d averaged
    Rgb diffuse;                ///< albedo under the layer
    Rgb diffuse_below;          ///< what of it leaves on the other side
    Rgb transmitted;            ///< through the sheet, mirrored
    float dielectric_multiple;  ///< multiple-scattering factor of the dielectric's most reflective channel
    float p_specular, p_diffuse, p_diffuse_below, p_transmitted;

    Layers(const MetallicRoughness& m, const Vec3f& wo)
        : reflection({std::max(m.alpha_x, kSmoothAlpha), std::max(m.alpha_y, kSmoothAlpha)}, wo),
          smooth(is_smooth(m)),
          dielectric{m.f0, m.f90, m.film},
          metal{m.base, 1.0f, m.film},
          // Schlick's term is linear in f0 and may be mixed before it is evaluated; films and the series of multiple
          // scattering are not.
          mixed{lerp(m.f0, m.base, m.metallic), m.f90 + (1.0f - m.f90) * m.metallic, {}},
          metallic(m.metallic) {
        // Of a pure material the other half is not asked for: under a film each average is several evaluations.
        const Rgb dielectric_series = metallic < 1.0f ? reflection.multiple_fresnel(dielectric.average()) : Rgb();
        const Rgb metal_series = metallic > 0.0f ? reflection.multiple_fresnel(metal.average()) : Rgb();
        dielectric_multiple = max_component(dielectric_series);
        multiple_fresnel = lerp(dielectric_series, metal_series, metallic);
        coupling = metallic < 1.0f ? passed(reflection.albedo_o, wo.z) : 0.0f;
        coupling_average = metallic < 1.0f ? average_passed() : 0.0f;
        const float under = 1.0f - metallic;
        const float stays = under * (1.0f - m.transmission);
        diffuse = m.base * (stays * (1.0f - m.diffuse_transmission));
        diffuse_below = m.diffuse_transmission_color * (stays * m.diffuse_transmission);
        transmitted = m.base * (under * m.transmission);
        choose_probabilities();
    }

    /// Of both materials together.
    [[nodiscard]] Rgb fresnel(float cosine) const {
        if (!dielectric.film.exists()) return mixed(cosine);
        return lerp(dielectric(cosine), metal(cosine), metallic);
    }

    /// Of the dielectric's layer at one facet.
    [[nodiscard]] float layer_fresnel(float cosine) const { return max_component(dielectric(cosine)); }

    /// Share of light with cosine `cosine` that the dielectric's specular layer lets through.
    [[nodiscard]] float passed(const GgxAlbedo& albedo, float cosine) const {
        return smooth ? 1.0f - layer_fresnel(cosine) : std::max(0.0f, 1.0f - layer_albedo(albedo));
    }

  private:
    /// Albedo of the dielectric's specular layer, multiple scattering included.
    [[nodiscard]] float layer_albedo(const GgxAlbedo& a) const {
        return max_component(dielectric.albedo(a)) + dielectric_multiple * (1.0f - a.single);
    }

    [[nodiscard]] float average_passed() const {
        if (dielectric.film.exists())
            return cosine_average([&](float mu) {
                const float sine = std::sqrt(0.5f * (1.0f - mu * mu));
                return passed(reflection.albedo({sine, sine, mu}), mu);
            });
        return 1.0f - (smooth ? max_component(dielectric.average()) : layer_albedo(reflection.albedo_average));
    }

    void choose_probabilities() {
        const GgxAlbedo& a = reflection.albedo_o;
        const Rgb single =
            dielectric.film.exists() ? lerp(dielectric.albedo(a), metal.albedo(a), metallic) : mixed.albedo(a);
        const float specular = max_component(single + multiple_fresnel * (1.0f - a.single));
        const float diffuse_weight = max_component(diffuse) * coupling;
        const float below_weight = max_component(diffuse_below) * coupling;
        const float transmitted_weight = max_component(transmitted) * coupling;
        const float total = specular + diffuse_weight + below_weight + transmitted_weight;
        p_specular = total > 0.0f ? specular / total : 1.0f;
        p_diffuse = total > 0.0f ? diffuse_weight / total : 0.0f;
        p_diffuse_below = total > 0.0f ? below_weight / total : 0.0f;
        p_transmitted = total > 0.0f ? transmitted_weight / total : 0.0f;
    }
};

/// Coupling of light that passes the layer at both ends, over its average.
float coupling(const Layers& layers, const GgxAlbedo& albedo_i, float cos_i) {
    if (!(layers.coupling_average > 0.0f)) return 0.0f;
    return layers.coupling * layers.passed(albedo_i, cos_i) / layers.coupling_average;
}

MetallicRoughness::Value evaluate_above(const Layers& layers, const Vec3f& wo, const Vec3f& wi) {
    const GgxReflection::Value specular = layers.reflection.evaluate(wo, wi);
    const float cosine_pdf = cosine_hemisphere_pdf_solid_angle(wi);
    MetallicRoughness::Value value{
        layers.diffuse * (coupling(layers, specular.albedo_i, wi.z) * cosine_pdf), {}, layers.p_diffuse * cosine_pdf};
    if (layers.smooth) return value;
    value.specular = layers.fresnel(specular.cos_half) * specular.single + layers.multiple_fresnel * specular.multiple;
    value.pdf_solid_angle += layers.p_specular * specular.pdf_solid_angle;
    return value;
}

MetallicRoughness::Value evaluate_below(const Layers& layers, const Vec3f& wo, const Vec3f& wi) {
    const Vec3f mirrored{wi.x, wi.y, -wi.z};
    MetallicRoughness::Value value;
    if (layers.p_diffuse_below > 0.0f) {
        const float cosine_pdf = cosine_hemisphere_pdf_solid_angle(mirrored);
        const GgxAlbedo albedo_i = layers.reflection.albedo(mirrored);
        value.diffuse = layers.diffuse_below * (coupling(layers, albedo_i, mirrored.z) * cosine_pdf);
        value.pdf_solid_angle = layers.p_diffuse_below * cosine_pdf;
    }
    if (layers.smooth || layers.p_transmitted == 0.0f) return value;
    const GgxReflection::Value lobe = layers.reflection.evaluate(wo, mirrored);
    // What the facets do not reflect; with the reflected part it adds up to all of GGX's lobe.
    const float single = (1.0f - layers.layer_fresnel(lobe.cos_half)) * lobe.single;
    const float multiple = (1.0f - layers.dielectric_multiple) * lobe.multiple;
    value.specular = layers.transmitted * (single + multiple);
    value.pdf_solid_angle += layers.p_transmitted * lobe.pdf_solid_angle;
    return value;
}

float pdf_of_layers(const Layers& layers, const Vec3f& wo, const Vec3f& wi) {
    const bool above = wi.z > 0.0f;
    const Vec3f w{wi.x, wi.y, std::abs(wi.z)};
    const float pdf = (above ? layers.p_diffuse : layers.p_diffuse_below) * cosine_hemisphere_pdf_solid_angle(w);
    const float p_around = above ? layers.p_specular : layers.p_transmitted;
    if (layers.smooth || p_around == 0.0f) return pdf;
    return pdf + p_around * layers.reflection.pdf_solid_angle(wo, w, layers.reflection.ggx.d(normalize(wo + w)));
}

BsdfSample sample_smooth(const Layers& layers, const Vec3f& wo, bool transmit) {
    if (transmit)
        return {.wi = -wo,
                .weight = layers.transmitted * (layers.coupling / layers.p_transmitted),
                .is_delta = true,
                .is_transmission = true};
    return {.wi = mirror_direction(wo), .weight = layers.fresnel(wo.z) / layers.p_specular, .is_delta = true};
}

MetallicRoughness::Value evaluate_layers(const Layers& layers, const Vec3f& wo, const Vec3f& wi) {
    return wi.z > 0.0f ? evaluate_above(layers, wo, wi) : evaluate_below(layers, wo, wi);
}

}  // namespace

bool MetallicRoughness::has_non_delta() const {
    return !is_smooth(*this) || (metallic < 1.0f && transmission < 1.0f);
}

MetallicRoughness::Value MetallicRoughness::evaluate_parts(const Vec3f& wo, const Vec3f& wi) const {
    if (wo.z <= 0.0f || wi.z == 0.0f) return {};
    return evaluate_layers(Layers(*this, wo), wo, wi);
}

float MetallicRoughness::pdf_solid_angle(const Vec3f& wo, const Vec3f& wi) const {
    if (wo.z <= 0.0f || wi.z == 0.0f) return 0.0f;
    return pdf_of_layers(Layers(*this, wo), wo, wi);
}

float MetallicRoughness::passed_by_specular(float cos_theta) const {
    const float sine = std::sqrt(0.5f * std::max(0.0f, 1.0f - cos_theta * cos_theta));
    return Layers(*this, {sine, sine, cos_theta}).coupling;
}

BsdfValue MetallicRoughness::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode) const {
    const Value value = evaluate_parts(wo, wi);
    return {value.diffuse + value.specular, value.pdf_solid_angle};
}

BsdfSample MetallicRoughness::sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode) const {
    if (wo.z <= 0.0f) return {};
    const Layers layers(*this, wo);
    const float end_diffuse = layers.p_diffuse;
    const float end_diffuse_below = end_diffuse + layers.p_diffuse_below;
    const float end_transmitted = end_diffuse_below + layers.p_transmitted;

    Vec3f wi;
    if (u_lobe < end_diffuse_below) {
        wi = square_to_cosine_hemisphere(u);
        if (u_lobe >= end_diffuse) wi.z = -wi.z;
    } else {
        const bool transmit = u_lobe < end_transmitted;
        if (layers.smooth) return sample_smooth(layers, wo, transmit);
        const float first = transmit ? end_diffuse_below : end_transmitted;
        const float share = transmit ? layers.p_transmitted : layers.p_specular;
        const float u_rest = std::clamp((u_lobe - first) / share, 0.0f, kOneMinusEpsilon);
        wi = layers.reflection.sample(wo, u_rest, u);
        if (wi.z <= 0.0f) return {};
        if (transmit) wi.z = -wi.z;
    }
    if (wi.z == 0.0f) return {};
    const Value value = evaluate_layers(layers, wo, wi);
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    return {.wi = wi,
            .weight = (value.diffuse + value.specular) / value.pdf_solid_angle,
            .pdf_solid_angle = value.pdf_solid_angle,
            .is_transmission = wi.z < 0.0f};
}

void MetallicRoughness::add_deltas(const Vec3f& wo, DeltaList& deltas) const {
    if (wo.z <= 0.0f || !is_smooth(*this)) return;
    const Layers layers(*this, wo);
    deltas.add({.wi = mirror_direction(wo), .weight = layers.fresnel(wo.z), .is_delta = true});
    deltas.add({.wi = -wo, .weight = layers.transmitted * layers.coupling, .is_delta = true, .is_transmission = true});
}

}  // namespace etendue
