#include "bsdf/rough_conductor.h"

#include "bsdf/ggx_reflection.h"

namespace etendue {

namespace {

BsdfValue evaluate_with(const RoughConductor& lobe, const GgxReflection& reflection, const Vec3f& wo, const Vec3f& wi) {
    const GgxReflection::Value value = reflection.evaluate(wo, wi);
    const Rgb f_cos = lobe.fresnel(value.cos_half) * value.single +
                      reflection.multiple_fresnel(lobe.fresnel.average()) * value.multiple;
    return {f_cos, value.pdf_solid_angle};
}

}  // namespace

BsdfValue RoughConductor::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode) const {
    if (wo.z <= 0.0f || wi.z <= 0.0f) return {};
    return evaluate_with(*this, GgxReflection(Ggx::isotropic(alpha), wo), wo, wi);
}

BsdfSample RoughConductor::sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode) const {
    if (wo.z <= 0.0f) return {};
    const GgxReflection reflection(Ggx::isotropic(alpha), wo);
    const Vec3f wi = reflection.sample(wo, u_lobe, u);
    if (wi.z <= 0.0f) return {};
    const BsdfValue value = evaluate_with(*this, reflection, wo, wi);
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    return {.wi = wi, .weight = value.f_cos / value.pdf_solid_angle, .pdf_solid_angle = value.pdf_solid_angle};
}

}  // namespace etendue
