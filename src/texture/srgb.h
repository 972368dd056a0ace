// The sRGB curve (IEC 61966-2-1), for texels.
#pragma once

#include <array>
#include <cstdint>

namespace etendue {

/// Converts a value in [0, 1] from the curve to linear.
[[nodiscard]] float linear_from_srgb(float encoded);
/// Converts a value from linear to the curve.
[[nodiscard]] float srgb_from_linear(float linear);

/// Linear values of the integers that stand for shares of 255.
using Decoding8 = std::array<float, 256>;
[[nodiscard]] const Decoding8& srgb_decoding8();
/// Returns the linear values of integers that stand for shares of 255 without the curve.
[[nodiscard]] const Decoding8& linear_decoding8();

/// Returns the linear value of an integer that stands for a share of 255 under the curve, from a table.
[[nodiscard]] inline float linear_from_srgb8(std::uint8_t encoded) {
    return srgb_decoding8()[encoded];
}
/// Returns the linear value of an integer that stands for a share of 65535 under the curve, from a table.
[[nodiscard]] float linear_from_srgb16(std::uint16_t encoded);

/// The integer nearest to `linear` under the curve; what is outside [0, 1] is clamped.
[[nodiscard]] std::uint8_t srgb8_from_linear(float linear);

}  // namespace etendue
