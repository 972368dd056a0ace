// Lambertian reflection.
//
// f = albedo / pi. Sampled by the cosine; every sample has weight `albedo`. Example: chalk, matte paint.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "sampling/warp.h"

namespace etendue {

struct Diffuse {
    Rgb albedo{0.5f};  ///< reflected share per channel, [0, 1]

    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    [[nodiscard]] bool has_non_delta() const { return true; }
};

inline BsdfValue Diffuse::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode) const {
    if (wo.z <= 0.0f || wi.z <= 0.0f) return {};
    const float pdf = cosine_hemisphere_pdf_solid_angle(wi);
    return {albedo * pdf, pdf};
}

inline BsdfSample Diffuse::sample(const Vec3f& wo, float, Vec2f u, TransportMode) const {
    if (wo.z <= 0.0f) return {};
    const Vec3f wi = square_to_cosine_hemisphere(u);
    if (wi.z <= 0.0f) return {};
    return {.wi = wi, .weight = albedo, .pdf_solid_angle = cosine_hemisphere_pdf_solid_angle(wi)};
}

}  // namespace etendue
