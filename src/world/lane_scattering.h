// Diffuse lobes on surfaces with leaning normals, for lanes of any width; surfaces are turned to `wo`.
#pragma once

#include "bsdf/diffuse.h"
#include "world/oriented_surface.h"

namespace etendue {

/// Returns the density, 1/sr, with which a walk from the eye leaves a diffuse surface along `w`, which is local.
template <typename T>
[[nodiscard]] inline T diffuse_pdf_for_eye(const LeaningNormal<T>& leaning, const Imath::Vec3<T>& w) {
    const T both = cosine_hemisphere_pdf_solid_angle(w) + cosine_hemisphere_pdf_solid_angle(leaning.mirrored(w));
    return select(leaning.side(w) > T(0.0f), both, T(0.0f));
}

/// Returns the density, 1/sr, with which a walk from a light leaves a diffuse surface along `w`, which is local.
template <typename T>
[[nodiscard]] inline T diffuse_pdf_for_light(const LeaningNormal<T>& leaning, const Imath::Vec3<T>& w) {
    return max(T(0.0f), leaning.side(w)) * kInvPi;
}

/// Returns f |cos| and the density of `sample_diffuse` towards `w`, which is local.
template <typename T>
[[nodiscard]] inline BasicBsdfValue<T> evaluate_diffuse(const OrientedSurface<T>& surface, const BasicDiffuse<T>& lobe,
                                                        const Imath::Vec3<T>& w, TransportMode mode) {
    const LeaningNormal<T>& leaning = surface.leaning;
    const BasicRgb<T> albedo = lobe.albedo * leaning.cosine_gain();
    if (mode == TransportMode::Importance) {
        const T pdf = diffuse_pdf_for_light(leaning, w);
        return {albedo * (surface.received() * pdf), pdf};
    }
    const T above = select(leaning.side(w) > T(0.0f), cosine_hemisphere_pdf_solid_angle(w), T(0.0f));
    return {albedo * above, diffuse_pdf_for_eye(leaning, w)};
}

/// Samples, by `u` in [0, 1)², a direction in world space in which a walk leaves a diffuse surface.
template <typename T>
[[nodiscard]] inline BasicBsdfSample<T> sample_diffuse(const OrientedSurface<T>& surface, const BasicDiffuse<T>& lobe,
                                                       const Imath::Vec2<T>& u, TransportMode mode) {
    const Imath::Vec3<T> around = square_to_cosine_hemisphere(u);
    const Imath::Vec3<T> local = mode == TransportMode::Importance
                                     ? BasicFrame<T>::from_normal(surface.leaning.geometric).to_world(around)
                                     : surface.leaning.kept_on_side(around);
    const BasicBsdfValue<T> value = evaluate_diffuse(surface, lobe, local, mode);
    const auto scatters = value.pdf_solid_angle > T(0.0f);
    return {.wi = surface.frame.to_world(local),
            .weight = select<T>(scatters, value.f_cos / value.pdf_solid_angle, BasicRgb<T>()),
            .pdf_solid_angle = value.pdf_solid_angle};
}

}  // namespace etendue
