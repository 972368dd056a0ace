#include "render/tiles.h"

#include <algorithm>
#include <random>
#include <utility>

namespace etendue {

std::vector<PixelRect> make_tiles(const PixelRect& window, std::uint32_t order_seed) {
    std::vector<PixelRect> tiles;
    for (int y = window.y0 / kTileSize * kTileSize; y < window.y1; y += kTileSize)
        for (int x = window.x0 / kTileSize * kTileSize; x < window.x1; x += kTileSize)
            tiles.push_back({std::max(x, window.x0), std::max(y, window.y0), std::min(x + kTileSize, window.x1),
                             std::min(y + kTileSize, window.y1)});
    if (order_seed != 0) {
        std::minstd_rand random(order_seed);
        for (std::size_t i = tiles.size(); i > 1; --i) std::swap(tiles[i - 1], tiles[random() % i]);
    }
    return tiles;
}

std::uint32_t pass_size(std::uint32_t done, std::uint32_t total) {
    constexpr std::uint32_t kLargest = 16;
    return std::min(std::clamp(done, 1u, kLargest), total - done);
}

std::uint32_t fit_pass(std::uint32_t wanted, std::uint32_t done, double seconds, double seconds_limit) {
    if (done == 0) return wanted;
    const double samples_left = (seconds_limit - seconds) * static_cast<double>(done) / std::max(seconds, 1e-9);
    return samples_left >= wanted ? wanted : static_cast<std::uint32_t>(std::max(1.0, samples_left));
}

}  // namespace etendue
