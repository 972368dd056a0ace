#include "light/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

EmissionCone EmissionCone::united(const EmissionCone& other) const {
    constexpr double kAll = std::numbers::pi;
    const EmissionCone& wide = theta_o >= other.theta_o ? *this : other;
    const EmissionCone& narrow = theta_o >= other.theta_o ? other : *this;
    EmissionCone both = wide;
    both.theta_e = std::max(theta_e, other.theta_e);
    both.two_sided = two_sided || other.two_sided;
    const Vec3d from(wide.axis);
    Vec3d to(narrow.axis);
    if (wide.two_sided && narrow.two_sided && from.dot(to) < 0.0) to = -to;
    const double between = std::acos(std::clamp(from.dot(to), -1.0, 1.0));
    if (std::min(between + narrow.theta_o, kAll) <= wide.theta_o) return both;
    both.theta_o = 0.5 * (wide.theta_o + between + narrow.theta_o);
    const Vec3d across = to - from * from.dot(to);
    const double length = across.length();
    if (both.theta_o >= kAll || !(length > 0.0)) {
        both.theta_o = kAll;
        return both;
    }
    const double turned = both.theta_o - wide.theta_o;
    const Vec3d middle = from * std::cos(turned) + across * (std::sin(turned) / length);
    both.axis = Vec3f(middle.normalized());
    return both;
}

double EmissionCone::measure() const {
    // 2 pi times the integrals of sin w up to theta_o, and from there on of cos(w - theta_o) sin w (ibid.,
    // section 4.3).
    constexpr double kSmallest = 1e-6;
    const double end = std::min(theta_o + theta_e, std::numbers::pi);
    const double inside = 1.0 - std::cos(theta_o);
    const double beyond =
        0.25 * (std::cos(theta_o) - std::cos(2.0 * end - theta_o)) + 0.5 * (end - theta_o) * std::sin(theta_o);
    const double one_side = 2.0 * std::numbers::pi * (inside + beyond);
    return std::clamp(two_sided ? 2.0 * one_side : one_side, kSmallest, 4.0 * std::numbers::pi);
}

LightBounds LightBounds::united(const LightBounds& other) const {
    LightBounds both = *this;
    both.box.extend(other.box);
    both.cone = cone.united(other.cone);
    both.power += other.power;
    both.count += other.count;
    return both;
}

}  // namespace etendue
