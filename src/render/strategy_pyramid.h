// The images of all strategies of bidirectional path tracing, one by one: the pyramid of Veach 1997, figure 10.4.
#pragma once

#include "image/image.h"
#include "image/write.h"
#include "integrator/integrator.h"
#include "render/render.h"

#include <span>
#include <string_view>
#include <vector>

namespace etendue {

/// All strategies that make paths of `shortest` to `longest` edges (without vertices in media), by length, then by the
/// vertices from the light.
[[nodiscard]] std::vector<Strategy> strategies_between(int shortest, int longest);

struct StrategyImage {
    Strategy strategy;
    ImageF rgba;  ///< red, green, blue and alpha of the render's window
};

/// Renders each of `strategies` by itself with the integrator that `integrator` names, which has strategies, and with
/// the same random numbers: weighted ones add up to its image, for one that merges together with `kMerges`. `progress`
/// is told of all of them as of one render. Once `stop` is true, those are returned that are finished.
[[nodiscard]] std::vector<StrategyImage> render_strategies(const World& world, const IntegratorSettings& integrator,
                                                           std::span<const Strategy> strategies,
                                                           const RenderOptions& options, const ThreadPool& threads,
                                                           const std::atomic<bool>& stop,
                                                           const ProgressCallback& progress);

/// A part of a file for each, named "s0t2" and so on, or "merges", with the pixels of `images`.
[[nodiscard]] std::vector<ImagePart> strategy_parts(std::span<const StrategyImage> images);

}  // namespace etendue
