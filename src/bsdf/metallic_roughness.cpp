#include "bsdf/metallic_roughness.h"

#include "bsdf/fresnel.h"
#include "bsdf/ggx_reflection.h"
#include "sampling/warp.h"

#include <algorithm>

namespace etendue {

namespace {

/// Everything that depends on the parameters and wo but not on wi.
struct Layers {
    GgxReflection reflection;
    bool smooth;
    Rgb f0;     ///< of the mixed specular layer
    float f90;  ///< of it
    Rgb multiple_fresnel;
    float coupling;          ///< (1 - E_d(o)) of the dielectric's specular layer
    float coupling_average;  ///< 1 - E_d averaged
    Rgb diffuse;             ///< albedo under the layer
    Rgb transmitted;
    float f0_dielectric;  ///< of the most reflective channel, which decides what goes through
    float f90_dielectric;
    float dielectric_multiple;  ///< the multiple-scattering factor of that channel
    float p_specular, p_diffuse, p_transmitted;

    Layers(const MetallicRoughness& m, float cos_o)
        : reflection(std::max(m.alpha, kSmoothAlpha), cos_o),
          smooth(m.alpha < kSmoothAlpha),
          f0(lerp(m.f0, m.base, m.metallic)),
          f90(m.f90 + (1.0f - m.f90) * m.metallic),
          f0_dielectric(max_component(m.f0)),
          f90_dielectric(m.f90) {
        const Rgb dielectric = reflection.multiple_fresnel(fresnel_schlick_average(m.f0, m.f90));
        dielectric_multiple = max_component(dielectric);
        // Schlick's term is linear in f0 and may be mixed before it is evaluated; the series of multiple scattering is
        // not.
        const Rgb metal_multiple = reflection.multiple_fresnel(fresnel_schlick_average(m.base));
        multiple_fresnel = lerp(dielectric, metal_multiple, m.metallic);
        coupling = smooth ? 1.0f - layer_fresnel(cos_o) : 1.0f - layer_albedo(reflection.albedo_o);
        coupling_average = 1.0f - layer_albedo(reflection.albedo_average);
        const float under = 1.0f - m.metallic;
        diffuse = m.base * (under * (1.0f - m.transmission));
        transmitted = m.base * (under * m.transmission);

        const Rgb specular_albedo = f0 * reflection.albedo_o.single + (Rgb(f90) - f0) * reflection.albedo_o.schlick +
                                    multiple_fresnel * (1.0f - reflection.albedo_o.single);
        const float specular = max_component(specular_albedo);
        const float diffuse_weight = max_component(diffuse) * coupling;
        const float transmitted_weight = max_component(transmitted) * coupling;
        const float total = specular + diffuse_weight + transmitted_weight;
        p_specular = total > 0.0f ? specular / total : 1.0f;
        p_diffuse = total > 0.0f ? diffuse_weight / total : 0.0f;
        p_transmitted = total > 0.0f ? transmitted_weight / total : 0.0f;
    }

    /// Of the dielectric's layer at one facet.
    [[nodiscard]] float layer_fresnel(float cosine) const {
        return fresnel_schlick(Rgb(f0_dielectric), cosine, f90_dielectric).r;
    }

    /// Albedo of the dielectric's specular layer, multiple scattering included.
    [[nodiscard]] float layer_albedo(const GgxAlbedo& a) const {
        return f0_dielectric * a.single + (f90_dielectric - f0_dielectric) * a.schlick +
               dielectric_multiple * (1.0f - a.single);
    }

