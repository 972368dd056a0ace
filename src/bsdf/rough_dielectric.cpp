#include "bsdf/rough_dielectric.h"

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/ggx_albedo.h"
#include "bsdf/ggx_multiple.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// The interface seen from wo's side, mirrored so that wo.z > 0.
struct Side {
    Ggx ggx;
    GgxMultiple multiple_directions;
    float eta;                   ///< index on the other side over the index on wo's
    float missing;               ///< 1 - E(wo)
    float multiple_transmitted;  ///< share of the missing energy that is transmitted

    Side(const RoughDielectric& lobe, float wo_z)
        : ggx{lobe.alpha},
          multiple_directions(lobe.alpha),
          eta(wo_z > 0.0f ? lobe.ior : 1.0f / lobe.ior),
          missing(std::clamp(1.0f - ggx_dielectric_albedo(std::abs(wo_z), lobe.alpha, eta), 0.0f, 1.0f)),
          multiple_transmitted(wo_z > 0.0f ? lobe.multiple_transmitted_outside : lobe.multiple_transmitted_inside) {}
};

/// (1 - E(w)) / (1 - E_avg) |cos| / pi on the side whose other side has the relative index `eta`: integrates to 1.
float multiple_shape(const Side& side, float eta, float cos_theta) {
    const float average = 1.0f - ggx_dielectric_albedo_average(side.ggx.alpha, eta);
    if (!(average > 0.0f)) return 0.0f;
    return (1.0f - ggx_dielectric_albedo(cos_theta, side.ggx.alpha, eta)) / average * cos_theta * kInvPi;
}

/// Both in particle (importance) mode; wo.z > 0, wi.z > 0.
BsdfValue evaluate_reflection(const Side& side, const Vec3f& wo, const Vec3f& wi) {
    const Vec3f h = normalize(wo + wi);
    const float f = fresnel_dielectric(dot(wo, h), side.eta);
    const float d = side.ggx.d(h);
    const float reflected = 1.0f - side.multiple_transmitted;
    const float single = f * d * side.ggx.g2(wo, wi) / (4.0f * wo.z);
    const float multiple = reflected * side.missing * multiple_shape(side, side.eta, wi.z);
    const float pdf = (1.0f - side.missing) * f * d * side.ggx.g1(wo) / (4.0f * wo.z) +
                      side.missing * reflected * side.multiple_directions.pdf_solid_angle(wi.z);
    return {Rgb(single + multiple), pdf};
}

/// wo.z > 0, wi.z < 0.
BsdfValue evaluate_transmission(const Side& side, const Vec3f& wo, const Vec3f& wi) {
    const float cos_i = -wi.z;
    const float multiple = side.multiple_transmitted * side.missing * multiple_shape(side, 1.0f / side.eta, cos_i);
    BsdfValue value{Rgb(multiple),
                    side.missing * side.multiple_transmitted * side.multiple_directions.pdf_solid_angle(cos_i)};
    Vec3f h = wo + wi * side.eta;
    h = normalize(h.z < 0.0f ? -h : h);
    const float o_h = dot(wo, h);
    const float i_h = dot(wi, h);
    if (o_h <= 0.0f || i_h >= 0.0f) return value;
    const float f = fresnel_dielectric(o_h, side.eta);
    const float root = i_h + o_h / side.eta;
    const float dh_dwi = -i_h / (root * root);
    const float common = (1.0f - f) * side.ggx.d(h) * o_h * dh_dwi / wo.z;
    value.f_cos += Rgb(common * side.ggx.g2(wo, wi));
    value.pdf_solid_angle += (1.0f - side.missing) * common * side.ggx.g1(wo);
    return value;
}

/// wo.z > 0.
BsdfValue evaluate_side(const Side& side, const Vec3f& wo, const Vec3f& wi, TransportMode mode) {
    if (wi.z > 0.0f) return evaluate_reflection(side, wo, wi);
    BsdfValue value = evaluate_transmission(side, wo, wi);
    if (mode == TransportMode::Radiance) value.f_cos *= 1.0f / (side.eta * side.eta);
    return value;
}

Vec3f flip(const Vec3f& w) {
    return {w.x, w.y, -w.z};
}

}  // namespace

RoughDielectric RoughDielectric::make(float ior, float alpha) {
    const float missing_outside = 1.0f - ggx_dielectric_albedo_average(alpha, ior);
    const float missing_inside = 1.0f - ggx_dielectric_albedo_average(alpha, 1.0f / ior);
    const float larger = std::max({missing_outside, missing_inside, 1e-6f});
    return {.ior = ior,
            .alpha = alpha,
            .multiple_transmitted_outside = (1.0f - fresnel_dielectric_average(ior)) * missing_inside / larger,
            .multiple_transmitted_inside =
                (1.0f - fresnel_dielectric_average(ior)) / (ior * ior) * missing_outside / larger};
}

BsdfValue RoughDielectric::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const {
    if (wo.z == 0.0f || wi.z == 0.0f) return {};
    const Side side(*this, wo.z);
    return wo.z > 0.0f ? evaluate_side(side, wo, wi, mode) : evaluate_side(side, flip(wo), flip(wi), mode);
}

BsdfSample RoughDielectric::sample(const Vec3f& wo_signed, float u_lobe, Vec2f u, TransportMode mode) const {
    if (wo_signed.z == 0.0f) return {};
    const bool inside = wo_signed.z < 0.0f;
    const Vec3f wo = inside ? flip(wo_signed) : wo_signed;
    const Side side(*this, wo_signed.z);

    Vec3f wi;
    if (u_lobe < side.missing) {
        wi = side.multiple_directions.sample(u);
        if (u_lobe < side.missing * side.multiple_transmitted) wi = flip(wi);
    } else {
        const float u_fresnel = (u_lobe - side.missing) / (1.0f - side.missing);
        const Vec3f h = side.ggx.sample_visible_normal(wo, u);
        const float o_h = dot(wo, h);
        if (u_fresnel < fresnel_dielectric(o_h, side.eta)) {
            wi = h * (2.0f * o_h) - wo;
            if (wi.z <= 0.0f) return {};
        } else if (!refract(wo, h, side.eta, wi) || wi.z >= 0.0f) {
            return {};
        }
    }
    if (wi.z == 0.0f) return {};
    const BsdfValue value = evaluate_side(side, wo, wi, mode);
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    const bool transmitted = wi.z < 0.0f;
    return {.wi = inside ? flip(wi) : wi,
            .weight = value.f_cos / value.pdf_solid_angle,
            .pdf_solid_angle = value.pdf_solid_angle,
            .is_transmission = transmitted,
            .eta = transmitted ? side.eta : 1.0f};
}

}  // namespace etendue
