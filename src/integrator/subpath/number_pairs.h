// Pairs of random numbers for many paths at once.
#pragma once

#include "sampling/sampler.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

class NumberPairs {
  public:
    /// One pair of `dimension` for each key (`pixel_seeds[i]`, `indices[i]`).
    void draw(SampleSequence sequence, std::span<const std::uint32_t> pixel_seeds,
              std::span<const std::uint32_t> indices, std::uint32_t dimension) {
        x_.resize(pixel_seeds.size());
        y_.resize(pixel_seeds.size());
        sample_2d(sequence, pixel_seeds, indices, dimension, x_, y_);
    }
    [[nodiscard]] Vec2f operator[](std::size_t i) const { return {x_[i], y_[i]}; }

  private:
    std::vector<float> x_;
    std::vector<float> y_;
};

}  // namespace etendue
