// The published primaries and white points of linear RGB spaces, and the matrices that follow from them.
#pragma once

#include "color/color_config.h"

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace etendue {

/// A 3 × 3 matrix in double precision, row-major, applied to column vectors.
using Matrix3d = std::array<double, 9>;

[[nodiscard]] Matrix3d operator*(const Matrix3d& a, const Matrix3d& b);
[[nodiscard]] std::array<double, 3> operator*(const Matrix3d& m, const std::array<double, 3>& v);
/// Inverse of a regular matrix.
[[nodiscard]] Matrix3d inverse(const Matrix3d& m);

/// RGB to CIE XYZ such that RGB (1, 1, 1) has the white's chromaticity and Y = 1 (SMPTE RP 177-1993).
[[nodiscard]] Matrix3d rgb_to_xyz(const Chromaticities& space);

/// XYZ under the white point `from` to XYZ under `to` (CIE xy) by the linear Bradford transform (Lam 1985; ICC.1:2010
/// annex E), which ACES uses.
[[nodiscard]] Matrix3d bradford_adaptation(const std::array<float, 2>& from, const std::array<float, 2>& to);

/// Returns the matrix from one RGB space to another, whites adapted by Bradford.
[[nodiscard]] Matrix3d rgb_to_rgb(const Chromaticities& from, const Chromaticities& to);

/// Returns x and y of red, green, blue and white, as OpenEXR lists them.
[[nodiscard]] std::vector<float> numbers_of(const Chromaticities& space);

/// A space whose primaries somebody has published.
struct PublishedPrimaries {
    std::string_view name;
    Chromaticities chromaticities;
};

/// CIE standard illuminant D65 as the standards for displays round it.
inline constexpr std::array<float, 2> kD65{0.3127f, 0.3290f};

inline constexpr Chromaticities kAp0{{0.7347f, 0.2653f}, {0.0f, 1.0f}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}};

/// All known ones: AP0, AP1, Rec.709, Rec.2020, P3-D65, AdobeRGB. To add another, add a row in primaries.cpp.
[[nodiscard]] std::span<const PublishedPrimaries> published_primaries();

/// The published space whose Bradford-adapted matrix to AP0 is `to_ap0`, if one is (every element within 2e-4).
[[nodiscard]] std::optional<Chromaticities> recognise_primaries(const Matrix3d& to_ap0);

/// Chromaticities of the columns of `to_xyz` and of their sum, the white.
[[nodiscard]] Chromaticities chromaticities_of(const Matrix3d& to_xyz);

}  // namespace etendue
