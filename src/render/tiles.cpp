#include "render/tiles.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <random>
#include <utility>

namespace etendue {

namespace {

/// Returns where the tile begins in which `pixel` lies.
int start_of_tile(int pixel) {
    const int tiles = pixel / kTileSize - (pixel % kTileSize < 0 ? 1 : 0);
    return tiles * kTileSize;
}

}  // namespace

std::vector<PixelRect> make_tiles(const PixelRect& window) {
    std::vector<PixelRect> tiles;
    for (int y = start_of_tile(window.y0); y < window.y1; y += kTileSize)
        for (int x = start_of_tile(window.x0); x < window.x1; x += kTileSize)
            tiles.push_back({std::max(x, window.x0), std::max(y, window.y0), std::min(x + kTileSize, window.x1),
                             std::min(y + kTileSize, window.y1)});
    return tiles;
}

std::vector<std::size_t> make_order(std::size_t count, std::uint32_t seed) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (seed == 0) return order;
    std::minstd_rand random(seed);
    for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    return order;
}

std::size_t largest_splat_group(std::uint32_t spp) {
    constexpr std::size_t kSamples = std::size_t{1} << 20;
    constexpr std::size_t kTileArea = std::size_t{kTileSize} * kTileSize;
    return std::max<std::size_t>(1, kSamples / (kTileArea * spp));
}

std::uint32_t pass_size(std::uint32_t first, std::uint32_t end) {
    const std::uint32_t next =
        first < kLargestPass ? std::bit_ceil(first + 1) : (first / kLargestPass + 1) * kLargestPass;
    return std::min(next, end) - first;
}

bool begins_pass(std::uint32_t first) {
    return first == 0 || pass_size(first - 1, first + 1) == 1;
}

bool is_odd_pass(std::uint32_t first) {
    // Those before kLargestPass begin at powers of two, the others at its multiples: 1, 4, 16, 48, 80, …
    static_assert(std::bit_width(kLargestPass / 2) % 2 == 0, "the first large pass differs from the one before");
    const std::uint32_t number =
        first < kLargestPass ? static_cast<std::uint32_t>(std::bit_width(first)) : first / kLargestPass;
    return number % 2 != 0;
}

std::uint32_t fit_pass(std::uint32_t wanted, std::uint32_t done, double seconds, double seconds_limit) {
    if (done == 0) return wanted;
    const double samples_left = (seconds_limit - seconds) * static_cast<double>(done) / std::max(seconds, 1e-9);
    return samples_left >= wanted ? wanted : static_cast<std::uint32_t>(std::max(1.0, samples_left));
}

}  // namespace etendue
