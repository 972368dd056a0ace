// What `Scattering` does with lobes, for lanes of any width.
#pragma once

#include "bsdf/diffuse.h"
#include "world/oriented_surface.h"

namespace etendue {

/// What a lobe says of `wi`, which is `wi_local` in the surface's frame, as radiance; zero where the leak rule says so.
template <typename T>
[[nodiscard]] inline BasicBsdfValue<T> placed(const OrientedSurface<T>& surface, const BasicBsdfValue<T>& value,
                                              const Imath::Vec3<T>& wi, const Imath::Vec3<T>& wi_local) {
    const T scatters = select(surface.wo_agrees && surface.agrees(wi, wi_local), T(1.0f), T(0.0f));
    return {value.f_cos * scatters, value.pdf_solid_angle * scatters};
}

/// A lobe's sample in world space; the weight is zero where nothing is scattered.
template <typename T>
[[nodiscard]] inline BasicBsdfSample<T> placed(const OrientedSurface<T>& surface, BasicBsdfSample<T> sample,
                                               TransportMode mode) {
    const Imath::Vec3<T> wi_local = sample.wi;
    sample.wi = surface.frame.to_world(wi_local);
    const T factor = mode == TransportMode::Importance ? surface.adjoint_factor(sample.wi, wi_local) : T(1.0f);
    sample.weight *= select(surface.wo_agrees && surface.agrees(sample.wi, wi_local), factor, T(0.0f));
    return sample;
}

/// f cos theta_i, as radiance, and the density of `sample_matte`.
template <typename T>
[[nodiscard]] inline BasicBsdfValue<T> evaluate_matte(const OrientedSurface<T>& surface, const BasicDiffuse<T>& lobe,
                                                      const Imath::Vec3<T>& wi) {
    const Imath::Vec3<T> wi_local = surface.frame.to_local(wi);
    return placed(surface, lobe.evaluate(surface.wo_local, wi_local, TransportMode::Radiance), wi, wi_local);
}

/// `u` in [0, 1)².
template <typename T>
[[nodiscard]] inline BasicBsdfSample<T> sample_matte(const OrientedSurface<T>& surface, const BasicDiffuse<T>& lobe,
                                                     const Imath::Vec2<T>& u, TransportMode mode) {
    return placed(surface, lobe.sample(surface.wo_local, 0.0f, u, mode), mode);
}

}  // namespace etendue
