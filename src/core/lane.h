// What templates of a lane type need of it, for float; `Wide` (core/wide.h) brings its own. Such a template is written
// as for one number, with `select` where a branch would be, and computes many at once if its lanes are wide: one
// source serves both. It calls min, max, abs, sqrt and copysign without a namespace.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace etendue {

using std::abs;
using std::copysign;
using std::max;
using std::min;
using std::sqrt;

/// `condition ? if_true : if_false`, lane by lane; both are evaluated.
[[nodiscard]] constexpr float select(bool condition, float if_true, float if_false) {
    return condition ? if_true : if_false;
}

/// What comparisons of lanes give: bool for float.
template <typename T>
using MaskOf = decltype(std::declval<T>() < std::declval<T>());

}  // namespace etendue
