#include "bsdf/rough_dielectric.h"

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/ggx_albedo.h"
#include "bsdf/ggx_anisotropic_albedo.h"
#include "bsdf/ggx_multiple.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

float mean_alpha(const Ggx& ggx) {
    return ggx.is_isotropic() ? ggx.alpha_x : std::sqrt(ggx.alpha_x * ggx.alpha_y);
}

/// Returns the alpha at which round facets miss the share `target`; `missing` returns that share and grows with alpha.
template <typename Missing>
float alpha_that_misses(float target, const Missing& missing) {
    float low = 0.0f;
    float high = 1.0f;
    for (int i = 0; i < 12; ++i) (missing(0.5f * (low + high)) < target ? low : high) = 0.5f * (low + high);
    return 0.5f * (low + high);
}

/// Returns 1 - E(w), the share of energy that single scattering misses, for `w` on the side from which the other side
/// has the relative index `eta`. Anisotropic facets with a reflectance of their own count as isotropic facets that miss
/// as much with the Fresnel reflectance of the indices.
float missing_of(const InterfaceFresnel& fresnel, const Ggx& ggx, const Vec3f& w, float eta) {
    const Vec3f above{w.x, w.y, std::abs(w.z)};
    const auto bare = [&](float alpha) { return 1.0f - ggx_dielectric_albedo(above.z, alpha, eta); };
    const float of_bare = ggx.is_isotropic() ? bare(ggx.alpha_x)
                                             : ggx_anisotropic_dielectric_missing(above, ggx.alpha_x, ggx.alpha_y, eta);
    if (fresnel.is_bare()) return std::clamp(of_bare, 0.0f, 1.0f);
    const float alpha = ggx.is_isotropic() ? ggx.alpha_x : alpha_that_misses(of_bare, bare);
    return std::clamp(fresnel.mixture(eta).blend(of_bare, 1.0f - ggx_albedo(above.z, alpha).single,
                                                 1.0f - ggx_total_only_albedo(above.z, alpha, eta)),
                      0.0f, 1.0f);
}

/// Returns 1 - E averaged over the hemisphere on the side whose other side has the relative index `eta`.
float missing_average_of(const InterfaceFresnel& fresnel, const Ggx& ggx, float eta) {
    const auto bare = [&](float alpha) { return 1.0f - ggx_dielectric_albedo_average(alpha, eta); };
    const float of_bare = ggx.is_isotropic()
                              ? bare(ggx.alpha_x)
                              : ggx_anisotropic_dielectric_missing_average(ggx.alpha_x, ggx.alpha_y, eta);
    if (fresnel.is_bare()) return of_bare;
    const float alpha = ggx.is_isotropic() ? ggx.alpha_x : alpha_that_misses(of_bare, bare);
    return std::clamp(fresnel.mixture(eta).blend(of_bare, 1.0f - ggx_albedo_average(alpha).single,
                                                 1.0f - ggx_total_only_albedo_average(alpha, eta)),
                      0.0f, 1.0f);
}

/// Returns the share of diffuse light that a smooth interface to an index `eta` times that on this side lets through.
float passed_by_smooth(const InterfaceFresnel& fresnel, float eta) {
    const float total = std::max(0.0f, 1.0f - eta * eta);
    return 1.0f - fresnel.mixture(eta).blend(fresnel_dielectric_average(eta), 1.0f, total);
}

/// The interface seen from wo's side, mirrored so that wo.z > 0.
struct Side {
    const RoughDielectric& lobe;
    Ggx ggx;
    GgxMultiple multiple_directions;
    bool outside;
    float eta;                   ///< index on the other side over the index on wo's
    float missing;               ///< 1 - E(wo)
    float multiple_transmitted;  ///< share of the missing energy that is transmitted

    /// `wo` as it is, before it is mirrored.
    Side(const RoughDielectric& interface, const Vec3f& wo)
        : lobe(interface),
          ggx{interface.alpha_x, interface.alpha_y},
          multiple_directions(mean_alpha(ggx)),
          outside(wo.z > 0.0f),
          eta(outside ? interface.ior : 1.0f / interface.ior),
          missing(missing_of(interface.fresnel, ggx, wo, eta)),
          multiple_transmitted(outside ? interface.multiple_transmitted_outside
                                       : interface.multiple_transmitted_inside) {}

    [[nodiscard]] float missing_average(bool on_the_outside) const {
        return on_the_outside ? lobe.missing_average_outside : lobe.missing_average_inside;
    }
    [[nodiscard]] InterfaceFresnel::Split split(float cos_o) const { return lobe.fresnel(cos_o, eta, outside); }
};

/// (1 - E(w)) / (1 - E_avg) |cos| / pi on the side whose other side has the relative index `eta`: integrates to 1.
float multiple_shape(const Side& side, float eta, float missing_average, const Vec3f& w) {
    if (!(missing_average > 0.0f)) return 0.0f;
    return missing_of(side.lobe.fresnel, side.ggx, w, eta) / missing_average * std::abs(w.z) * kInvPi;
}

