#include "world/scattering.h"

#include "sampling/hash.h"
#include "sampling/warp.h"
#include "world/coated_scattering.h"
#include "world/lane_scattering.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace etendue {

namespace {

using Leaning = LeaningNormal<float>;

/// True of a delta that goes straight on: no normal bends it.
bool is_straight(const BsdfSample& sample) {
    return sample.is_delta && sample.is_transmission && sample.eta == 1.0f;
}

/// Light that arrives at a surface from `direct`, on its side `side`, is what the eye finds there and what it finds
/// mirrored. A walk from the light takes one of the two by their cosines.
struct Arrivals {
    Vec3f direct, mirrored;
    float direct_cosine, mirrored_cosine;  ///< to the normal of shading; 0 where the lobe is not met

    Arrivals(const Leaning& leaning, const Vec3f& from, float side)
        : direct(from),
          mirrored(leaning.mirrored(from)),
          direct_cosine(from.z * side > 0.0f ? std::abs(from.z) : 0.0f),
          mirrored_cosine(mirrored.z * side > 0.0f ? std::abs(mirrored.z) : 0.0f) {}

    [[nodiscard]] float sum() const { return direct_cosine + mirrored_cosine; }
    /// Probability of taking the one with `cosine`.
    [[nodiscard]] float chance(float cosine) const { return cosine / sum(); }
};

/// Eyes that see a lobe from one direction are there, or at its mirror image in the shading horizon. A walk from a
/// light goes to one of the two by their cosines.
struct Viewpoints {
    Vec3f direct, mirrored;
    float direct_side, mirrored_side;  ///< cosines to the geometric normal; 0 where the eye would not see the lobe so

    Viewpoints(const Leaning& leaning, const Vec3f& seen)
        : direct(seen),
          mirrored(seen.x, seen.y, -seen.z),
          direct_side(leaning.side(direct)),
          mirrored_side(leaning.side(mirrored)) {
        if (!(direct_side * seen.z > 0.0f)) direct_side = 0.0f;
        if (!(mirrored_side * seen.z > 0.0f)) mirrored_side = 0.0f;
    }

    [[nodiscard]] float sum() const { return std::abs(direct_side) + std::abs(mirrored_side); }
    /// Probability of going to the one with the cosine `side`.
    [[nodiscard]] float chance(float side) const { return std::abs(side) / sum(); }
};

/// Hashes the numbers that chose a direction into another one in [0, 1).
float number_besides(float u_lobe, Vec2f u) {
    const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
    return to_unit_float(hash_combine(hash_combine(bits(u.x), bits(u.y)), bits(u_lobe)));
}

/// Returns how refraction compresses solid angles on the way back, over this way; 1 for reflection.
float compression_ratio(const BsdfSample& sample, float cos_o, float cos_i) {
    if (!sample.is_transmission) return 1.0f;
    return std::abs(cos_o) / (sample.eta * sample.eta * std::max(std::abs(cos_i), 1e-6f));
}

/// Returns the diffuse and the specular part of a lobe. Only a cosine lobe counts as diffuse: the lobe of a rough
/// diffuse surface counts as specular.
BsdfParts lobe_parts(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi, TransportMode mode) {
    BsdfParts parts = evaluate_bsdf_parts(bsdf, wo, wi, mode);
    if (std::holds_alternative<RoughDiffuse>(bsdf)) std::swap(parts.diffuse, parts.specular);
    return parts;
}

float share(float diffuse, float specular) {
    return diffuse > 0.0f ? diffuse / (diffuse + specular) : 0.0f;
}

}  // namespace

BsdfValue Scattering::evaluate(const Vec3f& wi, TransportMode mode) const {
    if (has_no_eye_along(wi, mode)) return {};
    const Placed placed_wi = placed(wi);
    // The commonest by far, and many at once elsewhere.
    if (const auto* diffuse = std::get_if<Diffuse>(bsdf_))
        return evaluate_diffuse(surface_, *diffuse, placed_wi.w, mode);
    if (const auto* layered = under_leaning_coat())
        return CoatedScattering(*layered, surface_).evaluate_parts(wi, mode).sum();
    if (leans_) return evaluate_placed(placed_wi, mode).sum();
    if (!placed_wo().agrees() || !placed_wi.agrees()) return {};
    return evaluate_bsdf(*bsdf_, surface_.wo_local, placed_wi.w, mode);
}

