#include "bsdf/smooth_dielectric.h"

#include <cmath>

namespace etendue {

BsdfSample SmoothDielectric::sample(const Vec3f& wo, float u_lobe, Vec2f, TransportMode mode) const {
    if (wo.z == 0.0f) return {};
    const bool outside = wo.z > 0.0f;
    const float eta = outside ? ior : 1.0f / ior;
    const InterfaceFresnel::Split split = fresnel(std::min(1.0f, std::abs(wo.z)), eta, outside);
    if (u_lobe < split.reflection_share)
        return {.wi = mirror_direction(wo), .weight = split.reflected / split.reflection_share, .is_delta = true};
    const Vec3f normal{0.0f, 0.0f, std::copysign(1.0f, wo.z)};
    Vec3f wi;
    if (!refract(wo, normal, eta, wi)) return {};
    const float scale = mode == TransportMode::Radiance ? 1.0f / (eta * eta) : 1.0f;
    return {.wi = wi,
            .weight = tint * (split.transmitted / (1.0f - split.reflection_share) * scale),
            .is_delta = true,
            .is_transmission = true,
            .eta = eta};
}

void SmoothDielectric::add_deltas(const Vec3f& wo, DeltaList& deltas) const {
    if (wo.z == 0.0f) return;
    const bool outside = wo.z > 0.0f;
    const float eta = outside ? ior : 1.0f / ior;
    const InterfaceFresnel::Split split = fresnel(std::min(1.0f, std::abs(wo.z)), eta, outside);
    deltas.add({.wi = mirror_direction(wo), .weight = split.reflected, .is_delta = true});
    const Vec3f normal{0.0f, 0.0f, std::copysign(1.0f, wo.z)};
    Vec3f wi;
    if (refract(wo, normal, eta, wi))
        deltas.add({.wi = wi,
                    .weight = tint * (split.transmitted / (eta * eta)),
                    .is_delta = true,
                    .is_transmission = true,
                    .eta = eta});
}

}  // namespace etendue
