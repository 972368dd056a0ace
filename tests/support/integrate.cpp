#include "support/integrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue::test {

namespace {

using Function = std::function<double(double, double)>;

constexpr std::array<double, 3> kWeights = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

double at_node(const Function& f, const Rect& r, std::size_t i, std::size_t j) {
    return f(r.x0 + (r.x1 - r.x0) * kGaussNodes[i], r.y0 + (r.y1 - r.y0) * kGaussNodes[j]);
}

double gauss(const Function& f, const Rect& r) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kGaussNodes.size(); ++i)
        for (std::size_t j = 0; j < kGaussNodes.size(); ++j) sum += kWeights[i] * kWeights[j] * at_node(f, r, i, j);
    return sum * (r.x1 - r.x0) * (r.y1 - r.y0);
}

/// Zeros at all nodes do not end the first levels: a function that is zero but for a sliver looks converged.
constexpr int kBlindLevels = 3;

struct Levels {
    int least;
    int most;
};

double refine(const Function& f, const Rect& r, double whole, double tolerance, int level, const Levels& levels) {
    const double x = 0.5 * (r.x0 + r.x1);
    const double y = 0.5 * (r.y0 + r.y1);
    const std::array<Rect, 4> quarters = {Rect{r.x0, x, r.y0, y}, Rect{x, r.x1, r.y0, y}, Rect{r.x0, x, y, r.y1},
                                          Rect{x, r.x1, y, r.y1}};
    std::array<double, 4> parts{};
    double sum = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i) sum += parts[i] = gauss(f, quarters[i]);
    const int least = sum != 0.0 ? levels.least : std::max(levels.least, kBlindLevels);
    if (level >= levels.most || (level >= least && std::abs(sum - whole) <= tolerance)) return sum;
    // Along a jump the rectangles double with every level while their area falls to a quarter, so halving converges.
    double refined = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i)
        refined += refine(f, quarters[i], parts[i], 0.5 * tolerance, level + 1, levels);
    return refined;
}

}  // namespace

double integrate(const Function& f, const Rect& rect, double tolerance, int max_depth, int min_depth) {
    return refine(f, rect, gauss(f, rect), tolerance, 0, {min_depth, max_depth});
}

}  // namespace etendue::test
