#include "sampling/sobol.h"

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(ReverseBits, MirrorsTheWord) {
    EXPECT_EQ(reverse_bits(0u), 0u);
    EXPECT_EQ(reverse_bits(1u), 0x80000000u);
    EXPECT_EQ(reverse_bits(0x80000000u), 1u);
    EXPECT_EQ(reverse_bits(0x12345678u), 0x1e6a2c48u);
    for (std::uint32_t i = 0; i < 32; ++i) EXPECT_EQ(reverse_bits(1u << i), 1u << (31 - i));
    EXPECT_EQ(reverse_bits(reverse_bits(0xdeadbeefu)), 0xdeadbeefu);
}

/// The second dimension by its direction numbers: primitive polynomial x + 1, m_1 = 1 (Bratley and Fox, ACM TOMS 14(1),
/// 1988): v_{k+1} = v_k xor (v_k >> 1).
std::uint32_t sobol_second_by_direction_numbers(std::uint32_t index) {
    std::uint32_t direction = 0x80000000u;
    std::uint32_t result = 0;
    for (; index != 0; index >>= 1) {
        if ((index & 1u) != 0) result ^= direction;
        direction ^= direction >> 1;
    }
    return result;
}

TEST(SobolSecond, AgreesWithDirectionNumbers) {
    for (std::uint32_t index = 0; index < 100'000; ++index)
        ASSERT_EQ(reverse_bits(sobol_second_reversed(index)), sobol_second_by_direction_numbers(index));
    for (std::uint32_t index = 1; index != 0; index <<= 1) {
        ASSERT_EQ(reverse_bits(sobol_second_reversed(index)), sobol_second_by_direction_numbers(index));
        ASSERT_EQ(reverse_bits(sobol_second_reversed(~index)), sobol_second_by_direction_numbers(~index));
    }
}

using Points = std::function<Vec2f(std::uint32_t)>;

/// True if points [first, first + 2^log_count) leave exactly one in each of the 2^log_count cells of every shape.
bool is_net(const Points& points, std::uint32_t first, int log_count) {
    const std::uint32_t count = 1u << log_count;
    for (int log_width = 0; log_width <= log_count; ++log_width) {
        const std::uint32_t width = 1u << log_width;
        const std::uint32_t height = count / width;
        std::vector<int> hits(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec2f p = points(first + i);
            if (!(p.x >= 0.0f && p.x < 1.0f && p.y >= 0.0f && p.y < 1.0f)) return false;
            const auto x = static_cast<std::uint32_t>(p.x * static_cast<float>(width));
            const auto y = static_cast<std::uint32_t>(p.y * static_cast<float>(height));
            if (++hits[y * width + x] > 1) return false;
        }
    }
    return true;
}

Vec2f plain_sobol(std::uint32_t index) {
    return {to_unit_float(reverse_bits(index)), to_unit_float(reverse_bits(sobol_second_reversed(index)))};
}

// A (0,2)-sequence (Niederreiter 1992, definition 4.2): every block of 2^m points that starts at a multiple of 2^m is a
// (0,m,2)-net; prefixes are the first such block.
TEST(Sobol, IsAZeroTwoSequence) {
    for (int log_count = 0; log_count <= 12; ++log_count) {
        EXPECT_TRUE(is_net(plain_sobol, 0, log_count)) << log_count;
        EXPECT_TRUE(is_net(plain_sobol, 5u << log_count, log_count)) << log_count;
    }
}

TEST(OwenSobol, IsAZeroTwoSequenceForEverySeed) {
    for (const std::uint32_t seed : {0u, 1u, 2u, 0x12345678u, 0xffffffffu, 0xdeadbeefu})
        for (int log_count = 0; log_count <= 10; ++log_count) {
            const auto points = [=](std::uint32_t i) { return owen_sobol_2d(i, seed); };
            EXPECT_TRUE(is_net(points, 0, log_count)) << seed << " " << log_count;
            EXPECT_TRUE(is_net(points, 3u << log_count, log_count)) << seed << " " << log_count;
        }
}

TEST(OwenScramble, FlipsABitByLowerBitsOnly) {
    for (std::uint32_t bit = 0; bit < 32; ++bit)
        for (const std::uint32_t x : {0u, 0x9e3779b9u, 0x7f4a7c15u}) {
            const std::uint32_t below_and_bit = bit == 31 ? 0xffffffffu : (2u << bit) - 1u;
            const std::uint32_t changed_above = x ^ (~below_and_bit & 0xa5a5a5a5u);
            EXPECT_EQ(owen_scramble_reversed(x, 77) & below_and_bit,
                      owen_scramble_reversed(changed_above, 77) & below_and_bit);
        }
}

/// Variance over seeds of the estimate of `f`'s integral from `count` points.
double variance(const std::function<double(Vec2f)>& f, double integral, std::uint32_t count, bool owen) {
    constexpr std::uint32_t kSeeds = 200;
    double squares = 0.0;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        double sum = 0.0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t hash = hash_combine(hash_u32(seed), i);
            const Vec2f random{to_unit_float(hash), to_unit_float(hash_u32(hash + 1))};
            sum += f(owen ? owen_sobol_2d(i, hash_u32(seed)) : random);
        }
        const double error = sum / count - integral;
        squares += error * error;
    }
    return squares / kSeeds;
}

// Owen, "Scrambled Net Variance for Integrals of Smooth Functions" (1997): n^-3 log n against n^-1.
TEST(OwenSobol, VarianceFallsFasterThanThatOfRandomPoints) {
    const auto f = [](Vec2f u) {
        return std::exp(static_cast<double>(u.x)) * std::sin(3.0 * static_cast<double>(u.y));
    };
    const double integral = (std::exp(1.0) - 1.0) * (1.0 - std::cos(3.0)) / 3.0;
    const auto slope = [&](bool owen) {
        return std::log2(variance(f, integral, 1024, owen) / variance(f, integral, 64, owen)) / 4.0;
    };
    EXPECT_NEAR(slope(false), -1.0, 0.15);
    EXPECT_LT(slope(true), -2.5);
    EXPECT_LT(variance(f, integral, 256, true), 1e-2 * variance(f, integral, 256, false));
}

TEST(OwenSobol, IsUnbiased) {
    // The mean over seeds of a single point's estimate is the integral.
    double x = 0.0;
    double xy = 0.0;
    constexpr std::uint32_t kSeeds = 20'000;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const Vec2f p = owen_sobol_2d(3, hash_u32(seed));
        x += static_cast<double>(p.x) / kSeeds;
        xy += static_cast<double>(p.x * p.y) / kSeeds;
    }
    EXPECT_NEAR(x, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / kSeeds));
    EXPECT_NEAR(xy, 0.25, 4.0 * std::sqrt(7.0 / 144.0 / kSeeds));
}

}  // namespace

}  // namespace etendue