BsdfParts Scattering::evaluate_parts(const Vec3f& wi, TransportMode mode) const {
    if (const auto* layered = under_leaning_coat())
        return CoatedScattering(*layered, surface_).evaluate_parts(wi, mode);
    return evaluate_placed(placed(wi), mode);
}

BsdfParts Scattering::evaluate_placed(const Placed& wi, TransportMode mode) const {
    const Placed wo = placed_wo();
    if (!leans_) return wo.agrees() && wi.agrees() ? evaluate_bsdf_parts(*bsdf_, wo.w, wi.w, mode) : BsdfParts();
    if (mode == TransportMode::Importance) return evaluate_for_light(wo, wi);
    const Vec3f seen_from = surface_.seen_from();
    return surface_.leaning.evaluate_for_eye(wi.w,
                                             [&](const Vec3f& w) { return lobe_parts(*bsdf_, seen_from, w, mode); });
}

BsdfParts Scattering::evaluate_for_light(const Placed& wo, const Placed& wi) const {
    const Leaning& leaning = surface_.leaning;
    const Vec3f eye = leaning.seen_from(wi.w);
    const Arrivals arrivals(leaning, wo.w, wo.side);
    BsdfParts value;
    const auto add = [&](const Vec3f& from, float cosine, float diffuse_gain) {
        if (cosine == 0.0f) return;
        const BsdfParts parts = lobe_parts(*bsdf_, from, eye, TransportMode::Importance);
        value.diffuse += parts.diffuse * (cosine * diffuse_gain);
        value.specular += parts.specular * cosine;
        value.pdf_solid_angle += parts.pdf_solid_angle * arrivals.chance(cosine);
    };
    add(arrivals.direct, arrivals.direct_cosine, leaning.diffuse_gain());
    add(arrivals.mirrored, arrivals.mirrored_cosine, 0.0f);
    const float below = std::abs(eye.z * wo.side);
    if (!(below > 0.0f)) return {};
    const float factor = std::abs(wi.side) / below;
    value.diffuse *= factor;
    value.specular *= factor;
    value.pdf_solid_angle *= Viewpoints(leaning, eye).chance(wi.side);
    return value;
}

Rgb Scattering::diffuse_share(const Vec3f& wi, TransportMode mode) const {
    if (is_diffuse(*bsdf_)) return Rgb(1.0f);
    const BsdfParts parts = evaluate_parts(wi, mode);
    return {share(parts.diffuse.r, parts.specular.r), share(parts.diffuse.g, parts.specular.g),
            share(parts.diffuse.b, parts.specular.b)};
}

float Scattering::pdf_for_eye(const Placed& from, const Placed& to) const {
    const Vec3f seen_from = surface_.leaning.seen_from(from.w);
    const Arrivals arrivals(surface_.leaning, to.w, to.side);
    float pdf = 0.0f;
    if (arrivals.direct_cosine > 0.0f) pdf += etendue::reverse_pdf_solid_angle(*bsdf_, arrivals.direct, seen_from);
    if (arrivals.mirrored_cosine > 0.0f) pdf += etendue::reverse_pdf_solid_angle(*bsdf_, arrivals.mirrored, seen_from);
    return pdf;
}

float Scattering::pdf_for_light(const Placed& from, const Placed& to) const {
    const Vec3f eye = surface_.leaning.seen_from(to.w);
    const Arrivals arrivals(surface_.leaning, from.w, from.side);
    float pdf = 0.0f;
    const auto add = [&](const Vec3f& w, float cosine) {
        if (cosine > 0.0f) pdf += arrivals.chance(cosine) * etendue::reverse_pdf_solid_angle(*bsdf_, eye, w);
    };
    add(arrivals.direct, arrivals.direct_cosine);
    add(arrivals.mirrored, arrivals.mirrored_cosine);
    return pdf > 0.0f ? pdf * Viewpoints(surface_.leaning, eye).chance(to.side) : 0.0f;
}

