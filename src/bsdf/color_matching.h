// The CIE 1931 colour matching functions.
#pragma once

#include <array>

namespace etendue {

/// x, y and z of a wavelength in nanometres, by a fit that is within 0.02 of the tables (Wyman, Sloan and Shirley,
/// "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013).
[[nodiscard]] std::array<double, 3> color_matching_xyz(double nanometres);

}  // namespace etendue
