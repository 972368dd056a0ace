#include "bsdf/clear_coat.h"

#include "bsdf/facet_fresnel.h"
#include "bsdf/ggx_reflection.h"
#include "core/frame.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

constexpr float kF0 = 0.04f;  ///< reflectance at normal incidence for the index 1.5

float fresnel(float cos_theta) {
    return fresnel_schlick(Rgb(kF0), cos_theta).r;
}

/// Share of multiply scattered light that is not lost to what lies below.
float multiple_factor(const GgxReflection& reflection) {
    return reflection.multiple_fresnel(fresnel_schlick_average(Rgb(kF0))).r;
}

}  // namespace

bool ClearCoat::is_smooth() const {
    return alpha < kSmoothAlpha;
}

BsdfValue ClearCoat::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const {
    if (is_smooth()) return {};
    const Frame frame = Frame::from_normal(normal);
    const Vec3f o = frame.to_local(wo);
    const Vec3f i = frame.to_local(wi);
    if (o.z <= 0.0f || i.z <= 0.0f) return {};
    const GgxReflection reflection(Ggx::isotropic(alpha), o);
    const GgxReflection::Value value = reflection.evaluate(o, i);
    float f_cos = strength * (fresnel(value.cos_half) * value.single + multiple_factor(reflection) * value.multiple);
    // The surface's adjoint factor is made of the cosines to its normal; those to the coat's belong there.
    if (mode == TransportMode::Importance) f_cos *= o.z * wi.z / (i.z * wo.z);
    return {Rgb(f_cos), value.pdf_solid_angle};
}

Vec3f ClearCoat::sample_direction(const Vec3f& wo, float u_lobe, Vec2f u) const {
    const Frame frame = Frame::from_normal(normal);
    const Vec3f o = frame.to_local(wo);
    if (o.z <= 0.0f) return -wo;
    if (is_smooth()) return frame.to_world(mirror_direction(o));
    return frame.to_world(GgxReflection(Ggx::isotropic(alpha), o).sample(o, u_lobe, u));
}

float ClearCoat::smooth_reflectance(const Vec3f& wo) const {
    const float cos_o = dot(wo, normal);
    return cos_o > 0.0f ? strength * fresnel(cos_o) : 0.0f;
}

BsdfSample ClearCoat::sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const {
    const Vec3f wi = sample_direction(wo, u_lobe, u);
    if (!(wi.z > 0.0f)) return {};
    if (is_smooth()) return {.wi = wi, .weight = Rgb(smooth_reflectance(wo)), .is_delta = true};
    BsdfSample sample{.wi = wi, .weight = {}};
    const BsdfValue value = evaluate(wo, sample.wi, mode);
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    sample.weight = value.f_cos / value.pdf_solid_angle;
    sample.pdf_solid_angle = value.pdf_solid_angle;
    return sample;
}

void ClearCoat::add_deltas(const Vec3f& wo, DeltaList& deltas) const {
    if (is_smooth() && wo.z > 0.0f)
        deltas.add({.wi = mirror_direction(wo), .weight = Rgb(smooth_reflectance(wo)), .is_delta = true});
}

float ClearCoat::passed(float cos_coat) const {
    if (!exists() || cos_coat <= 0.0f) return 1.0f;
    if (is_smooth()) return 1.0f - strength * fresnel(cos_coat);
    const GgxReflection reflection(Ggx::isotropic(alpha), {0.0f, 0.0f, cos_coat});
    const FacetFresnel coat{Rgb(kF0), 1.0f, {}};
    return 1.0f - strength * (coat.albedo(reflection.albedo_o).r +
                              multiple_factor(reflection) * (1.0f - reflection.albedo_o.single));
}

}  // namespace etendue
