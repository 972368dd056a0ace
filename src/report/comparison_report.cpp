#include "report/comparison_report.h"

#include "report/human_units.h"
#include "report/profile_figures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr const char* kRelMse = "relmse";
constexpr const char* kTrimmed = "relmse-trimmed";

/// "a, b and c".
std::string enumeration(const std::vector<std::string>& items) {
    std::string text;
    for (std::size_t i = 0; i < items.size(); ++i)
        text += (i == 0 ? "" : i + 1 < items.size() ? ", " : " and ") + items[i];
    return text;
}

/// Writes three significant digits, and all digits of a large number.
std::string brief(double value) {
    constexpr double kLarge = 999.5;
    return value < kLarge ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

/// "1/154" of a small ratio, "12.3%" of others.
std::string share_text(double ratio) {
    constexpr double kSmall = 0.1;
    return ratio <= kSmall ? "1/" + brief(1.0 / ratio) : fmt::format("{:.3g}%", 100.0 * ratio);
}

const char* time_name(const ComparisonReport& report) {
    return report.by_wall ? "time" : "CPU time";
}

/// Returns whether a variant is ranked: what cannot find all light is not ranked with what can.
bool is_ranked(const ComparisonReport& report, const VariantReport& variant) {
    return variant.cannot_find.empty() ||
           std::ranges::none_of(report.variants, [](const VariantReport& other) { return other.cannot_find.empty(); });
}

/// Returns the share by which the longest mean time is over the shortest, if times were to be equal and it is over a
/// tenth; else returns 0.
double excess_time(const ComparisonReport& report) {
    constexpr double kMostExcess = 0.1;
    if (!report.seconds || report.variants.empty()) return 0.0;
    std::vector<double> times;
    for (const VariantReport& variant : report.variants) times.push_back(report.time_of(variant).mean());
    const auto [least, most] = std::ranges::minmax(times);
    const double excess = most / least - 1.0;
    return excess > kMostExcess && std::isfinite(excess) ? excess : 0.0;
}

/// Ranks variants by their errors, or by these times the time by which variants are compared.
class Ranking {
  public:
    Ranking(const ComparisonReport& report, std::string metric, bool by_cost)
        : report_(report), metric_(std::move(metric)), by_cost_(by_cost) {
        for (const VariantReport& variant : report.variants)
            if (is_ranked(report, variant) && std::isfinite(value(variant))) variants_.push_back(&variant);
        std::ranges::stable_sort(variants_, {}, [this](const VariantReport* variant) { return value(*variant); });
    }

    /// "bdpt's relMSE is 1/154 (1/210 to 1/113) of path's".
    [[nodiscard]] std::string verdict() const {
        if (variants_.empty()) return fmt::format("no {} is known", title());
        const VariantReport& best = *variants_.front();
        const std::string lead = fmt::format("{}'s {} is ", best.name, title());
        if (variants_.size() == 1) {
            const double deviation = of_seeds(best).deviation();
            return lead + fmt::format("{:.3g}", value(best)) +
                   (std::isfinite(deviation) ? fmt::format(" +- {:.2g}", deviation) : "");
        }
        std::vector<std::string> others;
        for (std::size_t i = 1; i < variants_.size(); ++i)
            others.push_back(report_.seeds < 2 ? fmt::format("{:.3g} of {}", value(*variants_[i]), variants_[i]->name)
                                               : beside(best, *variants_[i]));
        if (report_.seeds > 1) return lead + enumeration(others);
        return fmt::format("{}{:.3g} beside {}, in one render each, which does not rank them", lead, value(best),
                           enumeration(others));
    }

  private:
    [[nodiscard]] std::string title() const {
        const std::string name = metric_ == kTrimmed ? "trimmed relMSE" : "relMSE";
        return by_cost_ ? fmt::format("{} x {}", name, time_name(report_)) : name;
    }

    [[nodiscard]] std::string key() const { return by_cost_ ? metric_ + "_time" : metric_; }

    [[nodiscard]] double value(const VariantReport& variant) const {
        const auto errors = variant.errors.find(metric_);
        if (errors == variant.errors.end()) return kUnknown;
        return errors->second.mean() * (by_cost_ ? report_.time_of(variant).mean() : 1.0);
    }

    /// Returns what each render of a ranked variant has.
    [[nodiscard]] SeedValues of_seeds(const VariantReport& variant) const {
        SeedValues result = variant.errors.at(metric_);
        const std::vector<double>& times = report_.time_of(variant).values;
        for (std::size_t i = 0; by_cost_ && i < std::min(result.values.size(), times.size()); ++i)
            result.values[i] *= times[i];
        return result;
    }

    /// Returns the pair of two variants, whichever is its a; null if there is none.
    [[nodiscard]] const PairReport* pair_of(const VariantReport& one, const VariantReport& other) const {
        const auto found = std::ranges::find_if(report_.pairs, [&](const PairReport& pair) {
            return (pair.a == one.name && pair.b == other.name) || (pair.a == other.name && pair.b == one.name);
        });
        return found == report_.pairs.end() ? nullptr : &*found;
    }

    /// Returns the ratio of `best` over `other` with its interval, as far as they are known.
    [[nodiscard]] RatioInterval ratio_of(const VariantReport& best, const VariantReport& other) const {
        const PairReport* const pair = pair_of(best, other);
        if (pair == nullptr || !pair->ratios.contains(key())) return {};
        const RatioInterval& ratio = pair->ratios.at(key());
        return pair->a == best.name ? ratio : RatioInterval{1.0 / ratio.ratio, 1.0 / ratio.high, 1.0 / ratio.low};
    }

    /// "no interval: one seed of 3 holds 56.5% of the error of 'path'; below it in every seed".
    [[nodiscard]] std::string without_interval(const VariantReport& best, const VariantReport& other) const {
        std::string text = "no interval";
        if (const PairReport* const pair = pair_of(best, other); pair != nullptr && pair->no_interval.contains(key()))
            text += ": " + pair->no_interval.at(key());
        return text + (of_seeds(best).largest() < of_seeds(other).least() ? "; below it in every seed" : "");
    }

    /// "1/154 (1/210 to 1/113) of path's".
    [[nodiscard]] std::string beside(const VariantReport& best, const VariantReport& other) const {
        const std::string whose = other.name + "'s";
        const double share = value(best) / value(other);
        if (value(best) == value(other)) return "as small as " + whose;
        if (!(share > 0.0)) return "far below " + whose;
        const RatioInterval ratio = ratio_of(best, other);
        if (!std::isfinite(ratio.low) || !std::isfinite(ratio.high))
            return fmt::format("{} of {} ({})", share_text(share), whose, without_interval(best, other));
        if (ratio.low <= 1.0 && ratio.high >= 1.0) return "within the seeds' scatter of " + whose;
        return fmt::format("{} ({} to {}) of {}", share_text(share), share_text(ratio.low), share_text(ratio.high),
                           whose);
    }

    const ComparisonReport& report_;
    std::string metric_;
    bool by_cost_;
    std::vector<const VariantReport*> variants_{};  ///< best first
};

/// Ranks by efficiency, where no errors are known.
std::string efficiency_verdict(const ComparisonReport& report) {
    constexpr const char* kNoErrors = "no errors are known, as there is no reference";
    std::vector<const VariantReport*> variants;
    for (const VariantReport& variant : report.variants)
        if (is_ranked(report, variant) && std::isfinite(variant.efficiency)) variants.push_back(&variant);
    const bool is_same_light =
        std::ranges::all_of(report.pairs, [](const PairReport& pair) { return pair.different_light.empty(); });
    if (variants.size() < 2 || !is_same_light) return kNoErrors;
    std::ranges::stable_sort(variants, std::ranges::greater{}, &VariantReport::efficiency);
    std::vector<std::string> others;
    for (std::size_t i = 1; i < variants.size(); ++i)
        others.push_back(fmt::format("{} times {}'s", brief(variants.front()->efficiency / variants[i]->efficiency),
                                     variants[i]->name));
    return fmt::format("{}'s efficiency, 1 / (variance x {}), is {}, as far as the seeds have met the light; {}",
                       variants.front()->name, time_name(report), enumeration(others), kNoErrors);
}

/// "trimming leaves out 99.1% of path's relMSE" of those that it leaves out more than half of; else nothing.
std::string trimming_verdict(const ComparisonReport& report) {
    constexpr double kMuch = 0.5;
    constexpr double kNearlyAll = 0.999;
    std::vector<std::string> parts;
    for (const VariantReport& variant : report.variants)
        if (const double share = trimmed_share(variant); share > kMuch)
            parts.push_back(fmt::format("{} of {}'s relMSE", share > kNearlyAll ? "over 99.9%" : human_percent(share),
                                        variant.name));
    return parts.empty() ? "" : "trimming leaves out " + enumeration(parts);
}

}  // namespace

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
    const double of_largest = trimmed_share(variant);
    if ((metric != kRelMse && metric != "mse") || !(of_largest > kMostOfValues)) return "";
    return fmt::format("0.1% of the values hold {} of the relMSE of '{}'", human_percent(of_largest), variant.name);
}

