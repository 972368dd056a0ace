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

#include <cmath>

namespace etendue {

/// A template of its lane type, see core/lane.h; of many lanes isotropic only.
template <typename T>
struct BasicGgxReflection {
    using Vec = Imath::Vec3<T>;

    BasicGgx<T> ggx;
    BasicGgxMultiple<T> multiple_directions;
    BasicGgxAlbedo<T> albedo_o;  ///< directional albedos at wo
    BasicGgxAlbedo<T> albedo_average;

    /// Requires wo.z > 0.
    BasicGgxReflection(const BasicGgx<T>& distribution, const Vec& wo)
        : ggx(distribution),
          multiple_directions(mean_alpha(distribution)),
          albedo_o(albedo(wo)),
          albedo_average(average_albedo(distribution)) {}

    /// Directional albedo at `w`, w.z > 0.
    [[nodiscard]] BasicGgxAlbedo<T> albedo(const Vec& w) const {
        if constexpr (kIsSingle<T>) {
            if (!ggx.is_isotropic()) return ggx_anisotropic_albedo(w, ggx.alpha_x, ggx.alpha_y);
        }
        return ggx_albedo(w.z, ggx.alpha_x);
    }

    /// Share of the samples that go to the multiple-scattering lobe.
    [[nodiscard]] T multiple_probability() const { return clamp(1.0f - albedo_o.single, T(0.0f), T(1.0f)); }

    struct Value {
        T single{0.0f};    ///< D G2 / (4 mu_o): times cos_i, without Fresnel
        T multiple{0.0f};  ///< times cos_i, without the metal's factor
        T cos_half{0.0f};  ///< dot(wi, h), the Fresnel term's argument
        T pdf_solid_angle{0.0f};
        BasicGgxAlbedo<T> albedo_i{};
    };
    /// Requires wo.z > 0 and wi.z > 0.
    [[nodiscard]] Value evaluate(const Vec& wo, const Vec& wi) const {
        Value value;
        const Vec h = normalize(wo + wi);
        value.cos_half = min(T(1.0f), dot(wi, h));
        const T d = ggx.d(h);
        value.single = d * ggx.g2(wo, wi) / (4.0f * wo.z);
        value.albedo_i = albedo(wi);
        const T missing_average = 1.0f - albedo_average.single;
        const T missing = (1.0f - albedo_o.single) * (1.0f - value.albedo_i.single) * wi.z * kInvPi;
        value.multiple = select(missing_average > T(0.0f), missing / missing_average, T(0.0f));
        value.pdf_solid_angle = pdf_solid_angle(wo, wi, d);
        return value;
    }

    /// Density of `sample`, 1/sr, where `d` is that of the facets that reflect wo to wi.
    [[nodiscard]] T pdf_solid_angle(const Vec& wo, const Vec& wi, T d) const {
        const T p_multiple = multiple_probability();
        return (1.0f - p_multiple) * ggx.g1(wo) * d / (4.0f * wo.z) +
               p_multiple * multiple_directions.pdf_solid_angle(wi.z);
    }

    /// A direction with the density that `evaluate` states; wi.z <= 0 means that it went below the surface.
    [[nodiscard]] Vec sample(const Vec& wo, T u_lobe, const Imath::Vec2<T>& u) const {
        return choose(
            u_lobe < multiple_probability(), [&] { return multiple_directions.sample(u); },
            [&] {
                const Vec h = ggx.sample_visible_normal(wo, u);
                return h * (2.0f * dot(wo, h)) - wo;
            });
    }

    /// Colour of light that scattered more than once on a metal whose mean reflectance is `fresnel_average` (Kulla and
    /// Conty, slide 28): the geometric series of Fresnel losses.
    [[nodiscard]] BasicRgb<T> multiple_fresnel(const BasicRgb<T>& fresnel_average) const {
        const T e = albedo_average.single;
        const auto channel = [e](T f) { return f * f * e / (1.0f - f * (1.0f - e)); };
        return {channel(fresnel_average.r), channel(fresnel_average.g), channel(fresnel_average.b)};
    }

  private:
    static T mean_alpha(const BasicGgx<T>& ggx) {
        if constexpr (kIsSingle<T>) {
            if (!ggx.is_isotropic()) return std::sqrt(ggx.alpha_x * ggx.alpha_y);
        }
        return ggx.alpha_x;
    }
    static BasicGgxAlbedo<T> average_albedo(const BasicGgx<T>& ggx) {
        if constexpr (kIsSingle<T>) {
            if (!ggx.is_isotropic()) return ggx_anisotropic_albedo_average(ggx.alpha_x, ggx.alpha_y);
        }
        return ggx_albedo_average(ggx.alpha_x);
    }
};
using GgxReflection = BasicGgxReflection<float>;

}  // namespace etendue
