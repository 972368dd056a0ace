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

/// Most samples of a pass.
inline constexpr std::uint32_t kLargestPass = 16;

/// Samples of the pass that begins with sample `first` < `end`: from 0 on 1, 1, 2, 4, 8, 16, 16, … so that the first
/// picture comes soon, stopping is prompt, and later passes fill their waves. They are cut at the same places wherever
/// a render begins and ends, so that parts of a render agree with the whole.
[[nodiscard]] std::uint32_t pass_size(std::uint32_t first, std::uint32_t end);

/// Returns true if one of the passes that `pass_size` makes begins with sample `first`.
[[nodiscard]] bool begins_pass(std::uint32_t first);

/// True for every other pass, by the sample that it begins with.
[[nodiscard]] bool is_odd_pass(std::uint32_t first);

/// Returns how many of the `wanted` samples fit before `seconds_limit`, at the pace of the first `done` ones, which
/// took `seconds`; at least 1.
[[nodiscard]] std::uint32_t fit_pass(std::uint32_t wanted, std::uint32_t done, double seconds, double seconds_limit);

}  // namespace etendue
