// A perfect mirror of metal.
//
// All light goes to the mirror direction, scaled by the metal's Fresnel reflectance: a delta. Example: silvered glass.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/delta_list.h"
#include "bsdf/fresnel.h"

namespace etendue {

struct SmoothConductor {
    FresnelMetal fresnel;

    [[nodiscard]] BsdfValue evaluate(const Vec3f&, const Vec3f&, TransportMode) const { return {}; }
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    /// Adds the delta that light seen along `wo` may have taken, weighted as radiance.
    void add_deltas(const Vec3f& wo, DeltaList& deltas) const;
    [[nodiscard]] bool has_non_delta() const { return false; }
    [[nodiscard]] static constexpr bool is_diffuse() { return false; }
    [[nodiscard]] static constexpr bool is_two_sided() { return false; }
    [[nodiscard]] static constexpr bool only_reflects() { return true; }
};

}  // namespace etendue
