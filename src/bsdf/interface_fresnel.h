// What a smooth patch of a dielectric interface reflects and what it lets through.
//
// Fresnel's equations, scaled and tinted as KHR_materials_specular wants it, and with the thin film of
// KHR_materials_iridescence on the outside. What is transmitted is what the most reflective channel leaves.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/thin_film.h"

#include <algorithm>
#include <cmath>

namespace etendue {

struct InterfaceFresnel {
    Rgb scale{1.0f};  ///< of the reflectance, >= 0
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
        Rgb reflected = Rgb(bare) * scale;
        if (film.exists() && bare < 1.0f)
            reflected = lerp(reflected, film_reflectance(cos_o, eta, outside), film.strength);
        if (bare >= 1.0f) reflected = Rgb(1.0f);
        reflected = {std::min(1.0f, reflected.r), std::min(1.0f, reflected.g), std::min(1.0f, reflected.b)};
        const float transmitted = 1.0f - max_component(reflected);
        const float chance = etendue::average(reflected);
        return {reflected, transmitted, chance + transmitted > 0.0f ? chance / (chance + transmitted) : 1.0f};
    }

    /// True if it is that of the indices alone.
    [[nodiscard]] bool is_bare() const { return !film.exists() && scale == Rgb(1.0f); }

  private:
    /// The film's reflectance is the same from both sides, at the two angles of one ray.
    [[nodiscard]] Rgb film_reflectance(float cos_o, float eta, bool outside) const {
        const float ior = outside ? eta : 1.0f / eta;
        const float root = (ior - 1.0f) / (ior + 1.0f);
        const float cos_outside =
            outside ? cos_o : std::sqrt(std::max(0.0f, 1.0f - (1.0f - cos_o * cos_o) / (eta * eta)));
        return film.reflectance(Rgb(root * root), cos_outside) * scale;
    }
};

}  // namespace etendue
