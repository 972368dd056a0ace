#include "report/comparison_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace etendue {

double SeedValues::mean() const {
    if (values.empty()) return kUnknown;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double SeedValues::deviation() const {
    if (values.size() < 2) return kUnknown;
    const double centre = mean();
    double squares = 0.0;
    for (const double value : values) squares += (value - centre) * (value - centre);
    return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double SeedValues::least() const {
    return values.empty() ? kUnknown : *std::ranges::min_element(values);
}

double SeedValues::largest() const {
    return values.empty() ? kUnknown : *std::ranges::max_element(values);
}

bool ComparisonReport::agrees() const {
    return std::ranges::all_of(
        pairs, [](const PairReport& pair) { return !pair.comparable || !pair.agreement || pair.agreement->agree(); });
}

}  // namespace etendue
