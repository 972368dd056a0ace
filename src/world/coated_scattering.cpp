#include "world/coated_scattering.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// Returns the surface without its coat.
Bsdf below_coat(const LayeredSurface& layered) {
    if (layered.sheen.exists()) return LayeredSurface::make(layered.base, layered.sheen, {});
    return std::get<MetallicRoughness>(layered.base);
}

}  // namespace

CoatedScattering::CoatedScattering(const LayeredSurface& layered, const OrientedSurface<float>& surface)
    : layered_(layered),
      coat_normal_(surface.frame.to_world(layered.coat.normal)),
      coat_lobe_(ClearCoat{.strength = layered.coat.strength, .alpha = layered.coat.alpha}),
      lobe_below_(below_coat(layered)),
      passed_average_(layered.passed_average),
      passed_average_plain_(layered.passed_average_plain),
      coat_(coat_lobe_, Frame::from_normal(coat_normal_), surface.geometric_normal, surface.wo),
      below_(lobe_below_, surface),
      passed_o_(passed(surface.wo)) {
    if (const auto* with_sheen = std::get_if<LayeredSurface>(&lobe_below_)) {
        passed_average_ /= with_sheen->passed_average;
        passed_average_plain_ /= with_sheen->passed_average_plain;
    }
}

BsdfParts CoatedScattering::evaluate_parts(const Vec3f& wi, TransportMode mode) const {
    BsdfParts parts = below_.evaluate_parts(wi, mode);
    const float passed_i = passed(wi);
    parts.diffuse *= passed_o_ * passed_i / passed_average_;
    parts.specular *=
        std::lerp(std::min(passed_o_, passed_i), passed_o_ * passed_i / passed_average_plain_, layered_.diffuseness);
    parts.pdf_solid_angle *= passed_o_;
    if (coat_.is_transmission(wi)) return parts;
    const BsdfValue coat = coat_.evaluate(wi, mode);
    parts.specular += coat.f_cos;
    parts.pdf_solid_angle += coat.pdf_solid_angle * (1.0f - passed_o_);
    return parts;
}

float CoatedScattering::reverse_pdf_solid_angle(const Vec3f& wi, TransportMode mode) const {
    const float passed_i = passed(wi);
    const float below = below_.reverse_pdf_solid_angle(wi, mode) * passed_i;
    return coat_.is_transmission(wi) ? below : below + coat_.reverse_pdf_solid_angle(wi, mode) * (1.0f - passed_i);
}

BsdfSample CoatedScattering::sample(float u_lobe, Vec2f u, TransportMode mode) const {
    const float coat_chance = 1.0f - passed_o_;
    const bool takes_coat = u_lobe < coat_chance;
    BsdfSample sample =
        takes_coat ? coat_.sample(u_lobe / coat_chance, u, mode)
                   : below_.sample(std::clamp((u_lobe - coat_chance) / passed_o_, 0.0f, kOneMinusEpsilon), u, mode);
    if (is_black(sample.weight)) return {};
    if (sample.is_delta) {
        const float passed_i = passed(sample.wi);
        sample.weight *= takes_coat ? 1.0f / coat_chance : std::min(passed_o_, passed_i) / passed_o_;
        sample.reverse_ratio *= takes_coat ? (1.0f - passed_i) / coat_chance : passed_i / passed_o_;
        return sample;
    }
    const BsdfValue value = evaluate_parts(sample.wi, mode).sum();
    if (!(value.pdf_solid_angle > 0.0f)) return {};
    sample.weight = value.f_cos / value.pdf_solid_angle;
    sample.pdf_solid_angle = value.pdf_solid_angle;
    return sample;
}

DeltaList CoatedScattering::deltas() const {
    DeltaList all = coat_.deltas();
    for (BsdfSample delta : below_.deltas()) {
        delta.weight *= std::min(passed_o_, passed(delta.wi));
        all.add(delta);
    }
    return all;
}

}  // namespace etendue
