#include "compare/comparison_images.h"

#include "image/write.h"
#include "metrics/color_map.h"
#include "metrics/pixel_selection.h"
#include "picture/render_setup.h"
#include "render/strategy_pyramid.h"
#include "session/interrupt.h"
#include "session/progress_display.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Share of the pixels that a map of relMSE shows below its last colour: the rest is fireflies.
constexpr double kMapQuantile = 0.95;

constexpr int kStrategyWidth = 240;          // pixels
constexpr double kStrategyShare = 0.2;       // of the CPU time of all renders
constexpr double kLeastStrategySeconds = 1;  // that they may take in any case

void add_error_maps(ReportImages& images, ComparisonReport& report, const ErrorMaps& maps) {
    // One scale for all, so that they can be compared.
    double largest = 0.0;
    for (const ImageF& map : maps.rel_mse) largest = std::max(largest, quantile_of(map, kMapQuantile));
    if (!(largest > 0.0)) largest = 1.0;
    for (std::size_t v = 0; v < report.variants.size(); ++v) {
        const std::string& name = report.variants[v].name;
        images["error/flip/" + name] = encode_png(paint_magma(maps.flip[v], 1.0));
        images["error/relmse/" + name] = encode_png(paint_magma(maps.rel_mse[v], largest));
    }
    report.maps["error/flip"] = {0.0, 1.0};
    report.maps["error/relmse"] = {0.0, largest};
}

/// The variant's image with `scale` times as many pixels a side.
RenderOptions small_options(const Variant& variant, double scale, std::uint32_t spp) {
    RenderOptions options = variant.sampling;
    const auto scaled = [scale](int pixels) { return std::max(1, static_cast<int>(pixels * scale)); };
    const auto corner = [scale](int pixels) { return static_cast<int>(std::floor(pixels * scale)); };
    const PixelRect& window = variant.sampling.window;
    options.full_width = scaled(options.full_width);
    options.full_height = scaled(options.full_height);
    options.window =
        moved_to({0, 0, scaled(window.width()), scaled(window.height())}, corner(window.x0), corner(window.y0));
    options.spp = spp;
    options.time_limit_seconds = 0.0;
    return options;
}

/// Returns the CPU seconds that the images of all strategies may take together.
double strategy_seconds(const ComparisonReport& report) {
    double all = 0.0;
    for (const VariantReport& variant : report.variants)
        for (const double seconds : variant.cpu_seconds.values) all += seconds;
    return std::max(kLeastStrategySeconds, kStrategyShare * all);
}

/// Returns the plan of each of `images` strategies, as if it took as long as the variant's own image.
StrategyPlan plan_strategies(const ComparisonReport& report, const Variant& variant, const VariantRenders& renders,
                             std::size_t images) {
    const std::vector<Snapshot>& kept = renders.seeds.front().checkpoints;
    const double first = kept.front().cpu_seconds / kept.front().spp;
    const double later =
        kept.size() > 1 ? (kept.back().cpu_seconds - kept.front().cpu_seconds) / (kept.back().spp - kept.front().spp)
                        : first;
    const double scale = std::min(1.0, static_cast<double>(kStrategyWidth) / variant.sampling.window.width());
    StrategyPlan plan = fit_strategies(strategy_seconds(report) / static_cast<double>(images), scale * scale * first,
                                       scale * scale * later);
    plan.scale *= scale;
    return plan;
}

/// Returns the mean weight of the light in each pixel: what the weighted image has of the other; 0 where that is black.
ImageF mean_weights(const ImageF& weighted, const ImageF& unweighted, const Rgb& weights) {
    ImageF result = luminances(weighted, weights);
    const ImageF whole = luminances(unweighted, weights);
    for (std::size_t i = 0; i < result.pixels.size(); ++i)
        result.pixels[i] = whole.pixels[i] > 0.0f ? result.pixels[i] / whole.pixels[i] : 0.0f;
    return result;
}

/// Fills in what the images, with weights and without, say of each strategy, and the exposure of each row: the one at
/// which what is bright in the sum of its weighted images is as bright as in the sum of all.
void describe_strategies(StrategiesReport& report, std::span<const StrategyImage> weighted,
                         std::span<const StrategyImage> unweighted, const Rgb& weights) {
    constexpr double kBright = 0.98;  // quantile of the pixels
    constexpr double kMostStops = 16.0;
    const ImageF& like = weighted.front().rgba;
    std::map<int, ImageF> rows;
    ImageF all(like.width, like.height, 1);
    for (std::size_t i = 0; i < weighted.size(); ++i) {
        const Strategy& strategy = weighted[i].strategy;
        ImageF& row = rows.try_emplace(strategy.edges(), like.width, like.height, 1).first->second;
        const ImageF own = luminances(weighted[i].rgba, weights);
        for (std::size_t p = 0; p < own.pixels.size(); ++p) {
            row.pixels[p] += own.pixels[p];
            all.pixels[p] += own.pixels[p];
        }
        report.strategies.push_back({.s = strategy.s,
                                     .t = strategy.t,
                                     .weighted_mean = mean_of(own),
                                     .unweighted_mean = mean_of(luminances(unweighted[i].rgba, weights))});
    }
    const double bright = quantile_of(all, kBright);
    for (const auto& [edges, row] : rows) {
        const double of_row = quantile_of(row, kBright);
        const double stops = of_row > 0.0 && bright > 0.0 ? std::log2(bright / of_row) : 0.0;
        report.rows.push_back({edges, std::clamp(std::round(2.0 * stops) / 2.0, 0.0, kMostStops)});
        const double sum = mean_of(row);
        for (StrategyReport& strategy : report.strategies) {
            if (strategy.edges() != edges) continue;
            if (sum > 0.0) strategy.share = strategy.weighted_mean / sum;
            if (strategy.unweighted_mean > 0.0)
                strategy.mean_weight = strategy.weighted_mean / strategy.unweighted_mean;
        }
    }
}

}  // namespace

