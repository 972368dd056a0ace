#include "bsdf/dielectric_body.h"

#include "bsdf/ggx.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// One-sided lobes want wo above the surface; they do not change when both directions are mirrored.
Vec3f facing(const Vec3f& w, const Vec3f& wo) {
    return wo.z < 0.0f ? Vec3f(w.x, w.y, -w.z) : w;
}

/// Says which share of light passes diffuse transmission from each side. The rest stays there: radiance is higher by
/// the squared index on the side of the higher one, and what refraction has let in must not leave amplified; and layers
/// on the outside keep some of what leaves.
struct DiffusePassage {
    float by_index = 1.0f;  ///< share that the index lets through from the denser side
    bool is_dense_inside = true;
    float by_layers = 1.0f;  ///< share that layers let through from the inside

    explicit DiffusePassage(const DielectricBody& body) : by_layers(body.passed_by_layers) {
        const float ior = std::visit([](const auto& lobe) { return lobe.ior; }, body.interface);
        is_dense_inside = ior > 1.0f;
        by_index = is_dense_inside ? 1.0f / (ior * ior) : ior * ior;
    }
    [[nodiscard]] bool is_dense(const Vec3f& w) const { return (w.z < 0.0f) == is_dense_inside; }
    /// Returns the share of light from the side of `w` that passes.
    [[nodiscard]] float from(const Vec3f& w) const {
        return (is_dense(w) ? by_index : 1.0f) * (w.z < 0.0f ? by_layers : 1.0f);
    }
};

Vec3f across(const Vec3f& w) {
    return {w.x, w.y, -w.z};
}

/// Evaluates the share of a body that is no interface.
BsdfParts evaluate_opaque(const DielectricBody& body, const Vec3f& wo, const Vec3f& wi, TransportMode mode) {
    BsdfParts value = body.opaque.evaluate_parts(facing(wo, wo), facing(wi, wo));
    if (body.opaque.diffuse_transmission == 0.0f) return value;
    const DiffusePassage passage(body);
    if (wo.z * wi.z > 0.0f) {
        if (passage.from(wo) == 1.0f) return value;
        const BsdfParts held = body.opaque.evaluate_parts(facing(wo, wo), facing(across(wi), wo));
        value.diffuse += held.diffuse * (1.0f - passage.from(wo));
        value.pdf_solid_angle += held.pdf_solid_angle * (1.0f - passage.from(wo));
    } else {
        // The layers themselves say what they keep in each direction.
        if (passage.is_dense(mode == TransportMode::Radiance ? wi : wo)) value.diffuse *= passage.by_index;
        value.pdf_solid_angle *= passage.from(wo);
    }
    return value;
}

/// Samples the share of a body that is no interface; only the direction counts, and whether it is a delta's.
BsdfSample sample_opaque(const DielectricBody& body, const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) {
    const float passes = body.opaque.diffuse_transmission > 0.0f ? DiffusePassage(body).from(wo) : 1.0f;
    const bool holds = u_lobe >= passes;
    const float u_rest =
        std::clamp(holds ? (u_lobe - passes) / (1.0f - passes) : u_lobe / passes, 0.0f, kOneMinusEpsilon);
    BsdfSample sample = body.opaque.sample(facing(wo, wo), u_rest, u, mode);
    sample.wi = facing(sample.wi, wo);
    if (holds && sample.is_transmission) {
        sample.wi = across(sample.wi);
        sample.is_transmission = false;
    }
    return sample;
}

}  // namespace

std::variant<SmoothDielectric, RoughDielectric> make_interface(float ior, Vec2f alpha, const Rgb& tint,
                                                               const InterfaceFresnel& fresnel) {
    const bool is_same = !bends_light(ior);
    if (is_same || std::max(alpha.x, alpha.y) < kSmoothAlpha)
        return SmoothDielectric{.ior = is_same ? 1.0f : ior, .tint = tint, .fresnel = fresnel};
    RoughDielectric rough =
        RoughDielectric::make(ior, std::max(alpha.x, kSmoothAlpha), std::max(alpha.y, kSmoothAlpha), fresnel);
    rough.tint = tint;
    return rough;
}

bool DielectricBody::has_non_delta() const {
    return std::holds_alternative<RoughDielectric>(interface) || (interface_share < 1.0f && opaque.has_non_delta());
}

BsdfParts DielectricBody::evaluate_parts(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const {
    BsdfParts value;
    if (interface_share < 1.0f) {
        const float share = 1.0f - interface_share;
        value = evaluate_opaque(*this, wo, wi, mode);
        value.diffuse *= share;
        value.specular *= share;
        value.pdf_solid_angle *= share;
    }
    const BsdfValue through = std::visit([&](const auto& lobe) { return lobe.evaluate(wo, wi, mode); }, interface);
    value.specular += through.f_cos * interface_share;
    value.pdf_solid_angle += through.pdf_solid_angle * interface_share;
    return value;
}

BsdfValue DielectricBody::evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const {
    return evaluate_parts(wo, wi, mode).sum();
}

BsdfSample DielectricBody::sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const {
    const bool choose_interface = u_lobe < interface_share;
    const float first = choose_interface ? 0.0f : interface_share;
    const float share = choose_interface ? interface_share : 1.0f - interface_share;
    const float u_rest = std::clamp((u_lobe - first) / share, 0.0f, kOneMinusEpsilon);
    BsdfSample sample;
    if (choose_interface) {
        sample = std::visit([&](const auto& lobe) { return lobe.sample(wo, u_rest, u, mode); }, interface);
    } else {
        sample = sample_opaque(*this, wo, u_rest, u, mode);
    }
    // The share is both part of the value and the chance of the choice, and cancels from a delta's weight.
    if (sample.is_delta) return sample;
    if (!(sample.pdf_solid_angle > 0.0f)) return {};
    const BsdfValue value = evaluate(wo, sample.wi, mode);
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    sample.weight = value.f_cos / value.pdf_solid_angle;
    sample.pdf_solid_angle = value.pdf_solid_angle;
    return sample;
}

void DielectricBody::add_deltas(const Vec3f& wo, DeltaList& deltas) const {
    if (const auto* smooth = std::get_if<SmoothDielectric>(&interface); smooth != nullptr && interface_share > 0.0f) {
        DeltaList own;
        smooth->add_deltas(wo, own);
        for (BsdfSample delta : own) {
            delta.weight *= interface_share;
            deltas.add(delta);
        }
    }
    if (interface_share == 1.0f) return;
    DeltaList own;
    opaque.add_deltas(facing(wo, wo), own);
    for (BsdfSample delta : own) {
        delta.weight *= 1.0f - interface_share;
        delta.wi = facing(delta.wi, wo);
        deltas.add(delta);
    }
}

}  // namespace etendue
