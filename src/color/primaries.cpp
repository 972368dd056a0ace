#include "color/primaries.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace etendue {

namespace {

// AP0 and AP1: SMPTE ST 2065-1:2012 and AMPAS S-2014-004. Rec.709: ITU-R BT.709-6. Rec.2020: ITU-R BT.2020-2. P3-D65:
// SMPTE EG 432-1 with D65. AdobeRGB: Adobe RGB (1998) Color Image Encoding.
constexpr std::array kPublished{
    PublishedPrimaries{"AP0", kAp0},
    PublishedPrimaries{"AP1", {{0.713f, 0.293f}, {0.165f, 0.830f}, {0.128f, 0.044f}, {0.32168f, 0.33767f}}},
    PublishedPrimaries{"Rec.709", {{0.64f, 0.33f}, {0.30f, 0.60f}, {0.15f, 0.06f}, kD65}},
    PublishedPrimaries{"Rec.2020", {{0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, kD65}},
    PublishedPrimaries{"P3-D65", {{0.680f, 0.320f}, {0.265f, 0.690f}, {0.150f, 0.060f}, kD65}},
    PublishedPrimaries{"AdobeRGB", {{0.64f, 0.33f}, {0.21f, 0.71f}, {0.15f, 0.06f}, kD65}},
};

// XYZ of chromaticity (x, y) with Y = 1. `xy` holds decimal fractions as floats; rounding to seven digits restores
// them.
std::array<double, 3> xyz_of(const std::array<float, 2>& xy) {
    const double x = std::round(static_cast<double>(xy[0]) * 1e7) * 1e-7;
    const double y = std::round(static_cast<double>(xy[1]) * 1e7) * 1e-7;
    return {x / y, 1.0, (1.0 - x - y) / y};
}

std::array<float, 2> xy_of(double x, double y, double z) {
    const double sum = x + y + z;
    return {static_cast<float>(x / sum), static_cast<float>(y / sum)};
}

}  // namespace

Matrix3d operator*(const Matrix3d& a, const Matrix3d& b) {
    Matrix3d product{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            for (std::size_t k = 0; k < 3; ++k) product[3 * row + column] += a[3 * row + k] * b[3 * k + column];
        }
    }
    return product;
}

std::array<double, 3> operator*(const Matrix3d& m, const std::array<double, 3>& v) {
    std::array<double, 3> product{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t k = 0; k < 3; ++k) product[row] += m[3 * row + k] * v[k];
    }
    return product;
}

// Cramer's rule.
Matrix3d inverse(const Matrix3d& m) {
    const Matrix3d adjugate{m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
                            m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
                            m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
    const double determinant = m[0] * adjugate[0] + m[1] * adjugate[3] + m[2] * adjugate[6];
    Matrix3d result = adjugate;
    for (double& element : result) element /= determinant;
    return result;
}

Matrix3d rgb_to_xyz(const Chromaticities& space) {
    const auto r = xyz_of(space.red);
    const auto g = xyz_of(space.green);
    const auto b = xyz_of(space.blue);
    const Matrix3d primaries{r[0], g[0], b[0], r[1], g[1], b[1], r[2], g[2], b[2]};
    const auto luminance = inverse(primaries) * xyz_of(space.white);
    return primaries * Matrix3d{luminance[0], 0, 0, 0, luminance[1], 0, 0, 0, luminance[2]};
}

Matrix3d bradford_adaptation(const std::array<float, 2>& from, const std::array<float, 2>& to) {
    constexpr Matrix3d kCones{0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
    const auto source = kCones * xyz_of(from);
    const auto target = kCones * xyz_of(to);
    const Matrix3d gain{target[0] / source[0], 0, 0, 0, target[1] / source[1], 0, 0, 0, target[2] / source[2]};
    return inverse(kCones) * gain * kCones;
}

Matrix3d rgb_to_rgb(const Chromaticities& from, const Chromaticities& to) {
    return inverse(rgb_to_xyz(to)) * bradford_adaptation(from.white, to.white) * rgb_to_xyz(from);
}

std::span<const PublishedPrimaries> published_primaries() {
    return kPublished;
}

std::optional<Chromaticities> recognise_primaries(const Matrix3d& to_ap0) {
    constexpr double kTolerance = 2e-4;
    for (const PublishedPrimaries& published : kPublished) {
        const Matrix3d expected = rgb_to_rgb(published.chromaticities, kAp0);
        const auto near = [](double a, double b) { return std::abs(a - b) < kTolerance; };
        if (std::equal(to_ap0.begin(), to_ap0.end(), expected.begin(), near)) return published.chromaticities;
    }
    return std::nullopt;
}

Chromaticities chromaticities_of(const Matrix3d& m) {
    return {xy_of(m[0], m[3], m[6]), xy_of(m[1], m[4], m[7]), xy_of(m[2], m[5], m[8]),
            xy_of(m[0] + m[1] + m[2], m[3] + m[4] + m[5], m[6] + m[7] + m[8])};
}

std::vector<float> numbers_of(const Chromaticities& c) {
    return {c.red[0], c.red[1], c.green[0], c.green[1], c.blue[0], c.blue[1], c.white[0], c.white[1]};
}

}  // namespace etendue
