// A colour triple: linear, in the working space unless a name says otherwise.
#pragma once

#include "core/lane.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace etendue {

/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicRgb {
    T r{0.0f};
    T g{0.0f};
    T b{0.0f};

    constexpr BasicRgb() = default;
    constexpr explicit BasicRgb(T v) : r(v), g(v), b(v) {}
    constexpr BasicRgb(T red, T green, T blue) : r(red), g(green), b(blue) {}

    constexpr BasicRgb& operator+=(const BasicRgb& o) { return *this = {r + o.r, g + o.g, b + o.b}; }
    constexpr BasicRgb& operator-=(const BasicRgb& o) { return *this = {r - o.r, g - o.g, b - o.b}; }
    constexpr BasicRgb& operator*=(const BasicRgb& o) { return *this = {r * o.r, g * o.g, b * o.b}; }
    constexpr BasicRgb& operator*=(T s) { return *this = {r * s, g * s, b * s}; }

    [[nodiscard]] friend constexpr BasicRgb operator+(BasicRgb a, const BasicRgb& o) { return a += o; }
    [[nodiscard]] friend constexpr BasicRgb operator-(BasicRgb a, const BasicRgb& o) { return a -= o; }
    [[nodiscard]] friend constexpr BasicRgb operator*(BasicRgb a, const BasicRgb& o) { return a *= o; }
    [[nodiscard]] friend constexpr BasicRgb operator*(BasicRgb a, T s) { return a *= s; }
    [[nodiscard]] friend constexpr BasicRgb operator*(T s, BasicRgb a) { return a *= s; }
    [[nodiscard]] friend constexpr BasicRgb operator/(const BasicRgb& a, const BasicRgb& o) {
        return {a.r / o.r, a.g / o.g, a.b / o.b};
    }
    [[nodiscard]] friend constexpr BasicRgb operator/(const BasicRgb& a, T s) { return a * (T(1.0f) / s); }
};

using Rgb = BasicRgb<float>;

[[nodiscard]] constexpr bool operator==(const Rgb& a, const Rgb& b) {
    return a.r == b.r && a.g == b.g && a.b == b.b;
}

template <typename T = float>
[[nodiscard]] constexpr T max_component(const BasicRgb<T>& c) {
    return max(c.r, max(c.g, c.b));
}
[[nodiscard]] constexpr float min_component(const Rgb& c) {
    return std::min(c.r, std::min(c.g, c.b));
}

/// Mean of the three channels: a weight for choosing between lobes and lights that needs no colour space.
[[nodiscard]] constexpr float average(const Rgb& c) {
    return (c.r + c.g + c.b) * (1.0f / 3.0f);
}

template <typename T = float>
[[nodiscard]] constexpr auto is_black(const BasicRgb<T>& c) {
    return c.r == T(0.0f) && c.g == T(0.0f) && c.b == T(0.0f);
}

[[nodiscard]] inline bool is_finite(const Rgb& c) {
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

/// Negative channels, which colours outside of a working space's gamut have there, become zero.
[[nodiscard]] constexpr Rgb clamp_negative(const Rgb& c) {
    return {std::max(0.0f, c.r), std::max(0.0f, c.g), std::max(0.0f, c.b)};
}

/// Clamps each channel to [0, 1]; what is no number becomes 0.
[[nodiscard]] constexpr Rgb clamp_unit(const Rgb& c) {
    const auto channel = [](float v) { return v > 0.0f ? std::min(v, 1.0f) : 0.0f; };
    return {channel(c.r), channel(c.g), channel(c.b)};
}

template <typename T = float>
[[nodiscard]] constexpr BasicRgb<T> lerp(const BasicRgb<T>& a, const BasicRgb<T>& b, std::type_identity_t<T> t) {
    return a * (1.0f - t) + b * t;
}

/// `condition ? if_true : if_false`, lane by lane.
template <typename T = float>
[[nodiscard]] constexpr BasicRgb<T> select(MaskOf<T> condition, const BasicRgb<T>& if_true,
                                           const BasicRgb<T>& if_false) {
    return {select(condition, if_true.r, if_false.r), select(condition, if_true.g, if_false.g),
            select(condition, if_true.b, if_false.b)};
}

}  // namespace etendue
