// Which pixels the filter carries something to, along one axis of the film. For this room only.
#pragma once

#include <algorithm>
#include <cmath>

namespace etendue {

/// Pixels [begin, end) within [low, high) whose centres lie from `position` - `radius` on, and before `position` +
/// `radius`, so that boxes share no point. `position` must not be far beyond what an int holds.
struct Reach {
    int begin;
    int end;

    Reach(float position, float radius, int low, int high)
        : begin(std::max(low, static_cast<int>(std::ceil(position - 0.5f - radius)))),
          end(std::min(high, static_cast<int>(std::ceil(position - 0.5f + radius)))) {}
};

}  // namespace etendue
