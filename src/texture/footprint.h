// The part of a texture that one look-up stands for, and the few taps that stand for that part.
#pragma once

#include "core/vec.h"

namespace etendue {

/// An ellipse around the looked-up point, by two conjugate diameters in texture coordinates. All zero is a point.
struct TextureFootprint {
    Vec2f diameter[2]{{0.0f, 0.0f}, {0.0f, 0.0f}};

    [[nodiscard]] bool is_point() const { return diameter[0] == Vec2f(0.0f, 0.0f) && diameter[1] == Vec2f(0.0f, 0.0f); }
};

/// Where a footprint is read: `count` taps, tap i at uv + step * (i - (count - 1) / 2), each in the mip level `level`.
struct FilterTaps {
    int count = 1;
    Vec2f step{0.0f, 0.0f};  ///< texture coordinates
    float level = 0.0f;      ///< 0 is the image; may lie beyond the coarsest
    bool minified = false;   ///< false where the footprint is no longer than a texel: one tap in the image
};

/// Most taps along the long axis. Ellipses that are longer than this many times their width are widened.
inline constexpr int kMaxTaps = 8;

/// Taps for `footprint` in an image of `width` × `height` texels: spread evenly along the long axis of the ellipse, in
/// the level whose texels are as large as the short axis (McCormack et al., "Feline: Fast Elliptical Lines for
/// Anisotropic Texture Mapping", SIGGRAPH 1999, with equal weights).
[[nodiscard]] FilterTaps plan_taps(const TextureFootprint& footprint, int width, int height);

}  // namespace etendue
