#include "compare/comparison_summary.h"

#include "core/log.h"

#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

void print(const VariantReport& variant) {
    std::string line = fmt::format("{}: {} spp in {:.3g} s", variant.name, variant.spp, variant.seconds.mean());
    for (const auto& [metric, title] : {std::pair{"relmse", "relMSE"}, std::pair{"relmse-trimmed", "trimmed"}})
        if (const auto error = variant.errors.find(metric); error != variant.errors.end())
            line += fmt::format(", {} {:.3g}", title, error->second.mean());
    log_info("{}, {:.2f} Msamples per CPU s", line, variant.samples_per_cpu_second * 1e-6);
}

void print(const PairReport& pair) {
    if (const auto ratio = pair.ratios.find("relmse_seconds");
        ratio != pair.ratios.end() && std::isfinite(ratio->second))
        log_info("relMSE x seconds of {} over that of {}: {:.3g}", pair.a, pair.b, ratio->second);
    if (!pair.different_light.empty())
        log_info("{} and {} show different light and are not tested: {}", pair.a, pair.b, pair.different_light);
    else if (pair.agreement && pair.comparable)
        log_info("{} and {} {}: {}", pair.a, pair.b, pair.agreement->agree() ? "agree" : "DISAGREE",
                 pair.agreement->str());
}

void print(const RegionReport& region) {
    for (const RegionVariant& variant : region.variants) {
        std::string line = fmt::format("{}, {}: mean {:.4g}", region.name, variant.name, fmt::join(variant.mean, " "));
        if (!variant.errors.empty())
            line += fmt::format(", relMSE {:.3g}, relMSE x seconds {:.3g}, mean off by {:.2f}% (deviation {:.2f}%)",
                                variant.errors.at("relmse").mean(), variant.rel_mse_seconds,
                                100.0 * variant.mean_error.mean(), 100.0 * variant.mean_error.deviation());
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
