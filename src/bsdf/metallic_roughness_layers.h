// The layers of a metallic-roughness surface (metallic_roughness.h) seen from one direction: everything that depends on
// the material and wo but not on wi, and what follows for wi above the surface.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/cosine_average.h"
#include "bsdf/facet_fresnel.h"
#include "bsdf/ggx_reflection.h"
#include "sampling/warp.h"

#include <cmath>

namespace etendue {

/// A template of its lane type, see core/lane.h; many lanes have neither films nor deltas.
template <typename T>
struct MetallicRoughnessLayers {
    using Color = BasicRgb<T>;
    using Vec = Imath::Vec3<T>;
    using Facets = BasicFacetFresnel<T>;

    /// Holds the albedos of what lies under the specular layer.
    struct Below {
        Color diffuse;
        Color diffuse_transmitted{};  ///< diffuse light that leaves on the other side
        Color transmitted{};          ///< through the sheet, mirrored
    };

    BasicGgxReflection<T> reflection;
    bool smooth;  ///< true of all lanes or of none
    Facets dielectric;
    Facets metal;
    T metallic;
    Below below;
    Facets mixed;  ///< Fresnel term of both materials together, without film
    Color multiple_fresnel;
    T coupling;             ///< (1 - E_d(o)) of the dielectric's specular layer
    T coupling_average;     ///< 1 - E_d averaged
    T dielectric_multiple;  ///< multiple-scattering factor of the dielectric's most reflective channel
    T p_specular, p_diffuse, p_diffuse_transmitted, p_transmitted;

    /// Requires wo.z > 0; other lanes mean nothing, but do no harm.
    MetallicRoughnessLayers(const BasicGgx<T>& ggx, bool is_smooth, const Facets& of_dielectric, const Facets& of_metal,
                            T metal_share, const Below& under, const Vec& wo)
        : reflection(ggx, wo),
          smooth(is_smooth),
          dielectric(of_dielectric),
          metal(of_metal),
          metallic(metal_share),
          below(under),
          // Schlick's term is linear in f0 and may be mixed before it is evaluated; films and the series of multiple
          // scattering are not.
          mixed{lerp(dielectric.f0, metal.f0, metallic), dielectric.f90 + (metal.f90 - dielectric.f90) * metallic, {}} {
        // Of a pure material the other half is not asked for: under a film each average is several evaluations.
        const auto is_dielectric = metallic < T(1.0f);
        const auto series = [this](const Facets& facets) { return reflection.multiple_fresnel(facets.average()); };
        const Color dielectric_series = choose(
            is_dielectric, [&] { return series(dielectric); }, [] { return Color(); });
        const Color metal_series = choose(
            metallic > T(0.0f), [&] { return series(metal); }, [] { return Color(); });
        dielectric_multiple = max_component(dielectric_series);
        multiple_fresnel = lerp(dielectric_series, metal_series, metallic);
        const auto nothing = [] { return T(0.0f); };
        coupling = choose(
            is_dielectric, [&] { return passed(reflection.albedo_o, wo.z); }, nothing);
        coupling_average = choose(
            is_dielectric, [&] { return average_passed(); }, nothing);
        choose_probabilities();
    }

    /// Returns the Fresnel reflectance of both materials together.
    [[nodiscard]] Color fresnel(T cosine) const {
        if (!dielectric.has_film()) return mixed(cosine);
        return lerp(dielectric(cosine), metal(cosine), metallic);
    }

    /// Returns the reflectance of the dielectric's layer at one facet, in its brightest channel.
    [[nodiscard]] T layer_fresnel(T cosine) const { return max_component(dielectric(cosine)); }

    /// Share of light with cosine `cosine` that the dielectric's specular layer lets through.
    [[nodiscard]] T passed(const BasicGgxAlbedo<T>& albedo, T cosine) const {
        if (smooth) return 1.0f - layer_fresnel(cosine);
        return max(T(0.0f), 1.0f - layer_albedo(albedo));
    }

    /// Coupling of light that passes the layer at both ends, over its average.
    [[nodiscard]] T coupling_with(const BasicGgxAlbedo<T>& albedo_i, T cos_i) const {
        return choose(
            coupling_average > T(0.0f), [&] { return coupling * passed(albedo_i, cos_i) / coupling_average; },
            [] { return T(0.0f); });
    }

    /// A direction around that of a mirror, chosen by the part of `u_lobe` that is `share` long from `first` on; wi.z
    /// <= 0 means that it went below the surface.
    [[nodiscard]] Vec sample_around(const Vec& wo, T u_lobe, T first, T share, const Imath::Vec2<T>& u) const {
        return reflection.sample(wo, clamp((u_lobe - first) / share, T(0.0f), T(kOneMinusEpsilon)), u);
    }

    /// Requires wi.z > 0; other lanes mean nothing.
    [[nodiscard]] BasicBsdfParts<T> evaluate_above(const Vec& wo, const Vec& wi) const {
        const auto specular = reflection.evaluate(wo, wi);
        const T cosine_pdf = cosine_hemisphere_pdf_solid_angle(wi);
        BasicBsdfParts<T> value{
            below.diffuse * (coupling_with(specular.albedo_i, wi.z) * cosine_pdf), {}, p_diffuse * cosine_pdf};
        if (smooth) return value;
        value.specular = fresnel(specular.cos_half) * specular.single + multiple_fresnel * specular.multiple;
        value.pdf_solid_angle += p_specular * specular.pdf_solid_angle;
        return value;
    }

  private:
    /// Albedo of the dielectric's specular layer, multiple scattering included.
    [[nodiscard]] T layer_albedo(const BasicGgxAlbedo<T>& a) const {
        return max_component(dielectric.albedo(a)) + dielectric_multiple * (1.0f - a.single);
    }

    [[nodiscard]] T average_passed() const {
        if constexpr (kIsSingle<T>) {
            if (dielectric.has_film())
                return cosine_average([&](float mu) {
                    const float sine = std::sqrt(0.5f * (1.0f - mu * mu));
                    return passed(reflection.albedo({sine, sine, mu}), mu);
                });
        }
        if (smooth) return 1.0f - max_component(dielectric.average());
        return 1.0f - layer_albedo(reflection.albedo_average);
    }

    void choose_probabilities() {
        const BasicGgxAlbedo<T>& a = reflection.albedo_o;
        const Color single =
            dielectric.has_film() ? lerp(dielectric.albedo(a), metal.albedo(a), metallic) : mixed.albedo(a);
        const T specular = max_component(single + multiple_fresnel * (1.0f - a.single));
        const T diffuse_weight = max_component(below.diffuse) * coupling;
        const T below_weight = max_component(below.diffuse_transmitted) * coupling;
        const T transmitted_weight = max_component(below.transmitted) * coupling;
        const T total = specular + diffuse_weight + below_weight + transmitted_weight;
        const auto any = total > T(0.0f);
        p_specular = select(any, specular / total, T(1.0f));
        p_diffuse = select(any, diffuse_weight / total, T(0.0f));
        p_diffuse_transmitted = select(any, below_weight / total, T(0.0f));
        p_transmitted = select(any, transmitted_weight / total, T(0.0f));
    }
};

}  // namespace etendue
