#include "bsdf/ggx_anisotropic_albedo.h"

#include "bsdf/ggx_anisotropic_albedo_layout.h"

namespace etendue {

namespace {

using namespace ggx_anisotropic_layout;

// kSingle, kSchlickShare: Table; kSingleAverage, kSchlickAverage: Averages.
#include "bsdf/ggx_anisotropic_albedo_tables.inc"

}  // namespace

GgxAlbedo ggx_anisotropic_albedo(const Vec3f& w, float alpha_x, float alpha_y) {
    const bool wide_x = alpha_x >= alpha_y;
    const Position p = wide_x ? position(alpha_x, alpha_y, w.x, w.y, w.z) : position(alpha_y, alpha_x, w.y, w.x, w.z);
    const float single = interpolate(kSingle, p, p.cosine);
    return {single, single * interpolate(kSchlickShare, p, p.share_cosine)};
}

GgxAlbedo ggx_anisotropic_albedo_average(float alpha_x, float alpha_y) {
    const float wide = std::max(alpha_x, alpha_y);
    const float narrow = std::min(alpha_x, alpha_y);
    const Place n = place(std::sqrt(narrow) * (kNarrows - 1), kNarrows);
    const Place s = place(strength_coordinate(narrow, wide), kStrengths);
    return {interpolate(kSingleAverage, n, s), interpolate(kSchlickAverage, n, s)};
}

}  // namespace etendue
