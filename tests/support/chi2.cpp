#include "support/chi2.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

namespace etendue::test {

namespace {

constexpr double kMinExpected = 5.0;

struct Cell {
    double observed;
    double expected;
};

/// Merges cells that expect too few into one, and that one with its neighbour if it still expects too few.
std::vector<Cell> pool(std::span<const double> observed, std::span<const double> expected) {
    std::vector<std::size_t> order(observed.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
    std::vector<Cell> cells;
    Cell pooled{0.0, 0.0};
    for (const std::size_t i : order) {
        const bool pool_is_open = pooled.expected < kMinExpected && (pooled.expected > 0.0 || pooled.observed > 0.0);
        if (expected[i] < kMinExpected || pool_is_open) {
            pooled.observed += observed[i];
            pooled.expected += expected[i];
        } else {
            cells.push_back({observed[i], expected[i]});
        }
    }
    if (pooled.expected > 0.0 || pooled.observed > 0.0) cells.push_back(pooled);
    return cells;
}

std::string bar(double count, double largest) {
    const double share = largest > 0.0 ? std::clamp(count / largest, 0.0, 1.0) : 0.0;
    return std::string(static_cast<std::size_t>(std::lround(24.0 * share)), '#');
}

std::string draw_histograms(std::span<const double> observed, std::span<const double> expected,
                            std::span<const std::string> labels) {
    const double largest = std::max(*std::max_element(observed.begin(), observed.end()),
                                    *std::max_element(expected.begin(), expected.end()));
    std::string text = fmt::format("{:>44} {:>10} {:>12} {:>8}  {:<24}  {}\n", "cell", "observed", "expected", "sigmas",
                                   "observed", "expected");
    for (std::size_t i = 0; i < observed.size(); ++i) {
        const double sigmas = (observed[i] - expected[i]) / std::sqrt(std::max(expected[i], 1e-9));
        text += fmt::format("{:>44} {:>10.0f} {:>12.2f} {:>8.2f}  {:<24}  {}\n",
                            labels.empty() ? std::to_string(i) : labels[i], observed[i], expected[i], sigmas,
                            bar(observed[i], largest), bar(expected[i], largest));
    }
    return text;
}

}  // namespace

double sidak_level(double family_level, std::size_t tests) {
    return -std::expm1(std::log1p(-family_level) / static_cast<double>(tests));
}

std::string Chi2Result::str() const {
    return fmt::format("chi-squared = {:.2f} with {} degrees of freedom, p = {:.3g}\n{}", statistic, degrees_of_freedom,
                       p_value, histograms);
}

Chi2Result chi2_counts(std::span<const double> observed, std::span<const double> expected,
                       std::span<const std::string> labels) {
    Chi2Result result;
    result.histograms = draw_histograms(observed, expected, labels);
    const std::vector<Cell> cells = pool(observed, expected);
    for (const Cell& cell : cells) {
        if (!(cell.expected > 0.0)) {
            result.statistic = std::numeric_limits<double>::infinity();
            result.p_value = 0.0;
            return result;
        }
        const double difference = cell.observed - cell.expected;
        result.statistic += difference * difference / cell.expected;
    }
    if (cells.size() < 2) return result;
    result.degrees_of_freedom = cells.size() - 1;
    const boost::math::chi_squared distribution(static_cast<double>(result.degrees_of_freedom));
    result.p_value = std::isfinite(result.statistic)
                         ? boost::math::cdf(boost::math::complement(distribution, result.statistic))
                         : 0.0;
    return result;
}

}  // namespace etendue::test
