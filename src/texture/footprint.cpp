#include "texture/footprint.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// Sum of the squared axes, in texels, beyond which a footprint covers any image; also keeps the squares finite.
constexpr float kCoversAll = 1e12f;
constexpr float kBeyondCoarsest = 64.0f;

}  // namespace

// With the diameters p and q as columns of M, the axes are the singular values of M: their squares sum to
// |p|² + |q|², their product is |det M|, and the long axis lies along the eigenvector of M Mᵀ for the larger square.
FilterTaps plan_taps(const TextureFootprint& footprint, int width, int height) {
    const Vec2f size(static_cast<float>(width), static_cast<float>(height));
    const Vec2f p = footprint.diameter[0] * size;
    const Vec2f q = footprint.diameter[1] * size;
    const float m00 = p.x * p.x + q.x * q.x;
    const float m11 = p.y * p.y + q.y * q.y;
    const float sum = m00 + m11;
    FilterTaps taps;
    if (sum <= 1.0f) return taps;
    taps.minified = true;
    // Not a number either.
    if (!(sum < kCoversAll)) {
        taps.level = kBeyondCoarsest;
        return taps;
    }
    const float product = std::abs(p.x * q.y - p.y * q.x);
    const float root = std::sqrt(std::max(0.0f, sum * sum - 4.0f * product * product));
    const float major_squared = 0.5f * (sum + root);
    const float major = std::sqrt(major_squared);
    if (!(major > 1.0f)) return {};
    const float minor = std::max(1.0f, product / major);
    taps.count = std::clamp(static_cast<int>(major / minor + 0.5f), 1, kMaxTaps);
    taps.level = std::log2(std::max(minor, major / static_cast<float>(taps.count)));
    if (taps.count == 1) return taps;

    const float m01 = p.x * p.y + q.x * q.y;
    // The longer of the two rows' orthogonal vectors; both are eigenvectors.
    const Vec2f along = m00 > m11 ? Vec2f(major_squared - m11, m01) : Vec2f(m01, major_squared - m00);
    const float scale = major / (std::sqrt(along.x * along.x + along.y * along.y) * static_cast<float>(taps.count));
    taps.step = along * scale / size;
    return taps;
}

}  // namespace etendue
