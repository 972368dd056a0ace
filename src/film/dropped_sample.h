// A sample that was left out.
#pragma once

#include <cstdint>

namespace etendue {

/// A sample that was not a finite, non-negative number, or whose light path left such a splat.
struct DroppedSample {
    int x = 0;  ///< its pixel of the full image, not that of the splat
    int y = 0;
    std::uint32_t sample = 0;  ///< index within the pixel
};

}  // namespace etendue
