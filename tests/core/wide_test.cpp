#include "core/wide.h"

#include "core/frame.h"
#include "core/position_error.h"
#include "core/ray.h"
#include "core/rgb.h"
#include "core/trigonometry.h"
#include "core/wide_bits.h"
#include "support/lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

template <typename T, std::size_t N>
Imath::Vec3<T> vec(const std::array<T, N>& in, std::size_t first) {
    return {in[first], in[first + 1], in[first + 2]};
}

TEST(Wide, OperatorsAreThoseOfFloat) {
    EXPECT_EQ((largest_lane_difference<2>(-2.0f, 2.0f,
                                          [](const auto& in) {
                                              const auto a = in[0];
                                              const auto b = in[1];
                                              return std::array{a + b, a - b,     a * b,     a / b,
                                                                -a,    min(a, b), max(a, b), abs(a)};
                                          })),
              0.0f);
    EXPECT_EQ((largest_lane_difference<2>(-2.0f, 2.0f,
                                          [](const auto& in) {
                                              return std::array{sqrt(abs(in[0])), copysign(in[0], in[1]), sqrt(in[1])};
                                          })),
              0.0f);
}

TEST(Wide, SelectsByComparisons) {
    EXPECT_EQ((largest_lane_difference<2>(-2.0f, 2.0f,
                                          [](const auto& in) {
                                              const auto a = in[0];
                                              const auto b = in[1];
                                              const auto half = in[0] * 0.5f;
                                              return std::array{select(a < b, a, b),
                                                                select(a > b, a, b),
                                                                select(a <= a, a, b),
                                                                select(a >= half, a, b),
                                                                select(a == a, a, b),
                                                                select(a == b, a, b),
                                                                select(!(a < b), a, b),
                                                                select(a < b && b < half, a, b),
                                                                select(a < b || b < half, a, b)};
                                          })),
              0.0f);
}

TEST(Wide, FunctionsAreThoseOfFloat) {
    EXPECT_EQ((largest_lane_difference<3>(-2.0f, 2.0f,
                                          [](const auto& in) {
                                              const auto a = in[0];
                                              return std::array{floor(a), clamp(a, in[1], in[1] + 1.0f)};
                                          })),
              0.0f);
    EXPECT_LE((largest_lane_difference<1>(0.0f, 1.0f,
                                          [](const auto& in) {
                                              const auto angle = sin_cos_turns(in[0]);
                                              return std::array{angle.sin, angle.cos};
                                          })),
              4.0f);
}

/// Largest error of `wide` next to `exact`, in units of the epsilon times its size, over numbers of all sizes from
/// 2^`low` to 2^`high`.
template <typename Function, typename Exact>
double largest_error(float low, float high, const Function& wide, const Exact& exact) {
    double largest = 0.0;
    for (float power = low; power < high; power += 1.0f / 512.0f) {
        const float x = std::exp2(power);
        const auto expected = exact(static_cast<double>(x));
        const double difference = std::abs(static_cast<double>(wide(Wide(x))[0]) - expected);
        largest = std::max(largest, difference / (std::abs(expected) * std::numeric_limits<float>::epsilon()));
    }
    return largest;
}

TEST(Wide, LogarithmsAndExponentialsHaveAllDigitsOfFloats) {
    const auto wide_log = [](Wide x) { return log(x); };
    const auto exact_log = [](double x) { return std::log(x); };
    EXPECT_LE(largest_error(-126.0f, -0.01f, wide_log, exact_log), 3.0);
    EXPECT_LE(largest_error(0.01f, 127.0f, wide_log, exact_log), 3.0);
    for (float x : {0x1p-23f, -0x1p-24f, 1e-5f, -1e-5f, 1e-3f, -1e-3f}) {
        x += 1.0f;
        const double exact = std::log(static_cast<double>(x));
        EXPECT_NEAR(static_cast<double>(log(Wide(x))[0]) / exact, 1.0, 4e-7) << x;
    }
    const auto wide_log2 = [](Wide x) { return log2(x); };
    const auto exact_log2 = [](double x) { return std::log2(x); };
    EXPECT_LE(largest_error(-126.0f, -0.01f, wide_log2, exact_log2), 3.0);
    EXPECT_LE(largest_error(0.01f, 127.0f, wide_log2, exact_log2), 3.0);
    EXPECT_LE(largest_error(
                  -100.0f, 6.4f, [](Wide x) { return expm1(x); }, [](double x) { return std::expm1(x); }),
              3.0);
    EXPECT_LE(largest_error(
                  -100.0f, 6.4f, [](Wide x) { return expm1(-x); }, [](double x) { return std::expm1(-x); }),
              3.0);
}

