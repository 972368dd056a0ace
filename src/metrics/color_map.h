// Colours for maps of one number per pixel.
#pragma once

#include "image/image.h"

#include <cstdint>
#include <span>

namespace etendue {

/// A colour as an sRGB display shows it.
struct DisplayColor {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;

    friend bool operator==(const DisplayColor&, const DisplayColor&) = default;
};

/// Paints the pixels that were left out of the measure: a green that the map has nowhere.
inline constexpr DisplayColor kLeftOutColor{0, 200, 80};

/// The colour of `value` in [0, 1] (clamped; NaN as 0) in the map "magma" by N. Smith and S. van der Walt (2015, CC0),
/// from black by purple to light yellow, of 256 steps; the one that maps of FLIP are published in.
[[nodiscard]] DisplayColor magma(float value);

/// `map`, which has one channel, from 0 to `largest` > 0 in colours: three channels in [0, 1] for an sRGB display.
/// Pixels with a mark other than 0 in `left_out` (one per pixel, or none at all) are painted in kLeftOutColor.
[[nodiscard]] ImageF paint_magma(const ImageF& map, double largest, std::span<const std::uint8_t> left_out = {});

}  // namespace etendue
