// CIE XYZ and the primaries of glTF, Rec.709.
#pragma once

#include <array>

namespace etendue {

/// CIE XYZ to linear Rec.709, from the primaries and white point of ITU-R BT.709.
inline constexpr std::array<std::array<double, 3>, 3> kXyzToRec709{
    {{3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}}};

}  // namespace etendue
