// The two-dimensional Sobol' sequence with hashed Owen scrambling.
//
// Scrambling: Laine and Karras, "Stratified Sampling for Stochastic Transparency" (EGSR 2011), section 3.1, with the
// improved constants of Vegdahl (2021); shuffling the index the same way decorrelates one use of the sequence from the
// next: Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.
#pragma once

#include "core/vec.h"
#include "sampling/hash.h"

#include <cstdint>
#include <type_traits>

namespace etendue {

template <HashBits Bits>
[[nodiscard]] constexpr Bits reverse_bits(Bits x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// Owen scrambling of a number whose bits are reversed: every bit is flipped depending on the bits below it only.
template <HashBits Bits>
[[nodiscard]] constexpr Bits owen_scramble_reversed(Bits x, const std::type_identity_t<Bits>& seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Second dimension of the Sobol' sequence with its bits reversed: the index times the Pascal matrix modulo 2, by
/// halves.
template <HashBits Bits>
[[nodiscard]] constexpr Bits sobol_second_reversed(Bits index) {
    index ^= (index >> 16);
    index ^= (index & 0xff00ff00u) >> 8;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xccccccccu) >> 2;
    index ^= (index & 0xaaaaaaaau) >> 1;
    return index;
}

/// 32 bits of each coordinate of a point.
template <HashBits Bits>
struct PointBits {
    Bits x, y;
};

/// Point `index` of a (0,2)-sequence, scrambled and shuffled by `seed`.
template <HashBits Bits>
[[nodiscard]] constexpr PointBits<Bits> owen_sobol_bits(Bits index, Bits seed) {
    const Bits shuffled = reverse_bits(owen_scramble_reversed(reverse_bits(index), seed));
    const Bits x = owen_scramble_reversed(shuffled, hash_u32(seed ^ 0x68bc21ebu));
    const Bits y = owen_scramble_reversed(sobol_second_reversed(shuffled), hash_u32(seed ^ 0x02e5be93u));
    return {reverse_bits(x), reverse_bits(y)};
}

/// Returns point `index` of a (0,2)-sequence in [0, 1)², scrambled and shuffled by `seed`.
[[nodiscard]] inline Vec2f owen_sobol_2d(std::uint32_t index, std::uint32_t seed) {
    const PointBits<std::uint32_t> point = owen_sobol_bits(index, seed);
    return {to_unit_float(point.x), to_unit_float(point.y)};
}

}  // namespace etendue
