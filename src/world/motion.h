// Things that move: where they are at a time of the shutter, 0 at its opening and 1 at its closing. Between two steps
// everything goes in straight lines, as Embree has it: what is shaded lies where the ray has hit it.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace etendue {

/// Is the middle of the shutter, which opens at 0 and closes at 1. Places of stored lights, and queries that have no
/// time of their own, are of this time.
inline constexpr float kMidShutter = 0.5f;

/// Between which two of some equally spaced steps a time lies.
struct MotionSegment {
    std::size_t first = 0;  ///< the other step is the next
    float t = 0.0f;         ///< share of the way between them, [0, 1]
};

/// `steps` is at least 2.
[[nodiscard]] inline MotionSegment motion_segment(std::size_t steps, float time) {
    const float scaled = std::clamp(time, 0.0f, 1.0f) * static_cast<float>(steps - 1);
    const std::size_t first = std::min(static_cast<std::size_t>(scaled), steps - 2);
    return {first, scaled - static_cast<float>(first)};
}

/// The transform at `time`; `steps` has at least two.
[[nodiscard]] inline Mat4f transform_at(std::span<const Mat4f> steps, float time) {
    const MotionSegment segment = motion_segment(steps.size(), time);
    return steps[segment.first] * (1.0f - segment.t) + steps[segment.first + 1] * segment.t;
}

}  // namespace etendue
