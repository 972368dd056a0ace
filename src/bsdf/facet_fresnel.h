// What a facet of glTF's specular layer reflects, by angle: Schlick's curve, or a thin film over it.
#pragma once

#include "bsdf/cosine_average.h"
#include "bsdf/fresnel.h"
#include "bsdf/ggx_albedo.h"
#include "bsdf/thin_film.h"

#include <algorithm>
#include <cmath>

namespace etendue {

/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicFacetFresnel {
    using Color = BasicRgb<T>;

    Color f0{T(0.04f)};  ///< at normal incidence, [0, f90]
    T f90{1.0f};         ///< at grazing incidence, [0, 1]
    ThinFilm film{};     ///< only single lanes have one

    [[nodiscard]] bool has_film() const { return kIsSingle<T> && film.exists(); }

    /// `cos_theta` in [0, 1] to the facet's normal.
    [[nodiscard]] Color operator()(T cos_theta) const {
        const Color bare = fresnel_schlick(f0, cos_theta, f90);
        if constexpr (kIsSingle<T>) {
            // The film's own faces do not know of KHR_materials_specular; its weight scales them too.
            if (film.exists()) return lerp(bare, film.reflectance(f0, cos_theta) * f90, film.strength);
        }
        return bare;
    }

    /// Mean over a cosine-weighted hemisphere.
    [[nodiscard]] Color average() const {
        if constexpr (kIsSingle<T>) {
            if (film.exists()) return cosine_average(*this);
        }
        return fresnel_schlick_average(f0, f90);
    }

    /// Directional albedo of single scattering on GGX facets with this reflectance. Exact within the tables for
    /// Schlick's curve. A film is taken at the one angle whose Schlick term is the facets' mean.
    [[nodiscard]] Color albedo(const BasicGgxAlbedo<T>& a) const {
        if constexpr (kIsSingle<T>) {
            if (film.exists()) {
                const float share = a.single > 0.0f ? a.schlick / a.single : 0.0f;
                return (*this)(1.0f - std::pow(std::max(0.0f, share), 0.2f)) * a.single;
            }
        }
        return f0 * a.single + (Color(f90) - f0) * a.schlick;
    }
};
using FacetFresnel = BasicFacetFresnel<float>;

}  // namespace etendue
