#include "light/beam.h"

#include <algorithm>

namespace etendue {

float spot_falloff(float cos_angle, float cos_inner, float cos_outer) {
    // Equal cones, also those that only single precision makes equal, are a hard edge; the ramp is never over nothing.
    if (cos_angle >= cos_inner) return 1.0f;
    if (cos_angle <= cos_outer) return 0.0f;
    const float ramp = (cos_angle - cos_outer) / (cos_inner - cos_outer);
    return ramp * ramp;
}

float spot_solid_angle(float cos_inner, float cos_outer) {
    // The squared ramp integrates to a third of the solid angle between the cones.
    return 2.0f * kPi * (1.0f - cos_inner + (cos_inner - cos_outer) / 3.0f);
}

Beam::Beam(Kind kind, float half_angle)
    : kind_(kind),
      half_angle_(half_angle),
      // A cone that single precision closes still has a density.
      cos_outer_(std::clamp(std::cos(half_angle), 0.0f, kOneMinusEpsilon)),
      sin_outer_(std::sqrt((1.0f - cos_outer_) * (1.0f + cos_outer_))) {}

Beam Beam::panel(float spread) {
    // Beyond, tangents are too large to differ from the diffuse surface's.
    constexpr float kDiffuse = 0.9999f * kPi;
    if (spread >= kDiffuse) return {};
    Beam beam(Kind::Panel, 0.5f * spread);
    const double half = 0.5 * static_cast<double>(spread);
    beam.tan_outer_ = static_cast<float>(std::tan(half));
    beam.scale_ = static_cast<float>(1.0 / (std::tan(half) - half));
    return beam;
}

Beam Beam::spot(float inner, float outer) {
    Beam beam(Kind::Spot, outer);
    beam.cos_inner_ = std::max(std::cos(inner), beam.cos_outer_);
    beam.mean_factor_ = spot_solid_angle(beam.cos_inner_, beam.cos_outer_) * kInvPi;
    return beam;
}

float Beam::shaped_factor(float cosine) const {
    if (kind_ == Kind::Spot) return spot_falloff(cosine, cos_inner_, cos_outer_) / cosine;
    const float sine = std::sqrt(std::max(0.0f, (1.0f - cosine) * (1.0f + cosine)));
    return std::max(0.0f, tan_outer_ - sine / cosine) * scale_;
}

}  // namespace etendue
