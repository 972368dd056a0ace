#include "texture/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace etendue {

namespace {

double decode(double v) {
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// `values[i]` is what the integer i + `shift` of [0, largest] decodes to.
template <typename Values>
Values decode_all(Values values, double shift, double largest) {
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(decode((static_cast<double>(i) + shift) / largest));
    return values;
}

}  // namespace

float linear_from_srgb(float encoded) {
    return static_cast<float>(decode(static_cast<double>(encoded)));
}

float srgb_from_linear(float linear) {
    const auto v = static_cast<double>(linear);
    return static_cast<float>(v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055);
}

const Decoding8& srgb_decoding8() {
    static const Decoding8 table = decode_all(Decoding8{}, 0.0, 255.0);
    return table;
}

const Decoding8& linear_decoding8() {
    static const Decoding8 table = [] {
        Decoding8 shares{};
        for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = static_cast<float>(i) * (1.0f / 255.0f);
        return shares;
    }();
    return table;
}

float linear_from_srgb16(std::uint16_t encoded) {
    static const std::vector<float> table = decode_all(std::vector<float>(65536), 0.0, 65535.0);
    return table[encoded];
}

std::uint8_t srgb8_from_linear(float linear) {
    // Halfway under the curve between an integer and the next: mip chains encode millions of texels.
    static const std::array<float, 255> bounds = decode_all(std::array<float, 255>{}, 0.5, 255.0);
    return static_cast<std::uint8_t>(std::upper_bound(bounds.begin(), bounds.end(), linear) - bounds.begin());
}

}  // namespace etendue
