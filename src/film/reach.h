// Which pixels the filter carries something to, along one axis of the film. For this room only.
#pragma once

#include <algorithm>
#include <cmath>

namespace etendue {

/// Holds the pixels [begin, end) within [low, high) whose centres lie in (`position` - `radius`, `position` +
/// `radius`]: a position on the edge of two boxes belongs to the box that begins there. `position` must be near the
/// range of int.
struct Reach {
    int begin;
    int end;

    Reach(float position, float radius, int low, int high)
        : begin(std::max(low, static_cast<int>(std::floor(position - 0.5f - radius)) + 1)),
          end(std::min(high, static_cast<int>(std::floor(position - 0.5f + radius)) + 1)) {}
};

}  // namespace etendue
