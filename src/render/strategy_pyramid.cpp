#include "render/strategy_pyramid.h"

#include "processor/ray_code.h"

#include <utility>

#include <fmt/format.h>

namespace etendue {

std::vector<Strategy> strategies_between(int shortest, int longest) {
    std::vector<Strategy> strategies;
    for (int edges = shortest; edges <= longest; ++edges)
        for (int s = 0; s <= edges; ++s)
            if (const Strategy strategy{s, edges + 1 - s}; strategy.exists()) strategies.push_back(strategy);
    return strategies;
}

std::vector<StrategyImage> render_strategies(const World& world, const IntegratorSettings& integrator,
                                             std::span<const Strategy> strategies, const RenderOptions& options,
                                             const ThreadPool& threads, const std::atomic<bool>& stop,
                                             const ProgressCallback& progress) {
    std::vector<StrategyImage> images;
    RenderProgress before;
    for (const Strategy& strategy : strategies) {
        IntegratorSettings one = integrator;
        one.strategy = strategy;
        RenderProgress now;
        const ProgressCallback report = [&](const RenderProgress& p) {
            now = {
                .fraction = (static_cast<double>(images.size()) + p.fraction) / static_cast<double>(strategies.size()),
                .seconds = before.seconds + p.seconds,
                .samples = before.samples + p.samples,
                .rays = before.rays + p.rays};
            if (progress) progress(now);
        };
        RenderResult result = render(world, *ray_code().make_integrator(one.type, one), options, threads, stop, report);
        if (result.halt_reason == HaltReason::Interrupted) break;
        images.push_back({strategy, rgba_image(result.film)});
        before = now;
    }
    return images;
}

std::vector<ImagePart> strategy_parts(std::span<const StrategyImage> images) {
    std::vector<ImagePart> parts;
    for (const auto& [strategy, rgba] : images)
        parts.push_back({strategy == kMerges ? "merges" : fmt::format("s{}t{}", strategy.s, strategy.t), &rgba});
    return parts;
}

}  // namespace etendue