StrategyPlan fit_strategies(double seconds, double first_sample, double sample) {
    constexpr double kMostSamples = 8.0;
    if (first_sample > seconds) return {.scale = std::max(0.25, std::sqrt(seconds / first_sample))};
    const double more = sample > 0.0 ? (seconds - first_sample) / sample : kMostSamples;
    return {.spp = static_cast<std::uint32_t>(std::min(kMostSamples, 1.0 + std::floor(more)))};
}

void add_images(ReportImages& images, ComparisonReport& report, std::span<const FinishedImages> finished,
                const std::optional<Reference>& reference, const ErrorMaps& maps, const DisplayView& view,
                const MeasureContext& context) {
    const auto shown = [&](const ImageF& image) { return encode_png(display_image(image, view, context.colors)); };
    for (std::size_t v = 0; v < finished.size(); ++v)
        images["image/" + report.variants[v].name] = shown(finished[v].of_seeds.front());
    if (reference) {
        images["reference"] = shown(reference->of_round(0));
        add_error_maps(images, report, maps);
    }
    std::size_t pair = 0;
    for (std::size_t a = 0; a < finished.size(); ++a)
        for (std::size_t b = a + 1; b < finished.size(); ++b, ++pair) {
            const PairReport& tested = report.pairs[pair];
            if (!tested.agreement) continue;
            // The last colour is where the test fails.
            const double critical = critical_z(tested.agreement_options.significance, tested.agreement->tests);
            const int size = tested.agreement_options.block_size;
            const std::string key = fmt::format("z/{}/{}", tested.a, tested.b);
            images[key] =
                encode_png(paint_magma(agreement_map(widened_estimate(finished[a], size),
                                                     widened_estimate(finished[b], size), tested.agreement_options),
                                       critical));
            report.maps[key] = {0.0, critical};
        }
}

bool add_strategies(ReportImages& images, ComparisonReport& report, const Variant& variant,
                    const VariantRenders& renders, int longest, const DisplayView& view, const MeasureContext& context,
                    bool quiet) {
    IntegratorSettings integrator = variant.settings.integrator;
    integrator.strategy.reset();
    longest = std::min(longest, integrator.lengths.max_depth);
    const std::vector<Strategy> wanted = strategies_between(integrator.lengths.min_depth, longest);
    if (wanted.empty()) {
        report.notes.push_back(
            fmt::format("no strategies are shown: --strategies-depth ends at {} edges, and paths of fewer than {} are "
                        "left out (--min-depth)",
                        longest, integrator.lengths.min_depth));
        return false;
    }
    const StrategyPlan plan = plan_strategies(report, variant, renders, 2 * wanted.size());
    const RenderOptions options = small_options(variant, plan.scale, plan.spp);
    const Rgb weights = context.colors.luminance_weights(report.working_space);
    std::array<std::vector<StrategyImage>, 2> strategies;  // with weights and without
    for (const bool weighted : {true, false}) {
        integrator.weighted = weighted;
        const char* name = weighted ? "weighted" : "unweighted";
        ProgressDisplay display(fmt::format("{} strategies of {}", name, variant.name), quiet);
        std::vector<StrategyImage>& rendered = strategies[weighted ? 0 : 1];
        rendered =
            render_strategies(*variant.world, integrator, wanted, options, context.threads, interrupt_requested(),
                              [&](const RenderProgress& progress) { display.update(progress); });
        if (rendered.size() < wanted.size()) return false;
    }
    StrategiesReport result{.variant = variant.name, .spp = options.spp, .longest = longest};
    describe_strategies(result, strategies[0], strategies[1], weights);
    ReportImages made;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        DisplayView of_row = view;
        of_row.exposure +=
            static_cast<float>(std::ranges::find(result.rows, wanted[i].edges(), &StrategyRow::edges)->exposure);
        const auto key = [&](const char* kind) {
            return fmt::format("strategy/{}/{},{}", kind, wanted[i].s, wanted[i].t);
        };
        const ImageF& weighted = strategies[0][i].rgba;
        const ImageF& unweighted = strategies[1][i].rgba;
        made[key("weighted")] = encode_png(display_image(weighted, of_row, context.colors));
        made[key("unweighted")] = encode_png(display_image(unweighted, of_row, context.colors));
        made[key("weights")] = encode_png(paint_magma(mean_weights(weighted, unweighted, weights), 1.0));
    }
    report.maps["strategy/weights"] = {0.0, 1.0};
    images.merge(made);
    report.strategies = std::move(result);
    return true;
}

}  // namespace etendue
