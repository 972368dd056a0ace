// The two texels of a row or a column between which a coordinate lies.
#pragma once

#include "core/lane.h"
#include "texture/texture_options.h"

#include <limits>

namespace etendue {

/// A template of its lane type, see core/lane.h. Texels are whole numbers, which floats hold up to 2^23 texels a row;
/// no image has more than 2^16 (image/read.h).
template <typename T>
struct TexelPair {
    T first;
    T second;
    T fraction;  ///< share of the way from the first's centre to the second's, [0, 1]
};

/// How a coordinate goes on beyond [0, 1]: one of `Wrap`, lane by lane.
template <typename T>
struct WrapMode {
    MaskOf<T> clamps;
    MaskOf<T> mirrors;  ///< if it does not clamp
};

/// Returns the texels around `coordinate` in a row of `size` texels, whose centres lie at half-integers. What is not
/// finite is read as 0.
template <typename T>
[[nodiscard]] inline TexelPair<T> texel_pair(T coordinate, T size, const WrapMode<T>& wrap) {
    // Wraps repeat after two images at the latest.
    const T reduced =
        select(wrap.clamps, clamp(coordinate, T(-1.0f), T(2.0f)), coordinate - T(2.0f) * floor(coordinate * T(0.5f)));
    const auto is_finite = abs(coordinate) < T(std::numeric_limits<float>::infinity());
    const T x = select(is_finite, reduced, T(0.0f)) * size - T(0.5f);
    const T left = floor(x);
    const auto wrapped = [&](T i) {
        const T period = size + size;
        const T within = select(i < T(0.0f), i + period, select(i >= period, i - period, i));
        const T beyond = select(wrap.mirrors, period - T(1.0f) - within, within - size);
        return select(wrap.clamps, clamp(i, T(0.0f), size - T(1.0f)), select(within < size, within, beyond));
    };
    return {wrapped(left), wrapped(left + T(1.0f)), x - left};
}

}  // namespace etendue
