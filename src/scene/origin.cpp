// Scenes that lie far from the world's origin.

#include "scene/scene_desc.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// Sizes away within which rounding to single precision moves nothing by 1 / 200,000 of a size.
constexpr double kNear = 64.0;
/// No more is known of a size, which may be none.
constexpr double kLeastSize = 0x1p-24;

double largest_part(const Vec3d& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

Vec3d choose_origin(const Bounds& bounds) {
    if (bounds.empty()) return Vec3d(0.0);
    const Vec3d low(bounds.min);
    const Vec3d high(bounds.max);
    const Vec3d centre = (low + high) * 0.5;
    const double distance = largest_part(centre);
    const double size = std::max(largest_part(high - low), kLeastSize * distance);
    if (!std::isfinite(size) || !(distance > kNear * size)) return Vec3d(0.0);
    const double step = std::exp2(1.0 + std::ceil(std::log2(size)));
    const auto to_step = [&](double value) { return step * std::round(value / step); };
    return {to_step(centre.x), to_step(centre.y), to_step(centre.z)};
}

}  // namespace etendue