float Scattering::reverse_pdf_solid_angle(const Vec3f& wi, TransportMode mode) const {
    const Placed from = placed(wi);
    const Placed to = placed_wo();
    const bool is_eye = mode == TransportMode::Radiance;
    if (std::holds_alternative<Diffuse>(*bsdf_)) {
        if (!(from.side > 0.0f)) return 0.0f;
        return is_eye ? diffuse_pdf_for_light(surface_.leaning, to.w) : diffuse_pdf_for_eye(surface_.leaning, to.w);
    }
    if (const auto* layered = under_leaning_coat())
        return CoatedScattering(*layered, surface_).reverse_pdf_solid_angle(wi, mode);
    if (leans_) return is_eye ? pdf_for_light(from, to) : pdf_for_eye(from, to);
    return to.agrees() && from.agrees() ? etendue::reverse_pdf_solid_angle(*bsdf_, to.w, from.w) : 0.0f;
}

Scattering::TwoWayValue Scattering::evaluate_both_ways(const Vec3f& wi, TransportMode mode) const {
    const BsdfValue value = evaluate(wi, mode);
    if (is_black(value.f_cos)) return {};
    return {value.f_cos, value.pdf_solid_angle, reverse_pdf_solid_angle(wi, mode)};
}

BsdfSample Scattering::sample(float u_lobe, Vec2f u, TransportMode mode) const {
    const BsdfSample sample = sample_both_sides(u_lobe, u, mode);
    return has_no_eye_along(sample.wi, mode) ? BsdfSample{} : sample;
}

BsdfSample Scattering::sample_evenly(float u_lobe, Vec2f u) const {
    if (!only_reflects(*bsdf_) || !deltas().is_empty()) return sample(u_lobe, u, TransportMode::Radiance);
    const Vec3f& normal = surface_.geometric_normal;
    BsdfSample sample;
    sample.wi =
        Frame::from_normal(dot(surface_.wo, normal) < 0.0f ? -normal : normal).to_world(square_to_hemisphere(u));
    sample.pdf_solid_angle = hemisphere_pdf_solid_angle();
    sample.weight = evaluate(sample.wi, TransportMode::Radiance).f_cos / sample.pdf_solid_angle;
    return sample;
}

BsdfSample Scattering::sample_both_sides(float u_lobe, Vec2f u, TransportMode mode) const {
    if (const auto* diffuse = std::get_if<Diffuse>(bsdf_)) return sample_diffuse(surface_, *diffuse, u, mode);
    if (const auto* layered = under_leaning_coat()) return CoatedScattering(*layered, surface_).sample(u_lobe, u, mode);
    if (leans_) return mode == TransportMode::Importance ? sample_for_light(u_lobe, u) : sample_for_eye(u_lobe, u);
    if (!placed_wo().agrees()) return {};
    BsdfSample sample = sample_bsdf(*bsdf_, surface_.wo_local, u_lobe, u, mode);
    if (is_black(sample.weight)) return {};
    const Vec3f local = sample.wi;
    sample.wi = surface_.frame.to_world(local);
    if (!(local.z * dot(sample.wi, surface_.geometric_normal) > 0.0f)) return {};
    if (sample.is_delta) sample.reverse_ratio *= compression_ratio(sample, surface_.wo_local.z, local.z);
    return sample;
}

