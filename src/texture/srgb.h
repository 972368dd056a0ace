// The sRGB curve (IEC 61966-2-1), for texels.
#pragma once

#include <cstdint>

namespace etendue {

/// From the curve to linear, both in [0, 1].
[[nodiscard]] float linear_from_srgb(float encoded);
/// From linear to the curve.
[[nodiscard]] float srgb_from_linear(float linear);

/// Of an integer that stands for a share of 255 or 65535, from a table.
[[nodiscard]] float linear_from_srgb8(std::uint8_t encoded);
[[nodiscard]] float linear_from_srgb16(std::uint16_t encoded);

/// The integer nearest to `linear` under the curve; what is outside [0, 1] is clamped.
[[nodiscard]] std::uint8_t srgb8_from_linear(float linear);

}  // namespace etendue
