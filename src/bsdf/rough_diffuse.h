// A rough diffuse surface that keeps its energy: EON.
//
// Portsmouth, Kutz and Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF" (JCGT 14(1), 2025): Fujii's
// variant of Oren and Nayar's model (equation 3) and a lobe of light that scattered several times (equation 20), which
// makes a white surface reflect exactly 1. Sampled by the cosine. Reflects for wo.z > 0. Example: clay, roughness 0.8.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/delta_list.h"

namespace etendue {

/// Returns how much more light a rough surface of `albedo` scatters from `wi` to `wo` than Lambert's surface of that
/// albedo, for wo.z > 0 and wi.z > 0; symmetric in both. `roughness` is in [0, 1], and 0 gives 1.
[[nodiscard]] Rgb rough_over_lambertian(const Rgb& albedo, float roughness, const Vec3f& wo, const Vec3f& wi);

struct RoughDiffuse {
    Rgb albedo{0.5f};        ///< albedo of the facets, [0, 1]
    float roughness = 0.0f;  ///< [0, 1]; 0 is Lambert's surface

    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    /// Adds nothing: none of its samples are deltas.
    void add_deltas(const Vec3f&, DeltaList&) const {}
    [[nodiscard]] bool has_non_delta() const { return true; }
    [[nodiscard]] static constexpr bool is_diffuse() { return true; }
    [[nodiscard]] static constexpr bool is_two_sided() { return false; }
    [[nodiscard]] static constexpr bool only_reflects() { return true; }
};

}  // namespace etendue
