// What a smooth patch of a dielectric interface reflects and what it lets through.
//
// Fresnel's equations with the changes of KHR_materials_specular: its colour tints the reflectance at normal incidence,
// its factor scales all of it; in between goes the curve of the indices, where Schlick's stands in the specification.
// The thin film of KHR_materials_iridescence lies on the outside. What is transmitted is what the most reflective
// channel leaves.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/thin_film.h"

#include <algorithm>
#include <cmath>

namespace etendue {

struct InterfaceFresnel {
    Rgb tint{1.0f};       ///< factor of the reflectance at normal incidence, >= 0
    float weight = 1.0f;  ///< factor of the reflectance, [0, 1]
    ThinFilm film{};

    struct Split {
        Rgb reflected;           ///< [0, 1]
        float transmitted;       ///< 1 - the largest channel of `reflected`
        float reflection_share;  ///< probability with which to reflect
    };
    /// `cos_o` in [0, 1] on the side that light is seen from, `eta` the index on the other side over the one on that.
    [[nodiscard]] Split operator()(float cos_o, float eta, bool outside) const {
        const float bare = fresnel_dielectric(cos_o, eta);
        if (is_bare()) return {Rgb(bare), 1.0f - bare, bare};
        const float bare_normal = normal_reflectance(eta);
        const float rise = std::clamp((bare - bare_normal) / (1.0f - bare_normal), 0.0f, 1.0f);
        Rgb reflected = lerp(at_normal_incidence(eta), Rgb(weight), rise);
        if (film.exists() && bare < 1.0f)
            reflected = lerp(reflected, film_reflectance(cos_o, eta, outside) * weight, film.strength);
        if (bare >= 1.0f) reflected = Rgb(1.0f);
        const float transmitted = 1.0f - max_component(reflected);
        const float chance = etendue::average(reflected);
        return {reflected, transmitted, chance + transmitted > 0.0f ? chance / (chance + transmitted) : 1.0f};
    }

    /// Describes the reflectance of the brightest channel, without the film and where reflection is not total: `bare`
    /// times the Fresnel reflectance of the two indices plus `all`.
    struct Mixture {
        float bare = 1.0f;
        float all = 0.0f;

        /// Returns a figure that is linear in the reflectance, from its values for the reflectance of the indices, for
        /// a reflectance of 1, and for a reflectance of 0 where reflection is not total.
        [[nodiscard]] float blend(float of_bare, float of_all, float of_none) const {
            return bare * of_bare + all * of_all + (1.0f - bare - all) * of_none;
        }
    };
    [[nodiscard]] Mixture mixture(float eta) const {
        const float bare_normal = normal_reflectance(eta);
        const float normal = max_component(at_normal_incidence(eta));
        const float bare = (weight - normal) / (1.0f - bare_normal);
        return {bare, normal - bare * bare_normal};
    }

    /// True if the reflectance is that of the indices alone.
    [[nodiscard]] bool is_bare() const { return !film.exists() && weight == 1.0f && tint == Rgb(1.0f); }

  private:
    /// Returns the reflectance at normal incidence, which is the same from both sides.
    [[nodiscard]] static float normal_reflectance(float eta) {
        const float root = (eta - 1.0f) / (eta + 1.0f);
        return root * root;
    }
    [[nodiscard]] Rgb at_normal_incidence(float eta) const {
        return clamp_unit(tint * normal_reflectance(eta)) * weight;
    }

    /// The film's reflectance is the same from both sides, at the two angles of one ray.
    [[nodiscard]] Rgb film_reflectance(float cos_o, float eta, bool outside) const {
        const float cos_outside =
            outside ? cos_o : std::sqrt(std::max(0.0f, 1.0f - (1.0f - cos_o * cos_o) / (eta * eta)));
        return film.reflectance(at_normal_incidence(eta), cos_outside);
    }
};

}  // namespace etendue
