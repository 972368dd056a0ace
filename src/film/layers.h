// What is kept of each pixel besides its radiance and alpha: arbitrary output variables.
#pragma once

#include "core/rgb.h"
#include "film/deep.h"
#include "film/mattes.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace etendue {

/// Which layers there are. Sums are of all samples of a pixel, weighted as its radiance is, except those of rays;
/// what cannot be averaged is of the sample whose surface is nearest.
struct LayerLayout {
    std::size_t light = 0;        ///< radiance of some of the paths, three sums each; splats fall into these, too
    std::size_t values = 0;       ///< numbers that are averaged
    std::size_t nearest = 0;      ///< numbers of the nearest sample
    bool has_moments = false;     ///< sums for the variance of radiance: see LayerBuffer::add_moments
    bool has_ray_counts = false;  ///< rays that the samples of the pixel took
    std::size_t mattes = 0;       ///< lists of ids, of Cryptomatte
    std::size_t matte_slots = 0;  ///< ids in each of them, at most
    bool is_deep = false;         ///< bins of depth

    /// Three of squares, three of means and one of weights.
    static constexpr std::size_t kMomentSums = 7;

    [[nodiscard]] std::size_t value_sums() const { return 3 * light; }
    [[nodiscard]] std::size_t moment_sums() const { return value_sums() + values; }
    [[nodiscard]] std::size_t ray_sum() const { return moment_sums() + (has_moments ? kMomentSums : 0); }
    /// Sums of a pixel, 8 bytes each; the functions above say where the later kinds begin.
    [[nodiscard]] std::size_t sums() const { return ray_sum() + (has_ray_counts ? 1 : 0); }
    /// Bytes of a pixel in a LayerBuffer, at most; `with_splats` if it gets such.
    [[nodiscard]] std::size_t bytes(bool with_splats = false) const {
        return sums() * sizeof(double) + (nearest > 0 ? (nearest + 1) * sizeof(float) : 0) +
               mattes * matte_slots * (sizeof(std::uint32_t) + sizeof(double)) +
               (is_deep ? DeepBuffer::most_bytes(with_splats) : 0);
    }
    /// Returns the layout without what is no mean, so that half of the samples have nothing to say of it.
    [[nodiscard]] LayerLayout without_lists() const {
        LayerLayout layout = *this;
        layout.mattes = 0;
        layout.matte_slots = 0;
        layout.is_deep = false;
        return layout;
    }
    [[nodiscard]] bool empty() const { return sums() == 0 && nearest == 0 && mattes == 0 && !is_deep; }
    friend bool operator==(const LayerLayout&, const LayerLayout&) = default;
};

/// The layers of some pixels.
class LayerBuffer {
  public:
    LayerBuffer() = default;
    LayerBuffer(const LayerLayout& layout, std::size_t pixels) { reset(layout, pixels); }

    /// Starts with nothing; memory is kept.
    void reset(const LayerLayout& layout, std::size_t pixels) {
        layout_ = layout;
        sums_.assign(pixels * layout.sums(), 0.0);
        nearest_.assign(pixels * nearest_stride(), 0.0f);
        if (layout.nearest > 0)
            for (std::size_t p = 0; p < pixels; ++p)
                nearest_[p * nearest_stride()] = std::numeric_limits<float>::infinity();
        mattes_.reset(layout.mattes, layout.matte_slots, pixels);
        deep_.reset(layout.is_deep ? pixels : 0);
    }

    [[nodiscard]] const LayerLayout& layout() const { return layout_; }
    [[nodiscard]] std::span<double> sums(std::size_t pixel) {
        return std::span(sums_).subspan(pixel * layout_.sums(), layout_.sums());
    }
    [[nodiscard]] std::span<const double> sums(std::size_t pixel) const {
        return std::span(sums_).subspan(pixel * layout_.sums(), layout_.sums());
    }
    /// True if a sample of the pixel has hit anything.
    [[nodiscard]] bool has_nearest(std::size_t pixel) const {
        return nearest_[pixel * nearest_stride()] < std::numeric_limits<float>::infinity();
    }
    /// All zero otherwise.
    [[nodiscard]] std::span<const float> nearest(std::size_t pixel) const {
        return std::span(nearest_).subspan(pixel * nearest_stride() + 1, layout_.nearest);
    }

