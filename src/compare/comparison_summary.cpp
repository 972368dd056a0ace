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

constexpr const char* kOnlyWhole = "; only the whole image could be tested: faults of single regions would not be seen";

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
    if (!pair.not_tested.empty())
        log_info("{} and {} are not tested: {}", pair.a, pair.b, pair.not_tested);
    else if (pair.agreement)
        log_info("{} and {}, {}: {}; a difference of {} of the whole image{} is seen with probability {}{}", pair.a,
                 pair.b, pair.verdict() == "disagree" ? "DISAGREE" : pair.verdict(), pair.agreement->str(),
                 human_percent(pair.smallest_of_image()),
                 pair.agreement->whole_image_only
                     ? ""
                     : fmt::format(", or {} of a block,", human_percent(pair.smallest_of_block())),
                 kPower, pair.agreement->whole_image_only ? kOnlyWhole : "");
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
    for (const VariantReport& variant : report.variants) print(variant);
    for (const PairReport& pair : report.pairs) print(pair);
    for (const RegionReport& region : report.regions)
        if (!region.found) print(region);
    for (std::size_t i = notes_said; i < report.notes.size(); ++i) log_warning("note: {}", report.notes[i]);
}

}  // namespace etendue
