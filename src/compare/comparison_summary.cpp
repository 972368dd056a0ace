#include "compare/comparison_summary.h"

#include "core/log.h"
#include "report/human_units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

void print(const VariantReport& variant) {
    std::string line = fmt::format("{}: {} spp in {:.3g} s, {:.3g} s of CPU time", variant.name, variant.spp,
                                   variant.seconds.mean(), variant.cpu_seconds.mean());
    for (const auto& [metric, title] : {std::pair{"relmse", "relMSE"}, std::pair{"relmse-trimmed", "trimmed relMSE"}})
        if (const auto error = variant.errors.find(metric);
            error != variant.errors.end() && !std::isnan(error->second.mean()))
            line += fmt::format(", {} {:.3g}", title, error->second.mean());
    log_info("{}, {:.2f} Msamples per CPU s", line, variant.samples_per_cpu_second * 1e-6);
}

std::string text_of_ratio(const RatioInterval& interval, const std::string& why_none) {
    if (!why_none.empty()) return fmt::format("{:.3g} (no interval: {})", interval.ratio, why_none);
    if (!std::isfinite(interval.low)) return fmt::format("{:.3g}", interval.ratio);
    return fmt::format("{:.3g} ({:.0f}%: {:.3g} to {:.3g})", interval.ratio, 100.0 * kRatioConfidence, interval.low,
                       interval.high);
}

void print(const PairReport& pair) {
    std::array keys{std::pair{"relmse_time", "relMSE x time"},
                    std::pair{"relmse-trimmed_time", "trimmed relMSE x time"}};
    if (pair.no_interval.contains(keys.front().first) && !pair.no_interval.contains(keys.back().first))
        std::ranges::reverse(keys);
    for (const auto& [key, title] : keys)
        if (const auto ratio = pair.ratios.find(key);
            ratio != pair.ratios.end() && std::isfinite(ratio->second.ratio)) {
            const auto why = pair.no_interval.find(key);
            log_info("{} of {} over that of {}: {}", title, pair.a, pair.b,
                     text_of_ratio(ratio->second, why == pair.no_interval.end() ? "" : why->second));
        }
}

/// Says of a pair that does not agree what its test says.
void print_agreement(const PairReport& pair) {
    if (!pair.not_tested.empty())
        log_info("{} and {} are not tested: {}", pair.a, pair.b, pair.not_tested);
    else if (pair.verdict() == "disagree")
        log_info("{} and {} disagree (p = {:.2g})", pair.a, pair.b, pair.agreement->p_value);
    else if (pair.verdict() == "no difference seen")
        log_info("between {} and {} no difference is seen, but only one of {} of the whole image would have been{}",
                 pair.a, pair.b, human_percent(pair.smallest_of_image()),
                 pair.agreement->whole_image_only ? "; single regions could not be tested" : "");
}

/// Says in a line that images agree, and names those that do not.
void print_agreement(const ComparisonReport& report) {
    const auto agrees = [](const PairReport& pair) { return pair.verdict() == "agree"; };
    for (const PairReport& pair : report.pairs)
        if (!agrees(pair)) print_agreement(pair);
    if (!report.pairs.empty() && std::ranges::all_of(report.pairs, agrees))
        log_info("all images agree");
    else
        for (const PairReport& pair : report.pairs)
            if (agrees(pair)) log_info("{} and {} agree", pair.a, pair.b);
}

void print(const RegionReport& region) {
    for (const RegionVariant& variant : region.variants) {
        std::string line = fmt::format("{}, {}: mean {:.4g}", region.name, variant.name, fmt::join(variant.mean, " "));
        if (!variant.errors.empty() && !std::isnan(variant.errors.at("relmse").mean()))
            line += fmt::format(", relMSE {:.3g}, relMSE x time {:.3g}", variant.errors.at("relmse").mean(),
                                variant.rel_mse_time);
        if (std::isfinite(variant.mean_error.mean()))
            line += fmt::format(", mean off by {:.2f}% (deviation {:.2f}%)", 100.0 * variant.mean_error.mean(),
                                100.0 * variant.mean_error.deviation());
        log_info("{}", line);
    }
}

}  // namespace

void print_summary(const ComparisonReport& report, std::size_t notes_said) {
    log_info("{}", headline(report));
    print_agreement(report);
    for (const VariantReport& variant : report.variants) print(variant);
    for (const PairReport& pair : report.pairs) print(pair);
    for (const RegionReport& region : report.regions)
        if (!region.found) print(region);
    for (std::size_t i = notes_said; i < report.notes.size(); ++i) log_warning("note: {}", report.notes[i]);
}

}  // namespace etendue
