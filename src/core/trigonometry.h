// Sine and cosine of fractions of a turn, as warps need them: without range reduction, branches or library calls, so
// that they inline and vectorise.
#pragma once

#include "core/vec.h"

namespace etendue {

/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicSinCos {
    T sin;
    T cos;
};
using SinCos = BasicSinCos<float>;

/// Returns the sine and the cosine of an angle of `x` radians in [-pi/4, pi/4]; error below 1e-7 (Taylor series, the
/// next term is 2e-9).
template <typename T>
[[nodiscard]] inline BasicSinCos<T> sin_cos_octant(T x) {
    const T x2 = x * x;
    const T s =
        x * (1.0f + x2 * (-1.0f / 6.0f + x2 * (1.0f / 120.0f + x2 * (-1.0f / 5040.0f + x2 * (1.0f / 362880.0f)))));
    const T c = 1.0f + x2 * (-0.5f + x2 * (1.0f / 24.0f + x2 * (-1.0f / 720.0f + x2 * (1.0f / 40320.0f))));
    return {s, c};
}

/// Returns the sine and the cosine of `turns` · 2 pi radians, `turns` in [0, 1].
template <typename T>
[[nodiscard]] inline BasicSinCos<T> sin_cos_turns(T turns) {
    const T quarters = turns * 4.0f;
    const T nearest = floor(quarters + 0.5f);
    const BasicSinCos<T> octant = sin_cos_octant((quarters - nearest) * (kPi / 2.0f));
    const auto first = nearest == T(1.0f);
    const auto second = nearest == T(2.0f);
    const auto third = nearest == T(3.0f);
    const auto swap = first || third;
    const T s = select(swap, octant.cos, octant.sin);
    const T c = select(swap, octant.sin, octant.cos);
    return {select(second || third, -s, s), select(first || second, -c, c)};
}

}  // namespace etendue
