#include "sampling/spherical_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

SphericalRectangle::SphericalRectangle(const Vec3f& corner, const Vec2f& size)
    // In double precision, as angles cancel.
    : x0_(static_cast<double>(corner.x)),
      y0_(static_cast<double>(corner.y)),
      x1_(x0_ + static_cast<double>(size.x)),
      y1_(y0_ + static_cast<double>(size.y)),
      z_squared_(static_cast<double>(corner.z) * static_cast<double>(corner.z)) {
    // The cosine of the angle between two planes through the point and an edge each is that between their normals.
    const auto inner_angle = [this](double x, double y, double sign) {
        return std::complex<double>(sign * x * y, std::sqrt(z_squared_ * (x * x + y * y + z_squared_)));
    };
    // Multiplied out, as operators of complex numbers look for infinities.
    const auto product = [](const std::complex<double>& a, const std::complex<double>& b) {
        return std::complex<double>(a.real() * b.real() - a.imag() * b.imag(),
                                    a.real() * b.imag() + a.imag() * b.real());
    };
    far_angles_ = product(inner_angle(x0_, y1_, 1.0), inner_angle(x0_, y0_, -1.0));
    const std::complex<double> all =
        product(far_angles_, product(inner_angle(x1_, y0_, 1.0), inner_angle(x1_, y1_, -1.0)));
    if (!(z_squared_ > 0.0)) return;
    // The sum of the angles, less a full turn.
    solid_angle_ = std::atan2(all.imag(), all.real());
    if (solid_angle_ >= 0.0) return;
    const bool is_before = x0_ < 0.0 && x1_ > 0.0 && y0_ < 0.0 && y1_ > 0.0;
    solid_angle_ = is_before ? solid_angle_ + 2.0 * std::numbers::pi : 0.0;
}

Vec2f SphericalRectangle::sample(Vec2f u) const {
    // The part of the rectangle up to x has the share u.x of the solid angle. `cosine` and `sine` are those of that
    // share, less the inner angles at the corners beyond.
    const double share = static_cast<double>(u.x) * solid_angle_;
    const double scale = 1.0 / std::sqrt(std::norm(far_angles_));
    const double cosine = (std::cos(share) * far_angles_.real() + std::sin(share) * far_angles_.imag()) * scale;
    const double sine = (std::sin(share) * far_angles_.real() - std::cos(share) * far_angles_.imag()) * scale;
    const double b0 = -y0_ / std::sqrt(z_squared_ + y0_ * y0_);
    const double b1 = y1_ / std::sqrt(z_squared_ + y1_ * y1_);
    const double f = (cosine * b0 - b1) / sine;
    const double beyond = std::max(0.0, f * f - z_squared_ / (z_squared_ + y0_ * y0_));
    const double x = std::clamp(std::copysign(std::sqrt(z_squared_ / beyond), f), x0_, x1_);
    // Along y, solid angle goes as the sine of the elevation over the plane of x and z.
    const double squared = x * x + z_squared_;
    const double h0 = y0_ / std::sqrt(squared + y0_ * y0_);
    const double h1 = y1_ / std::sqrt(squared + y1_ * y1_);
    const double h = h0 + static_cast<double>(u.y) * (h1 - h0);
    const double y = std::clamp(h * std::sqrt(squared / std::max(1e-300, 1.0 - h * h)), y0_, y1_);
    return {static_cast<float>((x - x0_) / (x1_ - x0_)), static_cast<float>((y - y0_) / (y1_ - y0_))};
}

}  // namespace etendue
