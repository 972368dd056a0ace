#include "wave/subpath/diffuse_lanes.h"

#include "core/ray.h"
#include "world/lane_scattering.h"

#include <array>

namespace etendue {

using WideVec3 = Imath::Vec3<Wide>;

void DiffuseLanes::orient(std::size_t count, TransportMode mode) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const OrientedSurface<Wide> faced({tangent.load(l), bitangent.load(l), normal.load(l)},
                                          geometric_normal.load(l), wo.load(l), true);
        tangent.store(l, faced.frame.tangent);
        normal.store(l, faced.frame.normal);
        facing_normal.store(l, faced.geometric_normal);
        const bool is_eye = mode == TransportMode::Radiance;
        reverse_pdf.store(l, is_eye ? diffuse_pdf_for_light(faced.leaning, faced.wo_local)
                                    : diffuse_pdf_for_eye(faced.leaning, faced.wo_local));
        end_origin.store(
            l, offset_origin(position.load(l), faced.geometric_normal, clearance.load(l), faced.geometric_normal));
        const Wide received = is_eye ? Wide(1.0f) : faced.received();
        end_weight.store(l, throughput.load(l) * albedo.load(l) * (received * faced.leaning.cosine_gain()));
    }
}

void DiffuseLanes::sample(std::size_t count, TransportMode mode) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const OrientedSurface<Wide> faced({tangent.load(l), bitangent.load(l), normal.load(l)}, facing_normal.load(l),
                                          wo.load(l), false);
        const BasicBsdfSample<Wide> sampled =
            sample_diffuse(faced, BasicDiffuse<Wide>{albedo.load(l)}, u.load(l), mode);
        next_direction.store(l, sampled.wi);
        next_weight.store(l, sampled.weight);
        next_pdf.store(l, sampled.pdf_solid_angle);
        const WideVec3 front = geometric_normal.load(l);
        next_cosine.store(l, abs(dot(sampled.wi, front)));
        next_origin.store(l, offset_origin(position.load(l), front, clearance.load(l), sampled.wi));
    }
}

void DiffuseLanes::store_ends(std::span<DiffuseEnd* const> ends) const {
    DiffuseEnd nowhere;
    for (std::size_t l = 0; l < ends.size(); l += Wide::kWidth) {
        std::array<DiffuseEnd*, Wide::kWidth> to;
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] = l + i < ends.size() && ends[l + i] != nullptr ? ends[l + i] : &nowhere;
        etendue::store_ends({.position = position.load(l),
                             .origin = end_origin.load(l),
                             .normal = normal.load(l),
                             .geometric_normal = facing_normal.load(l),
                             .weight = end_weight.load(l),
                             .fewer = end_fewer.load(l)},
                            to);
    }
}

}  // namespace etendue
