// A clear varnish over a surface, with a roughness and a normal of its own.
//
// GGX with Schlick's Fresnel term for the index 1.5, multiple scattering included (KHR_materials_clearcoat). Cosines
// are taken to the coat's normal, so that a flat varnish over a rough weave shades as flat as it is. With alpha below
// kSmoothAlpha the coat is a delta. Directions are in the frame of the surface below, with z > 0; where the coat's own
// normal faces away from a direction there is no coat for it. A coat without such a surface is a lobe by itself, in the
// frame of its own normal.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/delta_list.h"

namespace etendue {

struct ClearCoat {
    float strength = 0.0f;           ///< share of the surface that is covered, [0, 1]
    float alpha = 0.0f;              ///< coat roughness², [0, 1]
    Vec3f normal{0.0f, 0.0f, 1.0f};  ///< unit, in the frame of the surface below

    [[nodiscard]] bool exists() const { return strength > 0.0f; }
    [[nodiscard]] bool is_smooth() const;
    /// Returns whether the coat's normal is another than that of the surface below.
    [[nodiscard]] bool leans() const { return exists() && normal.z < 1.0f - 1e-6f; }
    /// Evaluates the coat without the delta of a smooth one.
    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    /// Returns a direction with the density of `evaluate`, or the mirror's for a smooth coat. It may lie below the
    /// surface.
    [[nodiscard]] Vec3f sample_direction(const Vec3f& wo, float u_lobe, Vec2f u) const;
    /// Returns the reflected share of a smooth coat.
    [[nodiscard]] float smooth_reflectance(const Vec3f& wo) const;

    /// Returns the share of light with cosine `cos_coat` to the coat's own normal that the coat leaves to the layer
    /// below: 1 - albedo, [0, 1].
    [[nodiscard]] float passed(float cos_coat) const;

    /// Samples the coat as a lobe by itself.
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    /// Adds the mirror of a smooth coat, weighted as radiance.
    void add_deltas(const Vec3f& wo, DeltaList& deltas) const;
    [[nodiscard]] bool has_non_delta() const { return !is_smooth(); }
    [[nodiscard]] static constexpr bool is_diffuse() { return false; }
    [[nodiscard]] static constexpr bool is_two_sided() { return false; }
    [[nodiscard]] static constexpr bool only_reflects() { return true; }
};

}  // namespace etendue
