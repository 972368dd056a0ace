// Piecewise-constant densities on [0,1) and [0,1)², sampled by inverting their distribution function, which keeps the
// stratification of the numbers that go in.
#pragma once

#include "core/vec.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Density on [0,1) that is constant on n equal intervals. 4 bytes an interval, and 1 to 2 for where to begin to look
/// (the cutpoints of Chen and Asau, "On Generating Random Variates from an Empirical Distribution", 1974).
class Distribution1D {
  public:
    Distribution1D() = default;
    /// `weights` >= 0 and finite. If all are zero, the density is uniform.
    explicit Distribution1D(std::span<const float> weights);

    struct Sample {
        float x;
        float pdf;
        std::size_t index;
    };
    [[nodiscard]] Sample sample(float u) const;
    // Have what `sample` reads fetched from memory, in this order.
    void fetch_guide(float u) const;
    void fetch_interval(float u) const;
    [[nodiscard]] float pdf(float x) const;
    /// Has what `pdf` reads fetched, unless it goes across two lines of the cache.
    void fetch_pdf(float x) const;
    [[nodiscard]] std::size_t size() const { return size_; }
    /// Mean of the weights: the integral over [0,1) of the function that they describe.
    [[nodiscard]] double integral() const { return integral_; }

    [[nodiscard]] std::size_t bytes() const { return cdf_.size() * sizeof(float) + guide_.size() * sizeof(guide_[0]); }

  private:
    /// The interval that `u` falls into: as many values of cdf_ but the first are at most u, other than the last.
    [[nodiscard]] std::size_t find(float u) const;
    /// Returns the index of the entry of the guide with which `find` begins for `u`.
    [[nodiscard]] std::size_t start_of(float u) const;

    /// size() + 1 values from 0 to 1, and as many behind them as are compared at once.
    std::vector<float> cdf_;
    std::size_t size_ = 0;
    /// `find` of the multiples of a power of two's inverse, from 0 to 1.
    std::vector<std::uint32_t> guide_;
    double integral_ = 0.0;
};

/// Density on [0,1)² that is constant on width × height cells: a marginal over rows, then a conditional within the row.
class Distribution2D {
  public:
    Distribution2D() = default;
    /// `weights` row by row, >= 0 and finite.
    Distribution2D(std::span<const float> weights, int width, int height);

    struct Sample {
        Vec2f position;
        float pdf;
    };
    [[nodiscard]] Sample sample(Vec2f u) const;
    /// Samples the density with each of the numbers `u`, as many as there are `samples`: what each look-up reads is on
    /// its way while the others are looked at.
    void sample(std::span<const Vec2f> u, std::span<Sample> samples) const;
    [[nodiscard]] float pdf(Vec2f position) const;
    /// Has most of what `pdf` reads fetched from memory.
    void fetch_pdf(Vec2f position) const { row(position.y).fetch_pdf(position.x); }
    [[nodiscard]] double integral() const { return marginal_.integral(); }
    [[nodiscard]] std::size_t bytes() const;

  private:
    [[nodiscard]] const Distribution1D& row(float y) const;

    std::vector<Distribution1D> rows_;
    Distribution1D marginal_;
};

}  // namespace etendue
