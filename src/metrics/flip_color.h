// The colour spaces of FLIP and the difference of two colours in them. For flip.cpp and its tests.
//
// These are steps of the "color pipeline" of Andersson et al. 2020, in its names and constants.
#pragma once

#include "core/rgb.h"

#include <cmath>

namespace etendue {

/// Exponent that compresses large colour differences, q_c.
inline constexpr float kFlipColorExponent = 0.7f;
/// Share of the largest difference, p_c, that is mapped to the share p_t of the range of errors.
inline constexpr float kFlipLargeDifference = 0.4f;
inline constexpr float kFlipLargeError = 0.95f;

/// CIE XYZ over that of the white.
struct RelativeXyz {
    float x = 0.0f;
    float y = 0.0f;
    float z = 0.0f;
};

/// XYZ of the white, linear Rec.709 (1, 1, 1).
inline constexpr RelativeXyz kFlipWhite{0.950428545f, 1.0f, 1.088900371f};

/// The opponent space Y Cx Cz of the spatial filters, without its scales and offset: they cancel when the space is left
/// again, since all that is done in it is filtering with weights that sum to 1.
struct Opponent {
    float y = 0.0f;   ///< (Y + 16) / 116, luminance: 0 for black, 1 for white
    float cx = 0.0f;  ///< Cx / 500, red against green
    float cz = 0.0f;  ///< Cz / 200, yellow against blue
};

/// CIE L*a*b* with chroma that shrinks with lightness, after Hunt.
struct HuntLab {
    float l = 0.0f;  ///< L* in [0, 100]
    float a = 0.0f;  ///< 0.01 L* a*
    float b = 0.0f;  ///< 0.01 L* b*
};

[[nodiscard]] constexpr RelativeXyz relative_xyz(const Rgb& linear) {
    constexpr float kX = 1.0f / 24577794.0f / kFlipWhite.x;
    constexpr float kY = 1.0f / 12288897.0f;
    constexpr float kZ = 1.0f / 73733382.0f / kFlipWhite.z;
    return {kX * (10135552.0f * linear.r + 8788810.0f * linear.g + 4435075.0f * linear.b),
            kY * (2613072.0f * linear.r + 8788810.0f * linear.g + 887015.0f * linear.b),
            kZ * (1425312.0f * linear.r + 8788810.0f * linear.g + 70074185.0f * linear.b)};
}

[[nodiscard]] constexpr Opponent opponent_of(const Rgb& linear) {
    const RelativeXyz c = relative_xyz(linear);
    return {c.y, c.x - c.y, c.y - c.z};
}

[[nodiscard]] constexpr Rgb linear_of(const Opponent& c) {
    const float x = kFlipWhite.x * (c.y + c.cx);
    const float y = c.y;
    const float z = kFlipWhite.z * (c.y - c.cz);
    return {3.241003275f * x - 1.537398934f * y - 0.498615861f * z,
            -0.969224334f * x + 1.875930071f * y + 0.041554224f * z,
            0.055639423f * x - 0.204011202f * y + 1.057148933f * z};
}

/// Converts a linear colour in [0, 1] to CIELAB with Hunt's adjustment: chroma times 0.01 of the lightness.
[[nodiscard]] inline HuntLab hunt_lab(const Rgb& linear) {
    // CIE 15:2004, equations 8.3 to 8.8.
    constexpr float kDelta = 6.0f / 29.0f;
    const auto f = [](float t) {
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
    };
    const RelativeXyz c = relative_xyz(linear);
    const float fy = f(c.y);
    const float l = 116.0f * fy - 16.0f;
    return {l, 0.01f * l * 500.0f * (f(c.x) - fy), 0.01f * l * 200.0f * (fy - f(c.z))};
}

/// The HyAB distance (Abasi et al. 2020): city-block in lightness, Euclidean in chroma.
[[nodiscard]] inline float hyab(const HuntLab& p, const HuntLab& q) {
    return std::abs(p.l - q.l) + std::sqrt((p.a - q.a) * (p.a - q.a) + (p.b - q.b) * (p.b - q.b));
}

/// From distances of colours to errors in [0, 1]: the power q_c, then a bent line through (p_c c_max, p_t) to (c_max,
/// 1).
class ColorError {
  public:
    ColorError()
        : largest_(std::pow(hyab(hunt_lab({0.0f, 1.0f, 0.0f}), hunt_lab({0.0f, 0.0f, 1.0f})), kFlipColorExponent)),
          knee_(kFlipLargeDifference * largest_) {}

    /// c_max: the compressed distance of green and blue, than which no two colours of the display are farther apart.
    [[nodiscard]] float largest() const { return largest_; }

    [[nodiscard]] float operator()(const HuntLab& p, const HuntLab& q) const {
        const float distance = hyab(p, q);
        if (distance == 0.0f) return 0.0f;
        const float compressed = std::pow(distance, kFlipColorExponent);
        if (compressed < knee_) return kFlipLargeError / knee_ * compressed;
        return kFlipLargeError + (compressed - knee_) / (largest_ - knee_) * (1.0f - kFlipLargeError);
    }

  private:
    float largest_;
    float knee_;
};

}  // namespace etendue
