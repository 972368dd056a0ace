#include "report/comparison_report.h"

#include "report/human_units.h"
#include "report/profile_figures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace etendue {

double SeedValues::mean() const {
    if (values.empty()) return kUnknown;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double SeedValues::median() const {
    return etendue::median(values);
}

LogEstimate SeedValues::log_mean() const {
    const double centre = mean();
    const auto count = static_cast<double>(values.size());
    return {std::log(centre), std::pow(deviation() / centre, 2.0) / count, count - 1.0};
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

std::string heavy_tail(const VariantReport& variant, const std::string& metric) {
    // If seeds scatter by more than this, as a share of their mean, chance decides what a mean of few seeds holds, and
    // the first-order variance of its logarithm is too small.
    constexpr double kMostScatter = 0.5;
    // The largest 0.1% hold this share if terms follow Pareto's law with the exponent 3/2, whose variance is infinite.
    constexpr double kMostOfValues = 0.1;
    const auto found = variant.errors.find(metric);
    if (found == variant.errors.end()) return "";
    const SeedValues& errors = found->second;
    if (errors.deviation() > kMostScatter * errors.mean() && errors.least() < 0.0)
        return fmt::format("the reference's noise leaves too little of the error of '{}'", variant.name);
    if (errors.deviation() > kMostScatter * errors.mean())
        return fmt::format("one seed of {} holds {} of the error of '{}'", errors.values.size(),
                           human_percent(errors.largest() / static_cast<double>(errors.values.size()) / errors.mean()),
                           variant.name);
    const auto whole = variant.errors.find("relmse"), trimmed = variant.errors.find("relmse-trimmed");
    if ((metric != "relmse" && metric != "mse") || whole == variant.errors.end() || trimmed == variant.errors.end())
        return "";
    const double of_largest = 1.0 - trimmed->second.mean() / whole->second.mean();
    if (!(of_largest > kMostOfValues)) return "";
    return fmt::format("0.1% of the values hold {} of the relMSE of '{}'", human_percent(of_largest), variant.name);
}

double ReferenceReport::noise() const {
    if (kind == "pooled") return 0.0;
    return std::fmax(0.0, std::isnan(noise_rel_mse) ? noise_bound : noise_rel_mse);
}

bool ReferenceReport::is_noisy_for(double error) const {
    constexpr double kMuch = 0.1;
    return noise() > kMuch * error;
}

double PairReport::smallest_of_image() const {
    if (!agreement) return kUnknown;
    return smallest_difference(agreement->mean_error, agreement_options.significance, agreement->tests);
}

double PairReport::smallest_of_block() const {
    if (!agreement) return kUnknown;
    return smallest_difference(agreement->block_error, agreement_options.significance, agreement->tests);
}

std::string_view PairReport::verdict() const {
    constexpr double kWeak = 0.1;  // larger differences of whole images are not worth the word "agree"
    if (!agreement || !not_tested.empty()) return "not tested";
    if (!agreement->agree()) return "disagree";
    return agreement->whole_image_only || smallest_of_image() > kWeak ? "no difference seen" : "agree";
}

std::vector<UntestedVariant> ComparisonReport::untested() const {
    std::vector<UntestedVariant> result;
    for (const VariantReport& variant : variants) {
        std::string why;
        const bool is_tested = std::ranges::any_of(pairs, [&](const PairReport& pair) {
            if (pair.a != variant.name && pair.b != variant.name) return false;
            if (why.empty()) why = pair.not_tested;
            return pair.not_tested.empty();
        });
        if (!is_tested && !pairs.empty()) result.push_back({variant.name, why});
    }
    return result;
}

bool ComparisonReport::agrees() const {
    return std::ranges::all_of(
        pairs, [](const PairReport& pair) { return !pair.comparable || !pair.agreement || pair.agreement->agree(); });
}

}  // namespace etendue
