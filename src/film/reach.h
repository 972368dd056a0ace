// Which pixels the filter carries something to, along one axis of the film. For this room only.
#pragma once

#include <algorithm>
#include <cmath>

namespace etendue {

/// Pixels [begin, end) within [low, high) whose centres lie beyond `position` - `radius`, and up to `position` +
/// `radius`: a place on the edge of two boxes is in the one that begins there. `position` must not be far beyond what
/// an int holds.
struct Reach {
    int begin;
    int end;

    Reach(float position, float radius, int low, int high)
        : begin(std::max(low, static_cast<int>(std::floor(position - 0.5f - radius)) + 1)),
          end(std::min(high, static_cast<int>(std::floor(position - 0.5f + radius)) + 1)) {}
};

}  // namespace etendue
