#include "denoise/regression.h"

#include "denoise/window_fit.h"

#include <optional>
#include <vector>

namespace etendue {

namespace {

struct Scratch {
    Scratch(const NlMeansSettings& settings, int feature_count)
        : weights(settings), fit(settings.radius, weights.row_stride(), feature_count) {}
    WindowWeights weights;
    WindowFit fit;
};

void regress_tile(const RegressionInput& input, const PixelRect& tile, Scratch& scratch, Planes& sums) {
    scratch.weights.compute(input.guide, tile);
    for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
            scratch.fit.fit(input.target, input.features, scratch.weights.window(x, y), x, y);
            scratch.fit.add_to(sums);
        }
    }
}

}  // namespace

Planes collaborative_regression(const RegressionInput& input, const NlMeansSettings& settings,
                                const ThreadPool& threads) {
    const int width = input.target.width();
    const int height = input.target.height();
    Planes sums(width, height, kFitChannels + 1);
    std::vector<std::optional<Scratch>> scratch(static_cast<std::size_t>(threads.thread_count()));
    // Windows reach into the next tiles. Every other tile of every other row at a time: those are a tile apart, which
    // is as far as the windows of two reach, so that no two threads write to one pixel and sums have a fixed order.
    for (int phase = 0; phase < 4; ++phase) {
        std::vector<PixelRect> tiles;
        for (const PixelRect& tile : denoise_tiles(width, height))
            if (tile.x0 / kDenoiseTileSide % 2 == phase % 2 && tile.y0 / kDenoiseTileSide % 2 == phase / 2)
                tiles.push_back(tile);
        threads.parallel_for(tiles.size(), [&](std::size_t index, int slot) {
            auto& own = scratch[static_cast<std::size_t>(slot)];
            if (!own) own.emplace(settings, input.features.count());
            regress_tile(input, tiles[index], *own, sums);
        });
    }
    return make_planes(width, height, kFitChannels,
                       [&](int plane, int x, int y) { return sums.row(plane, y)[x] / sums.row(kFitChannels, y)[x]; });
}

}  // namespace etendue
