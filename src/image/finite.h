// Values of images that are no numbers.
#pragma once

#include "core/error.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

namespace etendue {

/// The largest number of half precision.
inline constexpr float kLargestHalf = 65504.0f;

/// A value as it was meant: half precision makes an infinity of what is too bright for it. What is no number is 0.
[[nodiscard]] inline float finite_value(float value) {
    if (std::isfinite(value)) return value;
    return value == std::numeric_limits<float>::infinity() ? kLargestHalf : 0.0f;
}

/// How many values of an image were put right.
struct RepairedValues {
    std::size_t infinite = 0;
    std::size_t no_number = 0;
};

/// Gives each of `values` its `finite_value`.
template <typename T>
RepairedValues make_finite(std::span<T> values) {
    RepairedValues repaired;
    for (T& value : values) {
        const auto found = static_cast<float>(value);
        if (std::isfinite(found)) continue;
        const float meant = finite_value(found);
        ++(meant > 0.0f ? repaired.infinite : repaired.no_number);
        value = T(meant);
    }
    return repaired;
}

/// Warns at `where` of what was put right in the image that the reader knows as `name`.
void warn_of_repairs(const RepairedValues& repaired, const std::string& name, const SourceLocation& where,
                     ProblemList& problems);

}  // namespace etendue
