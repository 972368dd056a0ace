// A clear varnish over a surface, with a roughness and a normal of its own.
//
// GGX with Schlick's Fresnel term for the index 1.5, multiple scattering included (KHR_materials_clearcoat). Cosines
// are taken to the coat's normal, so that a flat varnish over a rough weave shades as flat as it is. With alpha below
// kSmoothAlpha the coat is a delta. Directions are in the frame of the surface below, with z > 0; where the coat's own
// normal faces away from a direction there is no coat for it.
#pragma once

#include "bsdf/bsdf_sample.h"

namespace etendue {

struct ClearCoat {
    float strength = 0.0f;           ///< share of the surface that is covered, [0, 1]
    float alpha = 0.0f;              ///< coat roughness², [0, 1]
    Vec3f normal{0.0f, 0.0f, 1.0f};  ///< unit, in the frame of the surface below

    [[nodiscard]] bool exists() const { return strength > 0.0f; }
    [[nodiscard]] bool is_smooth() const;
    /// Evaluates the coat without the delta of a smooth one.
    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    /// A direction with the density of `evaluate`, or the mirror's for a smooth coat. It may lie below the surface.
    [[nodiscard]] Vec3f sample(const Vec3f& wo, float u_lobe, Vec2f u) const;
    /// Reflected share of a smooth coat.
    [[nodiscard]] float smooth_reflectance(const Vec3f& wo) const;

    /// Returns the share of light with cosine `cos_coat` to the coat's own normal that the coat leaves to the layer
    /// below: 1 - albedo, [0, 1].
    [[nodiscard]] float passed(float cos_coat) const;
};

}  // namespace etendue
