#include "bsdf/rough_diffuse.h"

#include "sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

constexpr float kA = 0.5f - 2.0f * kInvPi / 3.0f;                 ///< equation 4
constexpr float kAverage = 2.0f / 3.0f - 28.0f * kInvPi / 15.0f;  ///< equation 12

/// Directional albedo of single scattering by white facets (equations 7 and 8).
float single_albedo(float cos_theta, float roughness) {
    const float c = std::clamp(cos_theta, 0.0f, 1.0f);
    const float s = std::sqrt(1.0f - c * c);
    // tan (1 - sin³) loses its digits where the cosine vanishes: (1 - s³) / c = c (1 + s + s²) / (1 + s).
    const float g = s * (std::acos(c) - s * c) + (2.0f / 3.0f) * s * (c * (1.0f + s + s * s) / (1.0f + s) - 1.0f);
    return (1.0f + roughness * kInvPi * g) / (1.0f + kA * roughness);
}

}  // namespace

Rgb rough_over_lambertian(const Rgb& albedo, float roughness, const Vec3f& wo, const Vec3f& wi) {
    const float s = wo.x * wi.x + wo.y * wi.y;
    const float s_over_t = s > 0.0f ? s / std::max(wo.z, wi.z) : s;
    const float a = 1.0f / (1.0f + kA * roughness);
    const Rgb single{a * std::max(0.0f, 1.0f + roughness * s_over_t)};

    const float mean = a * (1.0f + kAverage * roughness);
    const float missing = 1.0f - mean;
    if (!(missing > 0.0f)) return single;
    const auto series = [&](float rho) { return rho * mean / (1.0f - rho * missing); };
    const float shape = (1.0f - single_albedo(wo.z, roughness)) * (1.0f - single_albedo(wi.z, roughness)) / missing;
    return single + Rgb(series(albedo.r), series(albedo.g), series(albedo.b)) * std::max(0.0f, shape);
}

BsdfValue RoughDiffuse::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode) const {
    if (wo.z <= 0.0f || wi.z <= 0.0f) return {};
    const float pdf = cosine_hemisphere_pdf_solid_angle(wi);
    return {albedo * rough_over_lambertian(albedo, roughness, wo, wi) * pdf, pdf};
}

BsdfSample RoughDiffuse::sample(const Vec3f& wo, float, Vec2f u, TransportMode mode) const {
    if (wo.z <= 0.0f) return {};
    const Vec3f wi = square_to_cosine_hemisphere(u);
    if (wi.z <= 0.0f) return {};
    const BsdfValue value = evaluate(wo, wi, mode);
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    return {.wi = wi, .weight = value.f_cos / value.pdf_solid_angle, .pdf_solid_angle = value.pdf_solid_angle};
}

}  // namespace etendue
