// Sine and cosine of fractions of a turn, as warps need them: without range reduction, branches or library calls, so
// that they inline and vectorise.
#pragma once

#include "core/vec.h"

#include <cmath>

namespace etendue {

struct SinCos {
    float sin;
    float cos;
};

/// Of an angle in [-pi/4, pi/4] radians; error below 1e-7 (Taylor series, the next term is 2e-9).
[[nodiscard]] inline SinCos sin_cos_octant(float x) {
    const float x2 = x * x;
    const float s = x * (1.0f + x2 * (-1.0f / 6.0f + x2 * (1.0f / 120.0f + x2 * (-1.0f / 5040.0f + x2 / 362880.0f))));
    const float c = 1.0f + x2 * (-0.5f + x2 * (1.0f / 24.0f + x2 * (-1.0f / 720.0f + x2 / 40320.0f)));
    return {s, c};
}

/// Of `turns` · 2 pi radians, `turns` in [0, 1].
[[nodiscard]] inline SinCos sin_cos_turns(float turns) {
    const float quarters = turns * 4.0f;
    const int nearest = static_cast<int>(std::floor(quarters + 0.5f));
    const SinCos octant = sin_cos_octant((quarters - static_cast<float>(nearest)) * (kPi / 2.0f));
    const bool swap = (nearest & 1) != 0;
    const float s = swap ? octant.cos : octant.sin;
    const float c = swap ? octant.sin : octant.cos;
    return {(nearest & 2) != 0 ? -s : s, ((nearest + 1) & 2) != 0 ? -c : c};
}

}  // namespace etendue
