// What a facet of glTF's specular layer reflects, by angle: Schlick's curve, or a thin film over it.
#pragma once

#include "bsdf/cosine_average.h"
#include "bsdf/fresnel.h"
#include "bsdf/ggx_albedo.h"
#include "bsdf/thin_film.h"

#include <algorithm>
#include <cmath>

namespace etendue {

struct FacetFresnel {
    Rgb f0{0.04f};     ///< at normal incidence, [0, f90]
    float f90 = 1.0f;  ///< at grazing incidence, [0, 1]
    ThinFilm film{};

    /// `cos_theta` in [0, 1] to the facet's normal.
    [[nodiscard]] Rgb operator()(float cos_theta) const {
        const Rgb bare = fresnel_schlick(f0, cos_theta, f90);
        if (!film.exists()) return bare;
        // The film's own faces do not know of KHR_materials_specular; its weight scales them too.
        return lerp(bare, film.reflectance(f0, cos_theta) * f90, film.strength);
    }

    /// Mean over a cosine-weighted hemisphere.
    [[nodiscard]] Rgb average() const {
        if (!film.exists()) return fresnel_schlick_average(f0, f90);
        return cosine_average(*this);
    }

    /// Directional albedo of single scattering on GGX facets with this reflectance. Exact within the tables for
    /// Schlick's curve. A film is taken at the one angle whose Schlick term is the facets' mean.
    [[nodiscard]] Rgb albedo(const GgxAlbedo& a) const {
        if (!film.exists()) return f0 * a.single + (Rgb(f90) - f0) * a.schlick;
        const float share = a.single > 0.0f ? a.schlick / a.single : 0.0f;
        return (*this)(1.0f - std::pow(std::max(0.0f, share), 0.2f)) * a.single;
    }
};

}  // namespace etendue
