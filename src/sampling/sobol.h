// The two-dimensional Sobol' sequence with hashed Owen scrambling.
//
// Scrambling: Laine and Karras, "Stratified Sampling for Stochastic Transparency" (EGSR 2011), section 3.1, with the
// improved constants of Vegdahl (2021); shuffling the index the same way decorrelates one use of the sequence from the
// next: Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.
#pragma once

#include "core/vec.h"
#include "sampling/hash.h"

#include <cstdint>

namespace etendue {

[[nodiscard]] constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// Owen scrambling of a number whose bits are reversed: every bit is flipped depending on the bits below it only.
[[nodiscard]] constexpr std::uint32_t owen_scramble_reversed(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Second dimension of the Sobol' sequence with its bits reversed: the index times the Pascal matrix modulo 2, by
/// halves.
[[nodiscard]] constexpr std::uint32_t sobol_second_reversed(std::uint32_t index) {
    index ^= (index >> 16);
    index ^= (index & 0xff00ff00u) >> 8;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xccccccccu) >> 2;
    index ^= (index & 0xaaaaaaaau) >> 1;
    return index;
}

/// Point `index` of a (0,2)-sequence in [0, 1)², scrambled and shuffled by `seed`.
[[nodiscard]] inline Vec2f owen_sobol_2d(std::uint32_t index, std::uint32_t seed) {
    const std::uint32_t shuffled = reverse_bits(owen_scramble_reversed(reverse_bits(index), seed));
    const std::uint32_t x = owen_scramble_reversed(shuffled, hash_u32(seed ^ 0x68bc21ebu));
    const std::uint32_t y = owen_scramble_reversed(sobol_second_reversed(shuffled), hash_u32(seed ^ 0x02e5be93u));
    return {to_unit_float(reverse_bits(x)), to_unit_float(reverse_bits(y))};
}

}  // namespace etendue
