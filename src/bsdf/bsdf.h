// How a surface scatters light at a point: one lobe out of the list below.
//
// To add another, see CONTRIBUTING.md (A lobe).
#pragma once

#include "bsdf/clear_coat.h"
#include "bsdf/delta_list.h"
#include "bsdf/dielectric_body.h"
#include "bsdf/diffuse.h"
#include "bsdf/layered_surface.h"
#include "bsdf/metallic_roughness.h"
#include "bsdf/rough_conductor.h"
#include "bsdf/rough_dielectric.h"
#include "bsdf/rough_diffuse.h"
#include "bsdf/smooth_conductor.h"
#include "bsdf/smooth_dielectric.h"

#include <variant>

namespace etendue {

using Bsdf = std::variant<ClearCoat, Diffuse, DielectricBody, LayeredSurface, MetallicRoughness, RoughConductor,
                          RoughDielectric, RoughDiffuse, SmoothConductor, SmoothDielectric>;

/// f |cos theta_i| and the density of `sample_bsdf`, for local unit directions; zero across the delta parts, and where
/// a lobe does not scatter.
[[nodiscard]] inline BsdfValue evaluate_bsdf(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi, TransportMode mode) {
    // The commonest by far, and so cheap that reaching it would cost more than what it does.
    if (const auto* diffuse = std::get_if<Diffuse>(&bsdf)) return diffuse->evaluate(wo, wi, mode);
    return std::visit([&](const auto& lobe) { return lobe.evaluate(wo, wi, mode); }, bsdf);
}

/// Samples wi given wo. `u_lobe` and `u` in [0, 1). A weight of zero ends the walk.
[[nodiscard]] inline BsdfSample sample_bsdf(const Bsdf& bsdf, const Vec3f& wo, float u_lobe, Vec2f u,
                                            TransportMode mode) {
    if (const auto* diffuse = std::get_if<Diffuse>(&bsdf)) return diffuse->sample(wo, u_lobe, u, mode);
    return std::visit([&](const auto& lobe) { return lobe.sample(wo, u_lobe, u, mode); }, bsdf);
}

/// Evaluates as `evaluate_bsdf` does, with diffuse and other light apart.
[[nodiscard]] BsdfParts evaluate_bsdf_parts(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi, TransportMode mode);

/// All deltas of the lobe, as radiance: what `sample_bsdf` chooses one of.
[[nodiscard]] inline DeltaList deltas_of(const Bsdf& bsdf, const Vec3f& wo) {
    DeltaList deltas;
    std::visit([&](const auto& lobe) { lobe.add_deltas(wo, deltas); }, bsdf);
    return deltas;
}

/// Density, 1/sr, with which `sample_bsdf` would pick wo if it were given wi: what the walk from the other end does.
[[nodiscard]] float reverse_pdf_of_lobe(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi);
[[nodiscard]] inline float reverse_pdf_solid_angle(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi) {
    // As in `evaluate_bsdf`.
    if (std::holds_alternative<Diffuse>(bsdf) && wi.z > 0.0f) return cosine_hemisphere_pdf_solid_angle(wo);
    return reverse_pdf_of_lobe(bsdf, wo, wi);
}

/// False if everything the lobe does is a delta, so that connecting to it or sampling a light from it is useless.
[[nodiscard]] inline bool has_non_delta(const Bsdf& bsdf) {
    return std::visit([](const auto& lobe) { return lobe.has_non_delta(); }, bsdf);
}

/// True if the lobe distinguishes the two sides of its surface (z > 0 is the outside of a body); false if it wants wo
/// on the side z > 0.
[[nodiscard]] inline bool is_two_sided_interface(const Bsdf& bsdf) {
    return std::visit([](const auto& lobe) { return lobe.is_two_sided(); }, bsdf);
}

/// True if the lobe scatters nothing across its surface: quick to ask, and may be false where it does not either.
[[nodiscard]] inline bool only_reflects(const Bsdf& bsdf) {
    return std::visit([](const auto& lobe) { return lobe.only_reflects(); }, bsdf);
}

/// Returns whether all that the lobe scatters is diffuse.
[[nodiscard]] inline bool is_diffuse(const Bsdf& bsdf) {
    return std::visit([](const auto& lobe) { return lobe.is_diffuse(); }, bsdf);
}

}  // namespace etendue
