// A rough metal: GGX microfacets with the metal's Fresnel reflectance, energy kept by a multiple-scattering lobe.
//
// Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (EGSR 2007), equation 20; Kulla and Conty
// (SIGGRAPH 2017 course). Example: brushed aluminium, alpha = 0.1.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/delta_list.h"
#include "bsdf/fresnel.h"

namespace etendue {

struct RoughConductor {
    FresnelMetal fresnel;
    float alpha = 0.1f;  ///< [kSmoothAlpha, 1]

    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    /// Adds nothing: none of its samples are deltas.
    void add_deltas(const Vec3f&, DeltaList&) const {}
    [[nodiscard]] bool has_non_delta() const { return true; }
    [[nodiscard]] static constexpr bool is_diffuse() { return false; }
    [[nodiscard]] static constexpr bool is_two_sided() { return false; }
    [[nodiscard]] static constexpr bool only_reflects() { return true; }
};

}  // namespace etendue