BsdfSample Scattering::sample_for_eye(float u_lobe, Vec2f u) const {
    const Leaning& leaning = surface_.leaning;
    const Vec3f seen_from = surface_.seen_from();
    BsdfSample sample = sample_bsdf(*bsdf_, seen_from, u_lobe, u, TransportMode::Radiance);
    if (is_black(sample.weight)) return {};
    if (is_straight(sample)) {
        sample.wi = -surface_.wo;
        return sample;
    }
    const Vec3f local = sample.wi;
    const Vec3f kept = leaning.kept_on_side(local);
    const float side = leaning.side(kept);
    sample.wi = surface_.frame.to_world(kept);
    if (!(side * dot(sample.wi, surface_.geometric_normal) > 0.0f)) return {};
    if (sample.is_delta) {
        sample.reverse_ratio *= compression_ratio(sample, seen_from.z, local.z) *
                                Arrivals(leaning, kept, side).chance(std::abs(local.z)) *
                                Viewpoints(leaning, seen_from).chance(placed_wo().side);
        return sample;
    }
    const BsdfValue value = evaluate_placed({kept, side}, TransportMode::Radiance).sum();
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    sample.weight = value.f_cos / value.pdf_solid_angle;
    sample.pdf_solid_angle = value.pdf_solid_angle;
    return sample;
}

BsdfSample Scattering::sample_for_light(float u_lobe, Vec2f u) const {
    const Leaning& leaning = surface_.leaning;
    const Placed wo = placed_wo();
    const Arrivals arrivals(leaning, wo.w, wo.side);
    const float sum = arrivals.sum();
    const bool takes_direct = !(u_lobe * sum > arrivals.direct_cosine) || arrivals.mirrored_cosine == 0.0f;
    Vec3f from = takes_direct ? arrivals.direct : arrivals.mirrored;
    float chance = 1.0f;
    if (sum == 0.0f) {
        // Only what goes straight on passes.
        from = surface_.seen_from();
    } else if (arrivals.mirrored_cosine > 0.0f) {
        const float first = takes_direct ? 0.0f : arrivals.direct_cosine;
        const float cosine = takes_direct ? arrivals.direct_cosine : arrivals.mirrored_cosine;
        chance = arrivals.chance(cosine);
        u_lobe = std::clamp((u_lobe * sum - first) / cosine, 0.0f, kOneMinusEpsilon);
    }
    BsdfSample sample = sample_bsdf(*bsdf_, from, u_lobe, u, TransportMode::Importance);
    if (is_black(sample.weight)) return {};
    if (is_straight(sample)) {
        if (!takes_direct) return {};
        sample.wi = -surface_.wo;
        sample.weight *= 1.0f / chance;
        return sample;
    }
    if (sum == 0.0f) return {};
    const Vec3f seen = sample.wi;
    const Viewpoints views(leaning, seen);
    if (!(views.sum() > 0.0f)) return {};
    const bool goes_direct = number_besides(u_lobe, u) * views.sum() < std::abs(views.direct_side);
    const Placed eye =
        goes_direct ? Placed{views.direct, views.direct_side} : Placed{views.mirrored, views.mirrored_side};
    sample.wi = surface_.frame.to_world(eye.w);
    if (!(eye.side * dot(sample.wi, surface_.geometric_normal) > 0.0f)) return {};
    if (sample.is_delta) {
        sample.weight *= sum * views.sum() / std::max(std::abs(seen.z * wo.side), 1e-12f);
        sample.reverse_ratio *= compression_ratio(sample, from.z, seen.z) / (chance * views.chance(eye.side));
        return sample;
    }
    const BsdfValue value = evaluate_for_light(wo, eye).sum();
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    sample.weight = value.f_cos / value.pdf_solid_angle;
    sample.pdf_solid_angle = value.pdf_solid_angle;
    return sample;
}

DeltaList Scattering::deltas() const {
    if (const auto* layered = under_leaning_coat()) return CoatedScattering(*layered, surface_).deltas();
    DeltaList placed_deltas;
    const Vec3f seen_from = leans_ ? surface_.seen_from() : surface_.wo_local;
    if (!leans_ && !placed_wo().agrees()) return placed_deltas;
    for (BsdfSample delta : deltas_of(*bsdf_, seen_from)) {
        const Vec3f kept = leans_ ? surface_.leaning.kept_on_side(delta.wi) : delta.wi;
        delta.wi = is_straight(delta) ? -surface_.wo : surface_.frame.to_world(kept);
        if (is_straight(delta) || kept.z * dot(delta.wi, surface_.geometric_normal) > 0.0f) placed_deltas.add(delta);
    }
    return placed_deltas;
}

}  // namespace etendue
