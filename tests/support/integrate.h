// Adaptive integration over rectangles, for densities that may have narrow peaks and jumps.
#pragma once

#include <array>
#include <functional>

namespace etendue::test {

/// Nodes of Gauss's rule of three points on [0, 1].
inline constexpr std::array<double, 3> kGaussNodes = {0.1127016653792583, 0.5, 0.8872983346207417};

struct Rect {
    double x0 = 0.0;
    double x1 = 1.0;
    double y0 = 0.0;
    double y1 = 1.0;
};

/// The integral of `f(x, y)` over `rect`. Rectangles are quartered until the tensor Gauss rule of three points and its
/// quartered version agree within their share of `tolerance` (absolute), at most `max_depth` times. A peak much
/// narrower than a third of `rect` can be missed: split the domain around it first. So can a jump at its edge;
/// rectangles are quartered `min_depth` times in any case.
[[nodiscard]] double integrate(const std::function<double(double, double)>& f, const Rect& rect, double tolerance,
                               int max_depth = 10, int min_depth = 0);

}  // namespace etendue::test
