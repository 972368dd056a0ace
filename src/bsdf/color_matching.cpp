#include "bsdf/color_matching.h"

#include <cmath>
#include <span>

namespace etendue {

namespace {

/// One term of the fit of a matching function: height exp(-t² / 2) with t = (lambda - mean) slope, lambda in
/// nanometres, where slope is `below` for lambda < mean and `above` from there on (Wyman, Sloan, Shirley 2013).
struct Lobe {
    double height, mean, below, above;
};

constexpr std::array<Lobe, 3> kMatchX{
    {{0.362, 442.0, 0.0624, 0.0374}, {1.056, 599.8, 0.0264, 0.0323}, {-0.065, 501.1, 0.0490, 0.0382}}};
constexpr std::array<Lobe, 2> kMatchY{{{0.821, 568.8, 0.0213, 0.0247}, {0.286, 530.9, 0.0613, 0.0322}}};
constexpr std::array<Lobe, 2> kMatchZ{{{1.217, 437.0, 0.0845, 0.0278}, {0.681, 459.0, 0.0385, 0.0725}}};

double evaluate(std::span<const Lobe> lobes, double nm) {
    double sum = 0.0;
    for (const Lobe& lobe : lobes) {
        const double t = (nm - lobe.mean) * (nm < lobe.mean ? lobe.below : lobe.above);
        sum += lobe.height * std::exp(-0.5 * t * t);
    }
    return sum;
}

}  // namespace

std::array<double, 3> color_matching_xyz(double nanometres) {
    return {evaluate(kMatchX, nanometres), evaluate(kMatchY, nanometres), evaluate(kMatchZ, nanometres)};
}

}  // namespace etendue
