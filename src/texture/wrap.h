// Texture coordinates beyond [0, 1].
#pragma once

#include "texture/texture_options.h"

#include <algorithm>
#include <cmath>

namespace etendue {

/// The texel that stands for texel `i` of a row of `size`, which must be no more than 2^30 from the image.
[[nodiscard]] inline int wrap_index(int i, int size, Wrap wrap) {
    if (i >= 0 && i < size) return i;
    switch (wrap) {
        case Wrap::Clamp:
            return std::clamp(i, 0, size - 1);
        case Wrap::Repeat: {
            // Coordinates are reduced to less than two images beforehand, and a division takes longer than the rest.
            if (i >= size && i < 2 * size) return i - size;
            const int remainder = i % size;
            return remainder < 0 ? remainder + size : remainder;
        }
        case Wrap::Mirror: {
            const int period = 2 * size;
            int remainder = i % period;
            if (remainder < 0) remainder += period;
            return remainder < size ? remainder : period - 1 - remainder;
        }
    }
    return 0;
}

/// A coordinate within [-1, 2] that reads the same as `u`: wraps repeat after two images at the latest. 0 if `u` is not
/// finite.
[[nodiscard]] inline float reduce_coordinate(float u, Wrap wrap) {
    if (!std::isfinite(u)) return 0.0f;
    return wrap == Wrap::Clamp ? std::clamp(u, -1.0f, 2.0f) : u - 2.0f * std::floor(u * 0.5f);
}

}  // namespace etendue
