#include "bsdf/reflectance_color.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

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

/// One term of the fit of a matching function: height exp(-t² / 2) with t = (lambda - mean) slope, lambda in
/// nanometres, where slope is `below` for lambda < mean and `above` from there on (Wyman, Sloan, Shirley 2013).
struct Lobe {
    double height, mean, below, above;
};

constexpr std::array<Lobe, 3> kMatchX{
    {{0.362, 442.0, 0.0624, 0.0374}, {1.056, 599.8, 0.0264, 0.0323}, {-0.065, 501.1, 0.0490, 0.0382}}};
constexpr std::array<Lobe, 2> kMatchY{{{0.821, 568.8, 0.0213, 0.0247}, {0.286, 530.9, 0.0613, 0.0322}}};
constexpr std::array<Lobe, 2> kMatchZ{{{1.217, 437.0, 0.0845, 0.0278}, {0.681, 459.0, 0.0385, 0.0725}}};

// CIE XYZ to linear Rec.709, from the primaries and white point of ITU-R BT.709.
constexpr std::array<std::array<double, 3>, 3> kXyzToRec709{
    {{3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}}};

double color_match(std::span<const Lobe> lobes, double nm) {
    double sum = 0.0;
    for (const Lobe& lobe : lobes) {
        const double t = (nm - lobe.mean) * (nm < lobe.mean ? lobe.below : lobe.above);
        sum += lobe.height * std::exp(-0.5 * t * t);
    }
    return sum;
}

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
        const std::array<double, 3> xyz{color_match(kMatchX, nm), color_match(kMatchY, nm), color_match(kMatchZ, nm)};
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