    [[nodiscard]] float coupling_i(const GgxAlbedo& albedo_i, float cos_i) const {
        return smooth ? 1.0f - layer_fresnel(cos_i) : 1.0f - layer_albedo(albedo_i);
    }
};

BsdfValue evaluate_above(const Layers& layers, const Vec3f& wo, const Vec3f& wi) {
    const GgxReflection::Value specular = layers.reflection.evaluate(wo, wi);
    const float cosine_pdf = cosine_hemisphere_pdf_solid_angle(wi);
    // A smooth layer over a diffuse base: its average is Schlick's own.
    const float average = layers.smooth
                              ? 1.0f - fresnel_schlick_average(Rgb(layers.f0_dielectric), layers.f90_dielectric).r
                              : layers.coupling_average;
    const float coupling =
        average > 0.0f ? layers.coupling * layers.coupling_i(specular.albedo_i, wi.z) / average : 0.0f;
    BsdfValue value{layers.diffuse * (coupling * cosine_pdf), layers.p_diffuse * cosine_pdf};
    if (layers.smooth) return value;
    value.f_cos += fresnel_schlick(layers.f0, specular.cos_half, layers.f90) * specular.single +
                   layers.multiple_fresnel * specular.multiple;
    value.pdf_solid_angle += layers.p_specular * specular.pdf_solid_angle;
    return value;
}

BsdfValue evaluate_below(const Layers& layers, const Vec3f& wo, const Vec3f& wi) {
    if (layers.smooth || layers.p_transmitted == 0.0f) return {};
    const Vec3f mirrored{wi.x, wi.y, -wi.z};
    const GgxReflection::Value lobe = layers.reflection.evaluate(wo, mirrored);
    // What the facets do not reflect; with the reflected part it adds up to all of GGX's lobe.
    const float single = (1.0f - layers.layer_fresnel(lobe.cos_half)) * lobe.single;
    const float multiple = (1.0f - layers.dielectric_multiple) * lobe.multiple;
    return {layers.transmitted * (single + multiple), layers.p_transmitted * lobe.pdf_solid_angle};
}

BsdfSample sample_smooth(const Layers& layers, const Vec3f& wo, bool transmit) {
    if (transmit)
        return {.wi = -wo,
                .weight = layers.transmitted * (layers.coupling / layers.p_transmitted),
                .is_delta = true,
                .is_transmission = true};
    return {.wi = mirror_direction(wo),
            .weight = fresnel_schlick(layers.f0, wo.z, layers.f90) / layers.p_specular,
            .is_delta = true};
}

}  // namespace

bool MetallicRoughness::has_non_delta() const {
    return alpha >= kSmoothAlpha || (metallic < 1.0f && transmission < 1.0f);
}

BsdfValue MetallicRoughness::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode) const {
    if (wo.z <= 0.0f || wi.z == 0.0f) return {};
    const Layers layers(*this, wo.z);
    return wi.z > 0.0f ? evaluate_above(layers, wo, wi) : evaluate_below(layers, wo, wi);
}

BsdfSample MetallicRoughness::sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode) const {
    if (wo.z <= 0.0f) return {};
    const Layers layers(*this, wo.z);
    const bool choose_diffuse = u_lobe < layers.p_diffuse;
    const bool choose_transmitted = !choose_diffuse && u_lobe < layers.p_diffuse + layers.p_transmitted;

    Vec3f wi;
    if (choose_diffuse) {
        wi = square_to_cosine_hemisphere(u);
    } else if (layers.smooth) {
        return sample_smooth(layers, wo, choose_transmitted);
    } else {
        const float first = layers.p_diffuse + (choose_transmitted ? 0.0f : layers.p_transmitted);
        const float share = choose_transmitted ? layers.p_transmitted : layers.p_specular;
        const float u_rest = std::clamp((u_lobe - first) / share, 0.0f, kOneMinusEpsilon);
        wi = layers.reflection.sample(wo, u_rest, u);
        if (wi.z <= 0.0f) return {};
        if (choose_transmitted) wi.z = -wi.z;
    }
    const BsdfValue value = wi.z > 0.0f ? evaluate_above(layers, wo, wi) : evaluate_below(layers, wo, wi);
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    return {.wi = wi,
            .weight = value.f_cos / value.pdf_solid_angle,
            .pdf_solid_angle = value.pdf_solid_angle,
            .is_transmission = choose_transmitted};
}

}  // namespace etendue
