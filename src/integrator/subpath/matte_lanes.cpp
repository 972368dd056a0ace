#include "integrator/subpath/matte_lanes.h"

#include "core/ray.h"
#include "world/lane_scattering.h"

namespace etendue {

using WideVec3 = Imath::Vec3<Wide>;

void MatteLanes::orient(std::size_t count) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const OrientedSurface<Wide> faced({tangent.load(l), bitangent.load(l), normal.load(l)},
                                          geometric_normal.load(l), wo.load(l), true);
        tangent.store(l, faced.frame.tangent);
        normal.store(l, faced.frame.normal);
        facing_normal.store(l, faced.geometric_normal);
        wo_local.store(l, faced.wo_local);
        wo_agrees.store(l, select(faced.wo_agrees, Wide(1.0f), Wide(0.0f)));
    }
}

void MatteLanes::sample(std::size_t count, TransportMode mode) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const OrientedSurface<Wide> faced({tangent.load(l), bitangent.load(l), normal.load(l)}, facing_normal.load(l),
                                          wo.load(l), wo_local.load(l), wo_agrees.load(l) > Wide(0.0f));
        const BasicBsdfSample<Wide> sampled = sample_matte(faced, BasicDiffuse<Wide>{albedo.load(l)}, u.load(l), mode);
        next_direction.store(l, sampled.wi);
        next_weight.store(l, sampled.weight);
        next_pdf.store(l, sampled.pdf_solid_angle);
        next_reverse_pdf.store(l, cosine_hemisphere_pdf_solid_angle(faced.wo_local));
        const WideVec3 front = geometric_normal.load(l);
        next_cosine.store(l, abs(dot(sampled.wi, front)));
        next_origin.store(l, offset_origin(position.load(l), front, clearance.load(l), sampled.wi));
    }
}

}  // namespace etendue