/// Evaluates reflection in particle (importance) mode; wo.z > 0, wi.z > 0.
BsdfValue evaluate_reflection(const Side& side, const Vec3f& wo, const Vec3f& wi) {
    const Vec3f h = normalize(wo + wi);
    const InterfaceFresnel::Split split = side.split(std::min(1.0f, dot(wo, h)));
    const float d = side.ggx.d(h);
    const float reflected = 1.0f - side.multiple_transmitted;
    const float multiple =
        reflected * side.missing * multiple_shape(side, side.eta, side.missing_average(side.outside), wi);
    const float pdf = (1.0f - side.missing) * split.reflection_share * d * side.ggx.g1(wo) / (4.0f * wo.z) +
                      side.missing * reflected * side.multiple_directions.pdf_solid_angle(wi.z);
    return {split.reflected * (d * side.ggx.g2(wo, wi) / (4.0f * wo.z)) + Rgb(multiple), pdf};
}

/// Evaluates transmission in particle (importance) mode; wo.z > 0, wi.z < 0.
BsdfValue evaluate_transmission(const Side& side, const Vec3f& wo, const Vec3f& wi) {
    const float multiple = side.multiple_transmitted * side.missing *
                           multiple_shape(side, 1.0f / side.eta, side.missing_average(!side.outside), wi);
    BsdfValue value{side.lobe.tint * multiple,
                    side.missing * side.multiple_transmitted * side.multiple_directions.pdf_solid_angle(-wi.z)};
    Vec3f h = wo + wi * side.eta;
    h = normalize(h.z < 0.0f ? -h : h);
    const float o_h = dot(wo, h);
    const float i_h = dot(wi, h);
    if (o_h <= 0.0f || i_h >= 0.0f) return value;
    const InterfaceFresnel::Split split = side.split(std::min(1.0f, o_h));
    const float root = i_h + o_h / side.eta;
    const float dh_dwi = -i_h / (root * root);
    const float common = side.ggx.d(h) * o_h * dh_dwi / wo.z;
    value.f_cos += side.lobe.tint * (split.transmitted * common * side.ggx.g2(wo, wi));
    value.pdf_solid_angle += (1.0f - side.missing) * (1.0f - split.reflection_share) * common * side.ggx.g1(wo);
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

RoughDielectric RoughDielectric::make(float wanted_ior, float alpha_x, float alpha_y, const InterfaceFresnel& fresnel) {
    const float ior = std::clamp(wanted_ior, 1.0f / kMaxTabulatedEta, kMaxTabulatedEta);
    const Ggx ggx{alpha_x, alpha_y};
    const float missing_outside = missing_average_of(fresnel, ggx, ior);
    const float missing_inside = missing_average_of(fresnel, ggx, 1.0f / ior);
    const float larger = std::max({missing_outside, missing_inside, 1e-6f});
    const float passed = passed_by_smooth(fresnel, ior);
    return {.ior = ior,
            .alpha_x = alpha_x,
            .alpha_y = alpha_y,
            .multiple_transmitted_outside = passed * missing_inside / larger,
            .multiple_transmitted_inside = passed / (ior * ior) * missing_outside / larger,
            .missing_average_outside = missing_outside,
            .missing_average_inside = missing_inside,
            .fresnel = fresnel};
}

BsdfValue RoughDielectric::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const {
    if (wo.z == 0.0f || wi.z == 0.0f) return {};
    const Side side(*this, wo);
    return wo.z > 0.0f ? evaluate_side(side, wo, wi, mode) : evaluate_side(side, flip(wo), flip(wi), mode);
}

BsdfSample RoughDielectric::sample(const Vec3f& wo_signed, float u_lobe, Vec2f u, TransportMode mode) const {
    if (wo_signed.z == 0.0f) return {};
    const bool inside = wo_signed.z < 0.0f;
    const Vec3f wo = inside ? flip(wo_signed) : wo_signed;
    const Side side(*this, wo_signed);

    Vec3f wi;
    if (u_lobe < side.missing) {
        wi = side.multiple_directions.sample(u);
        if (u_lobe < side.missing * side.multiple_transmitted) wi = flip(wi);
    } else {
        const float u_fresnel = (u_lobe - side.missing) / (1.0f - side.missing);
        const Vec3f h = side.ggx.sample_visible_normal(wo, u);
        const float o_h = std::min(1.0f, dot(wo, h));
        if (u_fresnel < side.split(o_h).reflection_share) {
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

RoughDielectric::Returned RoughDielectric::evaluate_returned(const Vec3f& wo_inside, const Vec3f& wi_inside) const {
    const Side side(*this, wo_inside);
    const Vec3f wo = flip(wo_inside);
    const Vec3f wi = flip(wi_inside);
    const Vec3f h = normalize(wo + wi);
    const float o_h = std::min(1.0f, dot(wo, h));
    const float mirrored = side.ggx.d(h) / (4.0f * wo.z);
    Returned result{.single = 0.0f,
                    .multiple = side.multiple_transmitted * side.missing *
                                multiple_shape(side, side.eta, side.missing_average(side.outside), wi),
                    .pdf_solid_angle = mirrored * side.ggx.g1(wo),
                    .out_o = Vec3f(0.0f),
                    .out_i = Vec3f(0.0f)};
    if (!refract(wo, h, side.eta, result.out_o) || !refract(wi, h, side.eta, result.out_i)) return result;
    result.single = side.split(o_h).transmitted * mirrored * side.ggx.g2(wo, wi);
    result.out_o = flip(result.out_o);
    result.out_i = flip(result.out_i);
    return result;
}

Vec3f RoughDielectric::sample_returned(const Vec3f& wo_inside, Vec2f u) const {
    const Vec3f wo = flip(wo_inside);
    const Vec3f h = Ggx{alpha_x, alpha_y}.sample_visible_normal(wo, u);
    return flip(h * (2.0f * dot(wo, h)) - wo);
}

}  // namespace etendue
