// Expressions that most renders ask for, by name.
#pragma once

#include <span>
#include <string_view>

namespace etendue {

struct UsualExpression {
    std::string_view name;
    std::string_view expression;
    std::string_view summary;
};

/// Returns the usual expressions that take each path exactly once, so that their layers add up to the image.
[[nodiscard]] std::span<const UsualExpression> partition_expressions();
/// Returns all usual expressions, those of `partition_expressions` first.
[[nodiscard]] std::span<const UsualExpression> usual_expressions();

}  // namespace etendue
