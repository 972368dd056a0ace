// The model of shading normals that lean away from the geometric one, in the lobe's frame.
//
// A walk from the eye finds every direction above the surface scattering, and the lobe's whole albedo in each:
// - What is seen from below the shading horizon is seen from its mirror image above that horizon, which is the lobe's
//   own answer where the horizon is crossed.
// - What the lobe would send through the surface is mirrored back by it. Diffuse light is made up for in all other
//   directions instead, by 2 / (1 + n_s.n_g), the share of a cosine lobe that stays above the surface: mirrored, it
//   would pile up along the edges of facets.
//
// Walks from lights carry the adjoint of this, with the ratio of cosines of Veach (1997), equation 5.19. A model that
// is its own adjoint and loses nothing is known (Schüssler et al., "Microfacet-based Normal Mapping for Robust Monte
// Carlo Path Tracing", 2017), but any such diffuse surface sends out as much as arrives on the geometric surface,
// whichever way its normal leans: the relief of normal maps would not show.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "core/lane.h"

namespace etendue {

/// A template of its lane type, see core/lane.h. Directions are local to the frame of the shading normal.
template <typename T>
struct LeaningNormal {
    using Vec = Imath::Vec3<T>;

    Vec geometric{T(0.0f), T(0.0f), T(1.0f)};  ///< the geometric normal, unit

    /// Cosine between `w` and the geometric normal: its sign tells the side of the surface.
    [[nodiscard]] T side(const Vec& w) const { return dot(w, geometric); }
    /// Mirrors `w` in the surface.
    [[nodiscard]] Vec mirrored(const Vec& w) const { return w - geometric * (T(2.0f) * side(w)); }
    /// Returns the direction from which the eye sees the lobe: `wo`, mirrored to the shading normal's side of its
    /// horizon where it lies beyond it.
    [[nodiscard]] Vec seen_from(const Vec& wo) const {
        constexpr float kLeastCosine = 1e-6f;  // lobes have no answer on the horizon itself
        return {wo.x, wo.y, copysign(max(abs(wo.z), T(kLeastCosine)), side(wo))};
    }
    /// Returns the factor by which a cosine lobe grows for the share of it that the surface hides.
    [[nodiscard]] T cosine_gain() const { return T(2.0f) / (T(1.0f) + max(T(0.0f), geometric.z)); }
    /// Returns that factor for the diffuse lobe under a specular layer, which is narrower and loses less.
    [[nodiscard]] T diffuse_gain() const {
        constexpr float kNarrower = 0.95f;  // the brightest white surface reflects 1.004; by 1 it would be 1.007
        return T(1.0f) + T(kNarrower) * (cosine_gain() - T(1.0f));
    }

    /// Evaluates the lobe towards `wi` for a walk from the eye. `lobe(w)` returns its parts (BasicBsdfParts) towards
    /// `w`, zero where it does not scatter.
    template <typename Lobe>
    [[nodiscard]] BasicBsdfParts<T> evaluate_for_eye(const Vec& wi, const Lobe& lobe) const {
        const T above = side(wi);
        const Vec other = mirrored(wi);
        const auto is_direct = wi.z * above > T(0.0f);
        const auto is_mirrored = other.z * above > T(0.0f);
        BasicBsdfParts<T> found;
        if (any(is_direct)) {
            const BasicBsdfParts<T> direct = lobe(wi);
            found.diffuse = select<T>(is_direct, direct.diffuse * diffuse_gain(), found.diffuse);
            found.specular = select<T>(is_direct, direct.specular, found.specular);
            found.pdf_solid_angle = select(is_direct, direct.pdf_solid_angle, T(0.0f));
        }
        if (any(is_mirrored)) {
            const BasicBsdfParts<T> back = lobe(other);
            found.specular += select<T>(is_mirrored, back.specular, BasicRgb<T>());
            found.pdf_solid_angle += select(is_mirrored, back.pdf_solid_angle, T(0.0f));
        }
        return found;
    }
    /// Returns the direction of a sample of the lobe, mirrored back where it would pass the surface.
    [[nodiscard]] Vec kept_on_side(const Vec& wi) const {
        const auto is_kept = wi.z * side(wi) >= T(0.0f);
        const Vec other = mirrored(wi);
        return {select(is_kept, wi.x, other.x), select(is_kept, wi.y, other.y), select(is_kept, wi.z, other.z)};
    }
};

}  // namespace etendue
