// Integer hashes: the source of every seed. Pure functions, so that a sample depends on nothing but its key. Templates
// of how many are computed at once: std::uint32_t, or WideBits (core/wide_bits.h).
#pragma once

#include <concepts>
#include <cstdint>

namespace etendue {

/// 32 bits once or many times; no other integers, which would be hashed otherwise.
template <typename T>
concept HashBits = std::same_as<T, std::uint32_t> || !std::integral<T>;

/// A bijection of 32 bits with low bias (constants of the "lowbias32" search by Chris Wellons, 2018).
template <HashBits Bits>
[[nodiscard]] constexpr Bits hash_u32(Bits x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

/// Hash of a sequence of two; chain it for more.
template <HashBits Bits>
[[nodiscard]] constexpr Bits hash_combine(Bits seed, std::uint32_t value) {
    return hash_u32(seed ^ (Bits(value * 0x9e3779b9u + 0x7f4a7c15u) + (seed << 6) + (seed >> 2)));
}

/// The upper 24 bits as a float in [0, 1).
[[nodiscard]] constexpr float to_unit_float(std::uint32_t x) {
    return static_cast<float>(x >> 8) * 0x1p-24f;
}

}  // namespace etendue
