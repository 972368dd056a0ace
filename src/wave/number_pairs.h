// Pairs of random numbers for many paths at once.
#pragma once

#include "core/vec.h"
#include "core/vector_bytes.h"
#include "core/wide.h"
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
    /// Draws a pair of `dimension` for each key.
    void draw(SampleSequence sequence, const SampleKeys& keys, std::uint32_t dimension) {
        draw(sequence, keys.pixel_seeds(), keys.indices(), dimension);
    }
    void draw(SampleSequence sequence, std::span<const std::uint32_t> pixel_seeds,
              std::span<const std::uint32_t> indices, std::uint32_t dimension) {
        resize(indices.size());
        const auto part = [&](auto& all) { return std::span(all).first(indices.size()); };
        sample_2d(sequence, pixel_seeds, indices, dimension, part(x_), part(y_));
    }
    /// Draws a pair of `dimension` for keys [first, end) only; other keys keep their pairs.
    void draw(SampleSequence sequence, const SampleKeys& keys, std::uint32_t dimension, std::size_t first,
              std::size_t end) {
        const auto part = [&](auto all) { return all.subspan(first, end - first); };
        sample_2d(sequence, part(keys.pixel_seeds()), part(keys.indices()), dimension, part(std::span(x_)),
                  part(std::span(y_)));
    }
    void resize(std::size_t count) {
        x_.resize(whole(count));
        y_.resize(whole(count));
    }
    /// Fills `count` pairs that nothing asks for with zeros, which takes less time than drawing.
    void draw_none(std::size_t count) {
        x_.assign(whole(count), 0.0f);
        y_.assign(whole(count), 0.0f);
    }
    [[nodiscard]] Vec2f operator[](std::size_t i) const { return {x_[i], y_[i]}; }
    /// Returns the pairs of `Wide::kWidth` keys from `first`, a multiple of that width, on; lanes behind the last key
    /// mean nothing.
    [[nodiscard]] Imath::Vec2<Wide> load(std::size_t first) const {
        return {Wide::load_unaligned(&x_[first]), Wide::load_unaligned(&y_[first])};
    }
    [[nodiscard]] std::size_t bytes() const { return vector_bytes(x_, y_); }

  private:
    [[nodiscard]] static constexpr std::size_t whole(std::size_t count) {
        return (count + Wide::kWidth - 1) / Wide::kWidth * Wide::kWidth;
    }

    std::vector<float> x_;
    std::vector<float> y_;
};

}  // namespace etendue
