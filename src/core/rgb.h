// A colour triple: linear, in the working space unless a name says otherwise.
#pragma once

#include <algorithm>
#include <cmath>

namespace etendue {

struct Rgb {
    float r = 0.0f;
    float g = 0.0f;
    float b = 0.0f;

    constexpr Rgb() = default;
    constexpr explicit Rgb(float v) : r(v), g(v), b(v) {}
    constexpr Rgb(float red, float green, float blue) : r(red), g(green), b(blue) {}

    constexpr Rgb& operator+=(const Rgb& o) { return *this = {r + o.r, g + o.g, b + o.b}; }
    constexpr Rgb& operator-=(const Rgb& o) { return *this = {r - o.r, g - o.g, b - o.b}; }
    constexpr Rgb& operator*=(const Rgb& o) { return *this = {r * o.r, g * o.g, b * o.b}; }
    constexpr Rgb& operator*=(float s) { return *this = {r * s, g * s, b * s}; }

    friend constexpr bool operator==(const Rgb&, const Rgb&) = default;
};

[[nodiscard]] constexpr Rgb operator+(Rgb a, const Rgb& b) {
    return a += b;
}
[[nodiscard]] constexpr Rgb operator-(Rgb a, const Rgb& b) {
    return a -= b;
}
[[nodiscard]] constexpr Rgb operator*(Rgb a, const Rgb& b) {
    return a *= b;
}
[[nodiscard]] constexpr Rgb operator*(Rgb a, float s) {
    return a *= s;
}
[[nodiscard]] constexpr Rgb operator*(float s, Rgb a) {
    return a *= s;
}
[[nodiscard]] constexpr Rgb operator/(const Rgb& a, const Rgb& b) {
    return {a.r / b.r, a.g / b.g, a.b / b.b};
}
[[nodiscard]] constexpr Rgb operator/(const Rgb& a, float s) {
    return a * (1.0f / s);
}

[[nodiscard]] constexpr float max_component(const Rgb& c) {
    return std::max(c.r, std::max(c.g, c.b));
}
[[nodiscard]] constexpr float min_component(const Rgb& c) {
    return std::min(c.r, std::min(c.g, c.b));
}

/// Mean of the three channels: a weight for choosing between lobes and lights that needs no colour space.
[[nodiscard]] constexpr float average(const Rgb& c) {
    return (c.r + c.g + c.b) * (1.0f / 3.0f);
}

[[nodiscard]] constexpr bool is_black(const Rgb& c) {
    return c.r == 0.0f && c.g == 0.0f && c.b == 0.0f;
}

[[nodiscard]] inline bool is_finite(const Rgb& c) {
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

/// Negative channels, which colours outside of a working space's gamut have there, become zero.
[[nodiscard]] constexpr Rgb clamp_negative(const Rgb& c) {
    return {std::max(0.0f, c.r), std::max(0.0f, c.g), std::max(0.0f, c.b)};
}

/// Each channel in [0, 1]; what is no number is 0.
[[nodiscard]] constexpr Rgb clamp_unit(const Rgb& c) {
    const auto channel = [](float v) { return v > 0.0f ? std::min(v, 1.0f) : 0.0f; };
    return {channel(c.r), channel(c.g), channel(c.b)};
}

[[nodiscard]] constexpr Rgb lerp(const Rgb& a, const Rgb& b, float t) {
    return a * (1.0f - t) + b * t;
}

}  // namespace etendue