TEST(Wide, LogarithmsOfWhatHasNoneAreThoseOfFloat) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float x : {0.0f, -0.0f, -1.0f, -kInfinity, kInfinity, std::numeric_limits<float>::quiet_NaN(), 1.0f})
        for (const auto& [found, expected] :
             {std::pair(log(Wide(x))[0], std::log(x)), std::pair(log2(Wide(x))[0], std::log2(x))})
            EXPECT_TRUE(found == expected || (std::isnan(found) && std::isnan(expected))) << x << " gives " << found;
    EXPECT_TRUE(std::isnan(expm1(Wide(std::numeric_limits<float>::quiet_NaN()))[0]));
    EXPECT_EQ(expm1(Wide(0.0f))[0], 0.0f);
    EXPECT_EQ(expm1(Wide(-kInfinity))[0], -1.0f);
}

TEST(Wide, ReversesBits) {
    std::array<std::uint32_t, Wide::kWidth> bits;
    for (std::uint32_t bit = 0; bit < 32; ++bit) {
        for (std::uint32_t lane = 0; lane < Wide::kWidth; ++lane) bits[lane] = (1u << bit) | (bit * lane);
        std::array<std::uint32_t, Wide::kWidth> reversed;
        reverse_bits(WideBits::load(bits.data())).store_unaligned(reversed.data());
        for (std::size_t lane = 0; lane < Wide::kWidth; ++lane) {
            std::uint32_t expected = 0;
            for (std::uint32_t b = 0; b < 32; ++b) expected |= ((bits[lane] >> b) & 1u) << (31 - b);
            EXPECT_EQ(reversed[lane], expected) << bit << ", " << lane;
        }
    }
}

TEST(Wide, GathersFromTables) {
    constexpr std::array kTable{2.0f, 3.0f, 5.0f, 7.0f};
    EXPECT_EQ((largest_lane_difference<1>(
                  0.0f, 4.0f, [&](const auto& in) { return std::array{gather(kTable.data(), floor(in[0]))}; })),
              0.0f);
    EXPECT_EQ(gather(kTable.data(), 2.0f), 5.0f);
}

TEST(Wide, CompressesAndExpandsWhatIsKept) {
    std::array<float, Wide::kWidth> numbers;
    std::array<std::uint32_t, Wide::kWidth> bits;
    for (std::size_t lane = 0; lane < Wide::kWidth; ++lane) {
        numbers[lane] = static_cast<float>(lane + 1);
        bits[lane] = 0xff800000u + static_cast<std::uint32_t>(lane);  // as floats none are numbers
    }
    for (std::uint32_t pattern = 0; pattern < 1u << Wide::kWidth; pattern += 1u + pattern / 64u) {
        std::array<float, Wide::kWidth> is_kept;
        for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
            is_kept[lane] = static_cast<float>((pattern >> lane) & 1u);
        const WideMask mask = Wide::load_unaligned(is_kept.data()) != Wide(0.0f);
        std::array<float, Wide::kWidth> kept;
        std::array<std::uint32_t, Wide::kWidth> kept_bits;
        compress(Wide::load_unaligned(numbers.data()), mask).store_unaligned(kept.data());
        compress(WideBits::load(bits.data()), mask).store_unaligned(kept_bits.data());
        std::size_t next = 0;
        for (std::size_t lane = 0; lane < Wide::kWidth; ++lane) {
            if (is_kept[lane] == 0.0f) continue;
            EXPECT_EQ(kept[next], numbers[lane]);
            EXPECT_EQ(kept_bits[next++], bits[lane]);
        }
        EXPECT_EQ(count(mask), next);
        const Wide expanded = expand(Wide::load_unaligned(kept.data()), mask, Wide(-1.0f));
        for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
            EXPECT_EQ(expanded[lane], is_kept[lane] != 0.0f ? numbers[lane] : -1.0f);
    }
}

TEST(Wide, TheFirstLanesAreThoseBeforeANumber) {
    for (std::size_t lanes = 0; lanes <= 2 * Wide::kWidth; ++lanes)
        for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
            EXPECT_EQ(WideMask::first(lanes)[lane], lane < lanes) << lanes;
}

TEST(Wide, BitsAreSelectedAndCompared) {
    std::array<std::uint32_t, Wide::kWidth> bits;
    for (std::size_t lane = 0; lane < Wide::kWidth; ++lane) bits[lane] = static_cast<std::uint32_t>(lane % 3);
    const WideBits all = WideBits::load(bits.data());
    std::array<std::uint32_t, Wide::kWidth> selected;
    select(all != WideBits(1u), all, WideBits(0x7fc00001u)).store_unaligned(selected.data());
    for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
        EXPECT_EQ(selected[lane], bits[lane] != 1u ? bits[lane] : 0x7fc00001u);
}

