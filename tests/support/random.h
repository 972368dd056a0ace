// Random numbers for tests, from a generator that shares nothing with the ones under test.
#pragma once

#include "core/vec.h"

#include <cstdint>
#include <random>

namespace etendue::test {

/// Uniform numbers in [0, 1) with 24 bits; the same ones for the same seed on every machine.
class Random {
  public:
    explicit Random(std::uint32_t seed) : generator_(seed) {}

    [[nodiscard]] float next() { return static_cast<float>(generator_() >> 8) * 0x1p-24f; }
    [[nodiscard]] Vec2f next_2d() {
        const float x = next();
        return {x, next()};
    }

  private:
    std::mt19937 generator_;
};

}  // namespace etendue::test
