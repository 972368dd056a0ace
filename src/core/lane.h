// What templates of a lane type need of it, for float; `Wide` (core/wide.h) brings its own. Such a template is written
// as for one number, with `select` where a branch would be, and computes many at once if its lanes are wide: one
// source serves both. It calls what <cmath> and <algorithm> have without a namespace.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace etendue {

using std::abs;
using std::clamp;
using std::copysign;
using std::expm1;
using std::floor;
using std::log;
using std::log2;
using std::max;
using std::min;
using std::sqrt;

/// Whether lanes of this type are single numbers, for what is done with those alone.
template <typename T>
inline constexpr bool kIsSingle = std::is_same_v<T, float>;

/// `condition ? if_true : if_false`, lane by lane; both are evaluated.
[[nodiscard]] constexpr float select(bool condition, float if_true, float if_false) {
    return condition ? if_true : if_false;
}

/// Returns `if_true()` or `if_false()`, lane by lane as `condition` says, where these are costly: for single numbers
/// only the one that is asked for is evaluated.
template <typename IfTrue, typename IfFalse>
[[nodiscard]] constexpr auto choose(bool condition, const IfTrue& if_true, const IfFalse& if_false) {
    return condition ? if_true() : if_false();
}

/// True if `condition` holds in any lane.
[[nodiscard]] constexpr bool any(bool condition) {
    return condition;
}

/// `table[index]`; `index` is a whole number.
[[nodiscard]] inline float gather(const float* table, float index) {
    return table[static_cast<std::size_t>(index)];
}

/// Names the type that comparisons of lanes of type `T` give: bool for float.
template <typename T>
using MaskOf = decltype(std::declval<T>() < std::declval<T>());

}  // namespace etendue