    /// Adds radiance, weighted, to sums that begin with `first`.
    void add_rgb(std::size_t pixel, std::size_t first, const Rgb& value, double weight) {
        double* const sum = &sums_[pixel * layout_.sums() + first];
        sum[0] += weight * static_cast<double>(value.r);
        sum[1] += weight * static_cast<double>(value.g);
        sum[2] += weight * static_cast<double>(value.b);
    }
    /// Adds a sample to what the variance of a pixel's mean, a ratio of sums, is made of: w² r², w² r and w², by which
    /// the squares of w (r - mean) are known once the mean is. Filters with negative parts need all three.
    void add_moments(std::size_t pixel, const Rgb& radiance, double weight) {
        const std::size_t first = layout_.moment_sums();
        const double squared = weight * weight;
        add_rgb(pixel, first, radiance * radiance, squared);
        add_rgb(pixel, first + 3, radiance, squared);
        sums_[pixel * layout_.sums() + first + 6] += squared;
    }
    /// Adds `light` to a sample of weight 1 that is among them with `radiance`.
    void grow_moments(std::size_t pixel, const Rgb& radiance, const Rgb& light) {
        const std::size_t first = layout_.moment_sums();
        add_rgb(pixel, first, light * (radiance * 2.0f + light), 1.0);
        add_rgb(pixel, first + 3, light, 1.0);
    }
    /// Keeps `values` if no earlier sample was as near; of equally near ones, the first.
    void add_nearest(std::size_t pixel, float distance, std::span<const float> values) {
        float* const kept = &nearest_[pixel * nearest_stride()];
        if (!(distance < *kept)) return;
        kept[0] = distance;
        for (std::size_t i = 0; i < values.size(); ++i) kept[i + 1] = values[i];
    }
    /// Adds pixel `other_pixel` of `other`, which has the same layout, to `pixel`; either may be without lists.
    void add(std::size_t pixel, const LayerBuffer& other, std::size_t other_pixel) {
        const std::span<const double> from = other.sums(other_pixel);
        const std::span<double> to = sums(pixel);
        for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
        if (layout_.nearest > 0)
            add_nearest(pixel, other.nearest_[other_pixel * nearest_stride()], other.nearest(other_pixel));
        if (layout_.mattes > 0 && other.layout_.mattes > 0) mattes_.add(pixel, other.mattes_, other_pixel);
        if (layout_.is_deep && other.layout_.is_deep) deep_.add(pixel, other.deep_, other_pixel);
    }

    [[nodiscard]] MatteBuffer& mattes() { return mattes_; }
    [[nodiscard]] const MatteBuffer& mattes() const { return mattes_; }
    [[nodiscard]] DeepBuffer& deep() { return deep_; }
    [[nodiscard]] const DeepBuffer& deep() const { return deep_; }

    /// All numbers, pixel by pixel, and how to put them back.
    [[nodiscard]] std::span<const double> all_sums() const { return sums_; }
    [[nodiscard]] std::span<const float> all_nearest() const { return nearest_; }
    [[nodiscard]] std::span<double> all_sums() { return sums_; }
    [[nodiscard]] std::span<float> all_nearest() { return nearest_; }

  private:
    /// The distance stands before the numbers.
    [[nodiscard]] std::size_t nearest_stride() const { return layout_.nearest > 0 ? layout_.nearest + 1 : 0; }

    LayerLayout layout_;
    std::vector<double> sums_;
    std::vector<float> nearest_;
    MatteBuffer mattes_;
    DeepBuffer deep_;
};

}  // namespace etendue
