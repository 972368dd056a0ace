#include "compare/comparison_images.h"

#include "image/write.h"
#include "metrics/color_map.h"
#include "metrics/pixel_selection.h"
#include "picture/render_setup.h"
#include "render/strategy_pyramid.h"
#include "session/interrupt.h"
#include "session/progress_display.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Share of the pixels that a map of relMSE shows below its last colour: the rest is fireflies.
constexpr double kMapQuantile = 0.95;

constexpr int kStrategyWidth = 240;  // pixels
constexpr std::uint32_t kStrategySpp = 8;

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

/// The variant's image with fewer pixels.
RenderOptions small_options(const Variant& variant) {
    RenderOptions options = variant.sampling;
    const double scale = std::min(1.0, static_cast<double>(kStrategyWidth) / options.window.width());
    const auto scaled = [scale](int pixels) { return std::max(1, static_cast<int>(pixels * scale)); };
    const auto corner = [scale](int pixels) { return static_cast<int>(std::floor(pixels * scale)); };
    const PixelRect& window = variant.sampling.window;
    options.full_width = scaled(options.full_width);
    options.full_height = scaled(options.full_height);
    options.window =
        moved_to({0, 0, scaled(window.width()), scaled(window.height())}, corner(window.x0), corner(window.y0));
    options.spp = kStrategySpp;
    options.time_limit_seconds = 0.0;
    return options;
}

double mean_luminance(const ImageF& rgba, const Rgb& weights) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 3 < rgba.pixels.size(); i += 4)
        sum += static_cast<double>(rgba.pixels[i] * weights.r + rgba.pixels[i + 1] * weights.g +
                                   rgba.pixels[i + 2] * weights.b);
    const std::size_t pixels = rgba.pixels.size() / 4;
    return sum / static_cast<double>(pixels);
}

}  // namespace

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

bool add_strategies(ReportImages& images, ComparisonReport& report, const Variant& variant, int longest,
                    const DisplayView& view, const MeasureContext& context, bool quiet) {
    const RenderOptions options = small_options(variant);
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
    const Rgb weights = context.colors.luminance_weights(report.working_space);
    StrategiesReport result{.variant = variant.name, .spp = options.spp, .longest = longest};
    for (const Strategy& strategy : wanted) result.strategies.push_back({.s = strategy.s, .t = strategy.t});
    ReportImages made;
    for (const bool weighted : {true, false}) {
        integrator.weighted = weighted;
        const char* name = weighted ? "weighted" : "unweighted";
        ProgressDisplay display(fmt::format("{} strategies of {}", name, variant.name), quiet);
        const std::vector<StrategyImage> strategies =
            render_strategies(*variant.world, integrator, wanted, options, context.threads, interrupt_requested(),
                              [&](const RenderProgress& progress) { display.update(progress); });
        if (strategies.size() < wanted.size()) return false;
        for (std::size_t i = 0; i < strategies.size(); ++i) {
            const ImageF& image = strategies[i].rgba;
            made[fmt::format("strategy/{}/{},{}", name, wanted[i].s, wanted[i].t)] =
                encode_png(display_image(image, view, context.colors));
            (weighted ? result.strategies[i].weighted_mean : result.strategies[i].unweighted_mean) =
                mean_luminance(image, weights);
        }
    }
    images.merge(made);
    report.strategies = std::move(result);
    return true;
}

}  // namespace etendue
