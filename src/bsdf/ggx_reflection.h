// Reflection from a GGX surface without its Fresnel term: the part that conductors and glTF's specular layer share.
//
// Single scattering D G2 / (4 mu_o mu_i), plus the lobe of light that scattered several times,
// (1 - E(o)) (1 - E(i)) / (pi (1 - E_avg)), after Kulla and Conty (SIGGRAPH 2017 course, slide 17).
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/ggx.h"
#include "bsdf/ggx_albedo.h"
#include "bsdf/ggx_anisotropic_albedo.h"
#include "bsdf/ggx_multiple.h"

#include <algorithm>
#include <cmath>

namespace etendue {

struct GgxReflection {
    Ggx ggx;
    GgxMultiple multiple_directions;
    GgxAlbedo albedo_o;  ///< directional albedos at wo
    GgxAlbedo albedo_average;

    /// Requires wo.z > 0.
    GgxReflection(const Ggx& distribution, const Vec3f& wo)
        : ggx(distribution),
          multiple_directions(distribution.is_isotropic() ? distribution.alpha_x
                                                          : std::sqrt(distribution.alpha_x * distribution.alpha_y)),
          albedo_o(albedo(wo)),
          albedo_average(distribution.is_isotropic()
                             ? ggx_albedo_average(distribution.alpha_x)
                             : ggx_anisotropic_albedo_average(distribution.alpha_x, distribution.alpha_y)) {}

    /// Directional albedo at `w`, w.z > 0.
    [[nodiscard]] GgxAlbedo albedo(const Vec3f& w) const {
        return ggx.is_isotropic() ? ggx_albedo(w.z, ggx.alpha_x) : ggx_anisotropic_albedo(w, ggx.alpha_x, ggx.alpha_y);
    }

    /// Share of the samples that go to the multiple-scattering lobe.
    [[nodiscard]] float multiple_probability() const { return std::clamp(1.0f - albedo_o.single, 0.0f, 1.0f); }

    struct Value {
        float single = 0.0f;    ///< D G2 / (4 mu_o): times cos_i, without Fresnel
        float multiple = 0.0f;  ///< times cos_i, without the metal's factor
        float cos_half = 0.0f;  ///< dot(wi, h), the Fresnel term's argument
        float pdf_solid_angle = 0.0f;
        GgxAlbedo albedo_i{};
    };
    /// Requires wo.z > 0 and wi.z > 0.
    [[nodiscard]] Value evaluate(const Vec3f& wo, const Vec3f& wi) const {
        Value value;
        const Vec3f h = normalize(wo + wi);
        value.cos_half = std::min(1.0f, dot(wi, h));
        const float d = ggx.d(h);
        value.single = d * ggx.g2(wo, wi) / (4.0f * wo.z);
        value.albedo_i = albedo(wi);
        const float missing_average = 1.0f - albedo_average.single;
        if (missing_average > 0.0f)
            value.multiple =
                (1.0f - albedo_o.single) * (1.0f - value.albedo_i.single) * wi.z * kInvPi / missing_average;
        value.pdf_solid_angle = pdf_solid_angle(wo, wi, d);
        return value;
    }

    /// Density of `sample`, 1/sr, where `d` is that of the facets that reflect wo to wi.
    [[nodiscard]] float pdf_solid_angle(const Vec3f& wo, const Vec3f& wi, float d) const {
        const float p_multiple = multiple_probability();
        return (1.0f - p_multiple) * ggx.g1(wo) * d / (4.0f * wo.z) +
               p_multiple * multiple_directions.pdf_solid_angle(wi.z);
    }

    /// A direction with the density that `evaluate` states; wi.z <= 0 means that it went below the surface.
    [[nodiscard]] Vec3f sample(const Vec3f& wo, float u_lobe, Vec2f u) const {
        if (u_lobe < multiple_probability()) return multiple_directions.sample(u);
        const Vec3f h = ggx.sample_visible_normal(wo, u);
        return h * (2.0f * dot(wo, h)) - wo;
    }

    /// Colour of light that scattered more than once on a metal whose mean reflectance is `fresnel_average` (Kulla and
    /// Conty, slide 28): the geometric series of Fresnel losses.
    [[nodiscard]] Rgb multiple_fresnel(const Rgb& fresnel_average) const {
        const float e = albedo_average.single;
        const auto channel = [e](float f) { return f * f * e / (1.0f - f * (1.0f - e)); };
        return {channel(fresnel_average.r), channel(fresnel_average.g), channel(fresnel_average.b)};
    }
};

}  // namespace etendue
