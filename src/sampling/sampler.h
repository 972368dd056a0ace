// Where random numbers come from: a function of (seed, pixel, sample index, dimension) and of nothing else.
#pragma once

#include "core/vec.h"
#include "sampling/sobol.h"

#include <cstdint>
#include <span>

namespace etendue {

enum class SampleSequence {
    Sobol,   ///< padded pairs of Owen-scrambled Sobol' points
    Random,  ///< independent numbers, to compare against
};

/// Identifies one sample of one pixel.
struct SampleKey {
    std::uint32_t pixel_seed = 0;  ///< from `make_pixel_seed`
    std::uint32_t index = 0;       ///< which sample of the pixel
};

[[nodiscard]] constexpr std::uint32_t make_pixel_seed(std::uint32_t seed, std::uint32_t x, std::uint32_t y) {
    return hash_combine(hash_combine(hash_u32(seed), x), y);
}

/// Two numbers in [0, 1)² for `dimension`, an index of pairs. Pairs of different dimensions are independent; within
/// one, the samples of a pixel are well distributed in two dimensions.
[[nodiscard]] inline Vec2f sample_2d(SampleSequence sequence, SampleKey key, std::uint32_t dimension) {
    const std::uint32_t seed = hash_combine(key.pixel_seed, dimension);
    if (sequence == SampleSequence::Sobol) return owen_sobol_2d(key.index, seed);
    const std::uint32_t x = hash_combine(seed, key.index);
    return {to_unit_float(x), to_unit_float(hash_u32(x ^ 0x9e3779b9u))};
}

/// Gives two numbers in [0, 1)² to each of many samples at once: `x[i]`, `y[i]` are those of `dimension` and the key
/// (`pixel_seeds[i]`, `indices[i]`). All spans have one length. Several times as fast as one call per sample.
void sample_2d(SampleSequence sequence, std::span<const std::uint32_t> pixel_seeds,
               std::span<const std::uint32_t> indices, std::uint32_t dimension, std::span<float> x, std::span<float> y);

/// 32 random bits for `dimension`, unrelated to those of `sample_2d`.
[[nodiscard]] constexpr std::uint32_t sample_bits(SampleKey key, std::uint32_t dimension) {
    return hash_combine(hash_combine(key.pixel_seed ^ 0xa511e9b3u, dimension), key.index);
}

}  // namespace etendue