TEST(Wide, ChoosesWhatIsAskedFor) {
    EXPECT_EQ((largest_lane_difference<2>(-1.0f, 1.0f,
                                          [](const auto& in) {
                                              const auto a = in[0];
                                              const auto b = in[1];
                                              const auto first = [&] { return a; };
                                              const auto second = [&] { return b; };
                                              return std::array{choose(a < b, first, second),
                                                                choose(a < a, first, second),
                                                                choose(a <= a, first, second)};
                                          })),
              0.0f);
    int calls = 0;
    const auto counted = [&] {
        ++calls;
        return 1.0f;
    };
    EXPECT_EQ(choose(true, counted, [] { return 2.0f; }), 1.0f);
    EXPECT_EQ(choose(false, counted, [] { return 2.0f; }), 2.0f);
    EXPECT_EQ(calls, 1);
}

TEST(Wide, WhatIsNoNumberIsAsInTheStandardLibrary) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(max(Wide(1.0f), Wide(nan))[0], std::max(1.0f, nan));
    EXPECT_EQ(min(Wide(1.0f), Wide(nan))[0], std::min(1.0f, nan));
    EXPECT_TRUE(std::isnan(max(Wide(nan), Wide(1.0f))[0]));
    EXPECT_TRUE(std::isnan(min(Wide(nan), Wide(1.0f))[0]));
    EXPECT_TRUE(std::signbit(min(Wide(-0.0f), Wide(0.0f))[0]));
    EXPECT_FALSE(std::signbit(min(Wide(0.0f), Wide(-0.0f))[0]));
    EXPECT_TRUE((Wide(nan) != Wide(nan))[0]);
    EXPECT_FALSE((Wide(nan) == Wide(nan))[0]);
    EXPECT_EQ(select(Wide(nan) > Wide(0.0f), Wide(1.0f), Wide(2.0f))[0], 2.0f);
    EXPECT_EQ(copysign(Wide(1.0f), Wide(-0.0f))[0], -1.0f);
}

TEST(Wide, VectorsAndFrames) {
    EXPECT_LE((largest_lane_difference<6>(
                  -1.0f, 1.0f,
                  [](const auto& in) {
                      const auto a = normalize(vec(in, 0));
                      const auto b = vec(in, 3);
                      const auto frame = BasicFrame<std::decay_t<decltype(a.x)>>::from_normal(a);
                      const auto local = frame.to_local(b);
                      const auto world = frame.to_world(b);
                      const auto across = cross(a, b);
                      return std::array{frame.tangent.x, frame.tangent.y, frame.bitangent.x, frame.bitangent.y, local.x,
                                        local.y,         local.z,         world.x,           world.y,           world.z,
                                        across.x,        dot(a, b),       abs_dot(a, b),     max_abs(b)};
                  })),
              8.0f);
    EXPECT_LE(
        (largest_lane_difference<6>(
            -1.0f, 1.0f,
            [](const auto& in) {
                const auto n = triangle_normal(vec(in, 0), vec(in, 3));
                // Of thin triangles the normal is that of what cancels out.
                const auto thin = length_squared(cross(vec(in, 0), vec(in, 3)));
                const auto counts = thin * 0.0f + 0.01f < thin;
                const auto zero = thin * 0.0f;
                return std::array{select(counts, n.x, zero), select(counts, n.y, zero), select(counts, n.z, zero)};
            })),
        64.0f);
}

TEST(Wide, OriginsAndTheirClearance) {
    EXPECT_LE((largest_lane_difference<10>(
                  -1.0f, 1.0f,
                  [](const auto& in) {
                      const auto off = offset_origin(vec(in, 0), vec(in, 3), in[9], vec(in, 6));
                      const auto extent = max_components(abs_components(vec(in, 0)), vec(in, 3));
                      return std::array{off.x, off.y, off.z, clearance(vec(in, 6), position_error(extent)) * 1e6f};
                  })),
              4.0f);
}

TEST(Wide, Colors) {
    EXPECT_LE((largest_lane_difference<7>(
                  -1.0f, 1.0f,
                  [](const auto& in) {
                      const BasicRgb a{in[0], in[1], in[2]};
                      const BasicRgb b{in[3], in[4], in[5]};
                      const auto c = (a + b) * a - b * in[6];
                      return std::array{c.r, c.g, c.b, max_component(a), select(is_black(a * 0.0f), in[0], in[1])};
                  })),
              2.0f);
}

TEST(Wide, SineAndCosine) {
    EXPECT_LE((largest_lane_difference<1>(-0.78f, 0.78f,
                                          [](const auto& in) {
                                              const auto angle = sin_cos_octant(in[0]);
                                              return std::array{angle.sin, angle.cos};
                                          })),
              1.0f);
}

}  // namespace

}  // namespace etendue::test
