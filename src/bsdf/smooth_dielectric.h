// A smooth interface between two dielectrics: reflects and refracts, both deltas.
//
// Fresnel's equations for unpolarised light; radiance is divided by eta² when it passes from wi's side to wo's (Veach
// 1997, equation 5.2). wo.z > 0 is the outside. Example: glass with ior 1.5, water with 1.33.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/delta_list.h"
#include "bsdf/interface_fresnel.h"

namespace etendue {

struct SmoothDielectric {
    float ior = 1.5f;  ///< index inside (z < 0) over index outside, > 0
    Rgb tint{1.0f};    ///< tint of transmitted light, [0, 1]
    InterfaceFresnel fresnel{};

    [[nodiscard]] BsdfValue evaluate(const Vec3f&, const Vec3f&, TransportMode) const { return {}; }
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    /// Adds the deltas that light seen along `wo` may have taken, weighted as radiance.
    void add_deltas(const Vec3f& wo, DeltaList& deltas) const;
    [[nodiscard]] bool has_non_delta() const { return false; }
    [[nodiscard]] static constexpr bool is_diffuse() { return false; }
    [[nodiscard]] static constexpr bool is_two_sided() { return true; }
    [[nodiscard]] static constexpr bool only_reflects() { return false; }
};

}  // namespace etendue
