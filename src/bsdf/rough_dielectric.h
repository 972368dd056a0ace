// A rough interface between two dielectrics: GGX microfacets that reflect and refract, energy kept on both sides.
//
// Single scattering: Walter et al. (EGSR 2007), equations 20 and 21, with height-correlated masking for both. Multiple
// scattering, with o on side A, i on side B, e = 1 - E the missing energy, and n the indices:
//
//   reflected    R_A e_A(o) e_A(i) / (pi e_avg_A)
//   transmitted  T_A e_A(o) e_B(i) / (pi e_avg_B)          as carried by particles (TransportMode::Importance)
//
// R_A + T_A = 1 returns exactly what was lost. Reciprocity, f(o -> i) / n_i² = f(i -> o) / n_o² (Veach 1997, equation
// 5.14), holds when T_A / (e_avg_B n_B²) = T_B / (e_avg_A n_A²); the factor that is left free makes the larger of the
// two shares that of a smooth interface in diffuse light. In a white furnace the sum is 1 within 0.5%, for every
// alpha along x and along y, from both sides, for indices from 1.002 and cosines from 0.02 on. Closer to
// edge-on than 0.02 it is 3%, and 6% where facets are stretched and reflect less or more than the index says.
// Example: frosted glass, ior 1.5, alpha = 0.2.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/delta_list.h"
#include "bsdf/interface_fresnel.h"

namespace etendue {

struct RoughDielectric {
    float ior = 1.5f;      ///< index inside (z < 0) over index outside, [1 / kMaxTabulatedEta, kMaxTabulatedEta]
    float alpha_x = 0.1f;  ///< [kSmoothAlpha, 1]
    float alpha_y = 0.1f;
    /// Share T of the multiply scattered light that is transmitted, for wo outside and inside.
    float multiple_transmitted_outside = 0.0f;
    float multiple_transmitted_inside = 0.0f;
    float missing_average_outside = 1.0f;  ///< 1 - E averaged over a cosine-weighted hemisphere
    float missing_average_inside = 1.0f;
    Rgb tint{1.0f};  ///< tint of transmitted light, [0, 1]
    InterfaceFresnel fresnel{};

    /// Prepares the shares above. Indices beyond those tabulated are taken for the largest or smallest that are.
    [[nodiscard]] static RoughDielectric make(float ior, float alpha_x, float alpha_y,
                                              const InterfaceFresnel& fresnel = {});
    [[nodiscard]] static RoughDielectric make(float ior, float alpha) { return make(ior, alpha, alpha); }

    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    /// Adds nothing: none of its samples are deltas.
    void add_deltas(const Vec3f&, DeltaList&) const {}
    [[nodiscard]] bool has_non_delta() const { return true; }
    [[nodiscard]] static constexpr bool is_diffuse() { return false; }
    [[nodiscard]] static constexpr bool is_two_sided() { return true; }
    [[nodiscard]] static constexpr bool only_reflects() { return false; }

    /// Holds what would leave a body if a layer on its outside did not send it back, as f |cos theta_i| of light that
    /// is sent back whole; wo.z < 0, wi.z < 0. `single` is from the facet that mirrors wo to wi, where light would go
    /// on along `out_o`, or along `out_i` were it wi that arrives; `multiple` leaves in all directions.
    struct Returned {
        float single;
        float multiple;
        float pdf_solid_angle;  ///< density of `sample_returned`, 1/sr
        Vec3f out_o, out_i;
    };
    [[nodiscard]] Returned evaluate_returned(const Vec3f& wo, const Vec3f& wi) const;
    /// A mirror direction of wo at a facet that it sees. It may lie outside.
    [[nodiscard]] Vec3f sample_returned(const Vec3f& wo, Vec2f u) const;
};

}  // namespace etendue
