#include "bsdf/reflectance_color.h"

#include "bsdf/color_matching.h"
#include "core/xyz.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace etendue {

namespace {

constexpr int kFirstNm = 380;
constexpr int kLastNm = 780;
constexpr int kStepNm = 5;
constexpr int kD65StepNm = 10;

// CIE standard illuminant D65, relative spectral power every 10 nm. The standard's 5 nm values lie on straight lines
// between these.
constexpr std::array<double, (kLastNm - kFirstNm) / kD65StepNm + 1> kD65{
    49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923,
    108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856,
    90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091,
    74.3490, 61.6040, 69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};

double d65(int nm) {
    const auto index = static_cast<std::size_t>((nm - kFirstNm) / kD65StepNm);
    const double t = static_cast<double>((nm - kFirstNm) % kD65StepNm) / kD65StepNm;
    return t == 0.0 ? kD65[index] : kD65[index] + (kD65[index + 1] - kD65[index]) * t;
}

}  // namespace

Rgb reflectance_color(const std::function<double(double nanometres)>& reflectance) {
    std::array<double, 3> color{};
    std::array<double, 3> white{};
    for (int nm = kFirstNm; nm <= kLastNm; nm += kStepNm) {
        const double reflected = reflectance(nm);
        const std::array<double, 3> xyz = color_matching_xyz(nm);
        for (std::size_t c = 0; c < 3; ++c) {
            const auto& row = kXyzToRec709[c];
            const double weight = d65(nm) * (row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2]);
            color[c] += weight * reflected;
            white[c] += weight;
        }
    }
    // Division by the white of the same sums, not by the nominal D65, keeps white white although the fit is not exact.
    return {static_cast<float>(color[0] / white[0]), static_cast<float>(color[1] / white[1]),
            static_cast<float>(color[2] / white[2])};
}

}  // namespace etendue
