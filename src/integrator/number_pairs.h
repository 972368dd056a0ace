// Pairs of random numbers for many paths at once.
#pragma once

#include "core/vector_bytes.h"
#include "sampling/sampler.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Keys of many samples, as the samplers want them.
class SampleKeys {
  public:
    void clear() {
        pixel_seeds_.clear();
        indices_.clear();
    }
    void push_back(SampleKey key) {
        pixel_seeds_.push_back(key.pixel_seed);
        indices_.push_back(key.index);
    }
    [[nodiscard]] std::size_t size() const { return indices_.size(); }
    [[nodiscard]] std::size_t bytes() const { return vector_bytes(pixel_seeds_, indices_); }
    [[nodiscard]] SampleKey operator[](std::size_t i) const { return {pixel_seeds_[i], indices_[i]}; }
    [[nodiscard]] std::span<const std::uint32_t> pixel_seeds() const { return pixel_seeds_; }
    [[nodiscard]] std::span<const std::uint32_t> indices() const { return indices_; }

  private:
    std::vector<std::uint32_t> pixel_seeds_;
    std::vector<std::uint32_t> indices_;
};

class NumberPairs {
  public:
    /// One pair of `dimension` for each key.
    void draw(SampleSequence sequence, const SampleKeys& keys, std::uint32_t dimension) {
        resize(keys.size());
        draw(sequence, keys, dimension, 0, keys.size());
    }
    /// Of keys [first, end) only; the others keep theirs.
    void draw(SampleSequence sequence, const SampleKeys& keys, std::uint32_t dimension, std::size_t first,
              std::size_t end) {
        const auto part = [&](auto all) { return all.subspan(first, end - first); };
        sample_2d(sequence, part(keys.pixel_seeds()), part(keys.indices()), dimension, part(std::span(x_)),
                  part(std::span(y_)));
    }
    void resize(std::size_t count) {
        x_.resize(count);
        y_.resize(count);
    }
    /// What nothing asks for: zeros take less time.
    void draw_none(std::size_t count) {
        x_.assign(count, 0.0f);
        y_.assign(count, 0.0f);
    }
    [[nodiscard]] Vec2f operator[](std::size_t i) const { return {x_[i], y_[i]}; }
    [[nodiscard]] std::size_t bytes() const { return vector_bytes(x_, y_); }

  private:
    std::vector<float> x_;
    std::vector<float> y_;
};

}  // namespace etendue
