// The sRGB curve (IEC 61966-2-1), for texels.
#pragma once

#include <array>
#include <cstdint>

namespace etendue {

/// From the curve to linear, both in [0, 1].
[[nodiscard]] float linear_from_srgb(float encoded);
/// From linear to the curve.
[[nodiscard]] float srgb_from_linear(float linear);

/// Linear values of the integers that stand for shares of 255.
using Decoding8 = std::array<float, 256>;
[[nodiscard]] const Decoding8& srgb_decoding8();
/// The same without the curve.
[[nodiscard]] const Decoding8& linear_decoding8();

/// Of an integer that stands for a share of 255 or 65535, from a table.
[[nodiscard]] inline float linear_from_srgb8(std::uint8_t encoded) {
    return srgb_decoding8()[encoded];
}
[[nodiscard]] float linear_from_srgb16(std::uint16_t encoded);

/// The integer nearest to `linear` under the curve; what is outside [0, 1] is clamped.
[[nodiscard]] std::uint8_t srgb8_from_linear(float linear);

}  // namespace etendue
