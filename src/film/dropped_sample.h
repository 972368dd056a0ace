// A sample that was left out.
#pragma once

#include <cstdint>

namespace etendue {

/// A sample that was not a finite, non-negative number.
struct DroppedSample {
    int x = 0;  ///< pixel of the full image
    int y = 0;
    std::uint32_t sample = 0;  ///< index within the pixel
};

}  // namespace etendue
