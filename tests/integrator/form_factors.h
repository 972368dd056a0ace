// Form factors from J. R. Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", sections B.
#pragma once

#include <cmath>

namespace etendue::test {

/// From a plane element to a parallel disk of radius r at height h whose axis is a away (B-13).
[[nodiscard]] inline double disk_form_factor(double r, double h, double a) {
    const double sum = a * a + h * h + r * r;
    return 0.5 * (1.0 - (a * a + h * h - r * r) / std::sqrt(sum * sum - 4.0 * a * a * r * r));
}

}  // namespace etendue::test
