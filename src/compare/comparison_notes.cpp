#include "compare/comparison_notes.h"

#include "compare/comparison_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns the variant of least relMSE in `region`; null if none is known.
const RegionVariant* best_of(const RegionReport& region) {
    const RegionVariant* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const RegionVariant& variant : region.variants)
        if (const auto errors = variant.errors.find("relmse");
            errors != variant.errors.end() && errors->second.mean() < least) {
            best = &variant;
            least = errors->second.mean();
        }
    return best;
}

/// Returns a note on the regions in which a pooled reference, whose weights hold for the whole image, is noisier than
/// the best variant; if there are none, returns nothing.
std::string noisy_regions(const ComparisonReport& report) {
    std::vector<std::string> parts;
    for (const RegionReport& region : report.regions) {
        const RegionVariant* const best = best_of(region);
        if (best == nullptr || !(region.reference_noise > best->errors.at("relmse").mean())) continue;
        parts.push_back(fmt::format("'{}' (its relMSE is {:.3g}, that of '{}' {:.3g})", region.name,
                                    region.reference_noise, best->name, best->errors.at("relmse").mean()));
    }
    if (parts.empty()) return "";
    return fmt::format(
        "the pooled reference, whose weights hold for the whole image, is noisier than the best variant in {}: its "
        "noise is taken off relMSE and MSE as well as it is known, and adds to the other errors; a reference by "
        "--reference-integrator can have less",
        fmt::join(parts, ", "));
}

}  // namespace

std::string unequal_times(const ComparisonReport& report) {
    constexpr double kMostRatio = 1.1;
    if (!report.seconds || report.variants.empty()) return "";
    const auto time = [&](const VariantReport& variant) { return report.time_of(variant).mean(); };
    const auto [least, most] = std::ranges::minmax_element(report.variants, {}, time);
    const double ratio = time(*most) / time(*least);
    if (!(ratio > kMostRatio)) return "";
    return fmt::format(
        "times are not equal: '{}' took {:.3g} s of {} in the mean, '{}' {:.3g} s, {:.0f}% more; look at ratios of "
        "relMSE x time, or give more --time",
        least->name, time(*least), report.by_wall ? "time on the clock" : "CPU time", most->name, time(*most),
        100.0 * (ratio - 1.0));
}

std::string drowned_errors(const ComparisonReport& report) {
    std::vector<std::string> names;
    for (const VariantReport& variant : report.variants)
        if (std::ranges::any_of(kErrorsWithoutNoise, [&](const char* metric) {
                const auto errors = variant.errors.find(metric);
                return errors != variant.errors.end() && std::isnan(errors->second.mean());
            }))
            names.push_back(fmt::format("'{}'", variant.name));
    for (const RegionReport& region : report.regions)
        for (const RegionVariant& variant : region.variants)
            if (const auto errors = variant.errors.find("relmse");
                !region.found && errors != variant.errors.end() && std::isnan(errors->second.mean()))
                names.push_back(fmt::format("'{}' in '{}'", variant.name, region.name));
    if (!(report.reference.noise_rel_mse > 0.0) || names.empty()) return "";
    return fmt::format(
        "the reference's noise, a relMSE of {:.3g}, hides errors of {}, which are not known: a reference with less "
        "noise, or more --seeds, would show them",
        report.reference.noise_rel_mse, fmt::join(names, ", "));
}

std::string reference_noise(const ComparisonReport& report) {
    if (report.reference.kind == "pooled") return noisy_regions(report);
    double least = std::numeric_limits<double>::infinity();
    for (const VariantReport& variant : report.variants)
        if (const auto errors = variant.errors.find("relmse"); errors != variant.errors.end())
            least = std::fmin(least, errors->second.mean());
    if (!std::isfinite(least) || !report.reference.is_noisy_for(least)) return "";
    const double noise = report.reference.noise();
    const std::string share =
        fmt::format("a relMSE of {:.3g}, is {:.0f}% of the least relMSE", noise, 100.0 * noise / least);
    if (std::isnan(report.reference.noise_rel_mse))
        return fmt::format(
            "the difference between the reference and the mean of all seeds, {}: the reference's noise, which is not "
            "known, or another difference adds as much to all errors and draws their ratios towards 1; ratios have no "
            "intervals",
            share);
    return fmt::format(
        "the reference's own noise, {}: it is taken off relMSE and MSE as well as it is known, and adds to the other "
        "errors; ratios have no intervals; a longer reference has less",
        share);
}

std::string off_budget(const ComparisonReport& report) {
    constexpr double kMostOff = 0.1;
    std::vector<std::string> off;
    if (!report.seconds) return "";
    for (const VariantReport& variant : report.variants)
        if (const double time = report.time_of(variant).mean(); std::abs(time / *report.seconds - 1.0) > kMostOff)
            off.push_back(fmt::format("'{}' {:.3g} s", variant.name, time));
    if (off.empty()) return "";
    return fmt::format(
        "renders took another time on average than the {:.3g} s of {} asked for: {}; with a longer --time the "
        "difference is smaller, and ratios of relMSE x time allow for it",
        *report.seconds, report.by_wall ? "time on the clock" : "CPU time", fmt::join(off, ", "));
}

}  // namespace etendue
