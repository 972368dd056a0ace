#include "bsdf/smooth_dielectric.h"

#include "bsdf/fresnel.h"

namespace etendue {

BsdfSample SmoothDielectric::sample(const Vec3f& wo, float u_lobe, Vec2f, TransportMode mode) const {
    if (wo.z == 0.0f) return {};
    const float eta = wo.z > 0.0f ? ior : 1.0f / ior;
    const float reflectance = fresnel_dielectric(std::abs(wo.z), eta);
    // Each of the two is chosen with its own albedo, which cancels from the weight.
    if (u_lobe < reflectance) return {.wi = mirror_direction(wo), .weight = Rgb(1.0f), .is_delta = true};
    const Vec3f normal{0.0f, 0.0f, std::copysign(1.0f, wo.z)};
    Vec3f wi;
    if (!refract(wo, normal, eta, wi)) return {};
    const float scale = mode == TransportMode::Radiance ? 1.0f / (eta * eta) : 1.0f;
    return {.wi = wi, .weight = Rgb(scale), .is_delta = true, .is_transmission = true, .eta = eta};
}

}  // namespace etendue
