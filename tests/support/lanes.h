// Whether a template of a lane type says the same of many numbers at once as of one after the other.
#pragma once

#include "core/wide.h"
#include "support/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace etendue::test {

/// Calls `function` with `Inputs` random numbers from [low, high), as an array of floats for each lane and as one of
/// `Wide` for all of them, at least 100,000 times each. `function` gives an array of its lane type. Returns the largest
/// difference of any number, in units of the machine epsilon times its size or 1, whichever is more: where the compiler
/// contracts products and sums in another way, what cancels out differs by roundings of what it was made from.
template <std::size_t Inputs, typename Function>
[[nodiscard]] float largest_lane_difference(float low, float high, const Function& function) {
    constexpr std::size_t kCalls = 100'000;
    Random random(20);
    float largest = 0.0f;
    for (std::size_t call = 0; call < kCalls; call += Wide::kWidth) {
        std::array<std::array<float, Inputs>, Wide::kWidth> single{};
        std::array<Wide, Inputs> wide{};
        for (std::size_t i = 0; i < Inputs; ++i) {
            alignas(Wide::kAlignment) std::array<float, Wide::kWidth> lanes{};
            for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
                lanes[lane] = single[lane][i] = low + (high - low) * random.next();
            wide[i] = Wide::load(lanes.data());
        }
        const auto at_once = function(wide);
        for (std::size_t lane = 0; lane < Wide::kWidth; ++lane) {
            const auto expected = function(single[lane]);
            for (std::size_t o = 0; o < expected.size(); ++o) {
                const float value = at_once[o][lane];
                if (value == expected[o] || (std::isnan(value) && std::isnan(expected[o]))) continue;
                const float unit = std::numeric_limits<float>::epsilon() * std::max(1.0f, std::abs(expected[o]));
                const float difference = std::abs(value - expected[o]) / unit;
                if (!std::isfinite(difference)) return std::numeric_limits<float>::infinity();
                largest = std::max(largest, difference);
            }
        }
    }
    return largest;
}

}  // namespace etendue::test
