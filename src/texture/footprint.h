// The part of a texture that one look-up stands for, and the few taps that stand for that part.
#pragma once

#include "core/lane.h"
#include "core/vec.h"

namespace etendue {

/// An ellipse around the looked-up point, by two conjugate diameters in texture coordinates. All zero is a point.
struct TextureFootprint {
    Vec2f diameter[2]{{0.0f, 0.0f}, {0.0f, 0.0f}};

    [[nodiscard]] bool is_point() const { return diameter[0] == Vec2f(0.0f, 0.0f) && diameter[1] == Vec2f(0.0f, 0.0f); }
};

/// Where a footprint is read: `count` taps, tap i at uv + step * (i - (count - 1) / 2), each in the mip level `level`.
/// A template of its lane type, see core/lane.h.
template <typename T>
struct FilterTaps {
    T count{1.0f};                          ///< a whole number
    Imath::Vec2<T> step{T(0.0f), T(0.0f)};  ///< texture coordinates
    T level{0.0f};                          ///< 0 is the image; may lie beyond the coarsest
    MaskOf<T> minified{T(0.0f) >
                       T(0.0f)};  ///< false where the footprint is no longer than a texel: one tap in the image
};

/// Most taps along the long axis. Ellipses that are longer than this many times their width are widened.
inline constexpr float kMaxTaps = 8.0f;

/// Taps for the ellipse with diameters `d0` and `d1` in an image of `size` texels: spread evenly along the long axis,
/// in the level whose texels are as large as the short one (McCormack et al., "Feline: Fast Elliptical Lines for
/// Anisotropic Texture Mapping", SIGGRAPH 1999, with equal weights).
//
// With the diameters p and q in texels as columns of M, the axes are the singular values of M: their squares sum to
// |p|² + |q|², their product is |det M|, and the long axis lies along the eigenvector of M Mᵀ for the larger square.
template <typename T>
[[nodiscard]] inline FilterTaps<T> plan_taps(const Imath::Vec2<T>& d0, const Imath::Vec2<T>& d1,
                                             const Imath::Vec2<T>& size) {
    // Sum of the squared axes, in texels, beyond which a footprint covers any image; also keeps the squares finite.
    constexpr float kCoversAll = 1e12f;
    constexpr float kBeyondCoarsest = 64.0f;
    const Imath::Vec2<T> p(d0.x * size.x, d0.y * size.y);
    const Imath::Vec2<T> q(d1.x * size.x, d1.y * size.y);
    const T m00 = p.x * p.x + q.x * q.x;
    const T m11 = p.y * p.y + q.y * q.y;
    const T sum = m00 + m11;
    FilterTaps<T> taps;
    if constexpr (kIsSingle<T>)
        if (sum <= 1.0f) return taps;
    const T product = abs(p.x * q.y - p.y * q.x);
    const T root = sqrt(max(T(0.0f), sum * sum - T(4.0f) * product * product));
    const T major_squared = T(0.5f) * (sum + root);
    const T major = sqrt(major_squared);
    const auto is_finite = sum < T(kCoversAll);  // not if it is no number either
    const auto is_long = is_finite && sum > T(1.0f) && major > T(1.0f);
    const T minor = max(T(1.0f), product / major);
    const T count = clamp(floor(major / minor + T(0.5f)), T(1.0f), T(kMaxTaps));
    taps.count = select(is_long, count, T(1.0f));
    taps.level = select(is_long, log2(max(minor, major / count)), select(is_finite, T(0.0f), T(kBeyondCoarsest)));
    taps.minified = is_long || !is_finite;

    const T m01 = p.x * p.y + q.x * q.y;
    // The longer of the two rows' orthogonal vectors; both are eigenvectors.
    const auto by_column = m00 > m11;
    const T along_x = select(by_column, major_squared - m11, m01);
    const T along_y = select(by_column, m01, major_squared - m00);
    const T scale = major / (sqrt(along_x * along_x + along_y * along_y) * count);
    const auto has_step = taps.count > T(1.0f);
    taps.step = {select(has_step, along_x * scale / size.x, T(0.0f)),
                 select(has_step, along_y * scale / size.y, T(0.0f))};
    return taps;
}

}  // namespace etendue
