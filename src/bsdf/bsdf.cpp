#include "bsdf/bsdf.h"

namespace etendue {

namespace {

float pdf_of_lobe(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi) {
    // The lobe that most surfaces have, and half of what it does is not for the density.
    if (const auto* lobe = std::get_if<MetallicRoughness>(&bsdf)) return lobe->pdf_solid_angle(wo, wi);
    // Densities are the same in both modes.
    return evaluate_bsdf(bsdf, wo, wi, TransportMode::Importance).pdf_solid_angle;
}

}  // namespace

float reverse_pdf_of_lobe(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi) {
    if (wi.z > 0.0f || is_two_sided_interface(bsdf)) return pdf_of_lobe(bsdf, wi, wo);
    // Lobes that do not tell sides apart are turned to face where the walk comes from.
    const Vec3f from = turned_about_y(wi);
    const Vec3f to = turned_about_y(wo);
    if (const auto* layered = std::get_if<LayeredSurface>(&bsdf))
        return layered->from_behind().evaluate(from, to, TransportMode::Importance).pdf_solid_angle;
    return pdf_of_lobe(bsdf, from, to);
}

BsdfParts evaluate_bsdf_parts(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi, TransportMode mode) {
    if (const auto* base = std::get_if<MetallicRoughness>(&bsdf)) return base->evaluate_parts(wo, wi);
    if (const auto* body = std::get_if<DielectricBody>(&bsdf)) return body->evaluate_parts(wo, wi, mode);
    if (const auto* layered = std::get_if<LayeredSurface>(&bsdf)) return layered->evaluate_parts(wo, wi, mode);
    const BsdfValue value = evaluate_bsdf(bsdf, wo, wi, mode);
    if (std::holds_alternative<Diffuse>(bsdf) || std::holds_alternative<RoughDiffuse>(bsdf))
        return {value.f_cos, {}, value.pdf_solid_angle};
    return {{}, value.f_cos, value.pdf_solid_angle};
}

}  // namespace etendue