double trimmed_share(const VariantReport& variant) {
    const auto whole = variant.errors.find(kRelMse), trimmed = variant.errors.find(kTrimmed);
    if (whole == variant.errors.end() || trimmed == variant.errors.end()) return kUnknown;
    return 1.0 - trimmed->second.mean() / whole->second.mean();
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

std::string ComparisonReport::leading_metric() const {
    if (metrics.empty()) return "";
    const bool is_heavy =
        std::ranges::any_of(pairs, [](const PairReport& pair) { return pair.no_interval.contains(kRelMse); });
    return is_heavy ? kTrimmed : kRelMse;
}

bool ComparisonReport::agrees() const {
    return std::ranges::all_of(
        pairs, [](const PairReport& pair) { return !pair.comparable || !pair.agreement || pair.agreement->agree(); });
}

std::string headline(const ComparisonReport& report) {
    const std::string lead = report.leading_metric();
    if (lead.empty()) return efficiency_verdict(report);
    const double excess = excess_time(report);
    const bool by_cost = excess > 0.0;
    std::string text = by_cost
                           ? fmt::format("times differ by {:.0f}%, so errors are multiplied by {}: ", 100.0 * excess,
                                         time_name(report))
                           : "";
    text += Ranking(report, lead, by_cost).verdict();
    const std::string second = lead == kRelMse ? kTrimmed : kRelMse;
    if (std::ranges::find(report.metrics, second, &ReportedMetric::key) != report.metrics.end())
        text += "; " + Ranking(report, second, by_cost).verdict();
    if (const std::string trimming = trimming_verdict(report); !trimming.empty()) text += "; " + trimming;
    return text;
}

}  // namespace etendue
