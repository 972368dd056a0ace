// How light leaves a point of a surface that emits by Lambert's law, within a beam.
#pragma once

#include "core/frame.h"
#include "light/beam.h"
#include "light/emission_sample.h"
#include "sampling/warp.h"

namespace etendue {

/// Samples the direction in which `sample` leaves a surface with this front, by the cosine; from either side if
/// `two_sided`. `clearance` is that of the surface, metres, as in SurfacePoint.
inline void leave_surface(const Vec3f& front, float clearance, Vec2f u, bool two_sided, const Beam& beam,
                          EmissionSample& sample) {
    Vec3f normal = front;
    if (two_sided) {
        const bool back = u.x >= 0.5f;
        u.x = 2.0f * u.x - (back ? 1.0f : 0.0f);
        if (back) normal = -normal;
    }
    const Vec3f local = beam.sample(u);
    sample.direction = Frame::from_normal(normal).to_world(local);
    sample.offset = normal * clearance;
    sample.cos_theta = local.z;
    sample.pdf_direction_solid_angle =
        cosine_hemisphere_pdf_solid_angle(local) * (two_sided ? 0.5f : beam.density_factor(local.z));
}

/// Has `sample` leave a surface with this front along `direction` instead; from either side if `two_sided`. The density
/// of the direction and the radiance are left to the caller.
inline void turn_on_surface(const Vec3f& front, float clearance, bool two_sided, const Vec3f& direction,
                            EmissionSample& sample) {
    const float cosine = dot(front, direction);
    const bool is_back = two_sided && cosine < 0.0f;
    sample.direction = direction;
    sample.offset = front * (is_back ? -clearance : clearance);
    sample.cos_theta = is_back ? -cosine : cosine;
}

}  // namespace etendue
