// How an image is cut into tiles, and samples into passes.
#pragma once

#include "film/film.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace etendue {

/// Side of a tile in pixels: two samples of every pixel fill a wave of paths.
inline constexpr int kTileSize = 32;

/// Tiles of a grid that is anchored at the full image's origin, cut to `window`, row by row.
[[nodiscard]] std::vector<PixelRect> make_tiles(const PixelRect& window);

/// The numbers [0, count) in an order shuffled by `seed`, or in theirs if it is 0.
[[nodiscard]] std::vector<std::size_t> make_order(std::size_t count, std::uint32_t seed);

/// Most tiles to render with `spp` samples before their splats are added to the film, so that not many have to be held.
[[nodiscard]] std::size_t largest_splat_group(std::uint32_t spp);

/// Samples of the pass that begins after `done` of `total` samples: 1, 1, 2, 4, 8, 16, 16, … so that the first picture
/// comes soon, stopping is prompt, and later passes fill their waves. Depends on `done` only, so that a render that is
/// cut short agrees with the beginning of a longer one.
[[nodiscard]] std::uint32_t pass_size(std::uint32_t done, std::uint32_t total);

/// As many of the `wanted` samples as fit before `seconds_limit`, at the pace of the first `done` ones, which took
/// `seconds`; at least 1.
[[nodiscard]] std::uint32_t fit_pass(std::uint32_t wanted, std::uint32_t done, double seconds, double seconds_limit);

}  // namespace etendue
