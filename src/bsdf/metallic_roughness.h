// glTF 2.0 metallic-roughness with KHR_materials_ior, _specular, _iridescence, _anisotropy, _diffuse_roughness,
// _diffuse_transmission and thin-walled _transmission; docs/derivations.md, equations 19 and 20.
//
// material   = mix(dielectric, metal, metallic)                                  (glTF 2.0 specification, appendix B)
// metal      = GGX with Schlick's Fresnel term, f0 = base colour
// dielectric = GGX with f0 and f90 over mix(mix(diffuse, diffuse transmission), transmission), which receives
//              (1 - E(o)) (1 - E(i)) / (1 - E_avg) with E, the specular layer's albedo in its most reflective channel
//
// So what lies under a coloured layer keeps its colour (KHR_materials_specular), and the layer absorbs a little. Under
// a thin film E is an estimate (facet_fresnel.h): the brightest channel of a white surface reflects 0.98 to 1.01. A
// rough diffuse part is EON (rough_diffuse.h), diffuse transmission the same on the other side; under the specular
// layer, which passes less light at grazing angles, a white one keeps between 0.97 and 1. Thin-walled: light leaves
// opposite to where a mirror would send it, without refraction, tinted once by the base colour. With both alphas below
// kSmoothAlpha the specular and transmitted parts are deltas. Scatters for wo.z > 0 only.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/delta_list.h"
#include "bsdf/ggx.h"
#include "bsdf/thin_film.h"

namespace etendue {

struct MetallicRoughness {
    Rgb base{1.0f};         ///< [0, 1]
    float metallic = 1.0f;  ///< [0, 1]
    float alpha_x = 1.0f;   ///< roughness² along x, [0, 1]
    float alpha_y = 1.0f;
    Rgb f0{0.04f};              ///< reflectance of the dielectric at normal incidence, [0, f90]
    float f90 = 1.0f;           ///< reflectance of the dielectric at grazing incidence, [0, 1]
    float transmission = 0.0f;  ///< [0, 1]
    float diffuse_transmission = 0.0f;
    Rgb diffuse_transmission_color{1.0f};
    float diffuse_roughness = 0.0f;  ///< [0, 1]; 0 is Lambert's surface
    ThinFilm film{};

    /// True of what PlainMetallicRoughness can be.
    [[nodiscard]] bool is_plain() const {
        return alpha_x == alpha_y && alpha_x >= kSmoothAlpha && transmission == 0.0f && diffuse_transmission == 0.0f &&
               diffuse_roughness == 0.0f && !film.exists();
    }

    [[nodiscard]] BsdfParts evaluate_parts(const Vec3f& wo, const Vec3f& wi) const;
    /// The density of `evaluate` alone.
    [[nodiscard]] float pdf_solid_angle(const Vec3f& wo, const Vec3f& wi) const;

    /// Share of light with cosine `cos_theta` that the dielectric's specular layer lets through to what lies under it.
    [[nodiscard]] float passed_by_specular(float cos_theta) const;

    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    /// Adds the deltas that light seen along `wo` may have taken, weighted as radiance.
    void add_deltas(const Vec3f& wo, DeltaList& deltas) const;
    [[nodiscard]] bool has_non_delta() const;
    [[nodiscard]] static constexpr bool is_diffuse() { return false; }
    [[nodiscard]] static constexpr bool is_two_sided() { return false; }
    [[nodiscard]] bool only_reflects() const { return transmission == 0.0f && diffuse_transmission == 0.0f; }
};

}  // namespace etendue
