#include "bsdf/diffuse.h"

#include "sampling/warp.h"

namespace etendue {

BsdfValue Diffuse::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode) const {
    if (wo.z <= 0.0f || wi.z <= 0.0f) return {};
    const float pdf = cosine_hemisphere_pdf_solid_angle(wi);
    return {albedo * pdf, pdf};
}

BsdfSample Diffuse::sample(const Vec3f& wo, float, Vec2f u, TransportMode) const {
    if (wo.z <= 0.0f) return {};
    const Vec3f wi = square_to_cosine_hemisphere(u);
    if (wi.z <= 0.0f) return {};
    return {.wi = wi, .weight = albedo, .pdf_solid_angle = cosine_hemisphere_pdf_solid_angle(wi)};
}

}  // namespace etendue
