#include "bsdf/smooth_conductor.h"

namespace etendue {

BsdfSample SmoothConductor::sample(const Vec3f& wo, float, Vec2f, TransportMode) const {
    if (wo.z <= 0.0f) return {};
    return {.wi = mirror_direction(wo), .weight = fresnel(wo.z), .is_delta = true};
}

void SmoothConductor::add_deltas(const Vec3f& wo, DeltaList& deltas) const {
    if (wo.z > 0.0f) deltas.add({.wi = mirror_direction(wo), .weight = fresnel(wo.z), .is_delta = true});
}

}  // namespace etendue
