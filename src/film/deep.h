// What the samples of a pixel have found at which depth: a deep image.
#pragma once

#include "core/rgb.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Depth of what lies behind everything: a background that the image shows. What compositing programs take for
/// infinitely far.
inline constexpr float kDeepBackground = 1e10f;

/// Holds what lies between two depths of a pixel, metres along the viewing direction, negative of splats. 64 bytes.
struct DeepBin {
    float front = 0.0f;
    float back = 0.0f;
    double alpha = 0.0;  ///< sum over samples, weighted as their radiance is
    double r = 0.0;
    double g = 0.0;
    double b = 0.0;
    double splat_r = 0.0;  ///< sum over splats
    double splat_g = 0.0;
    double splat_b = 0.0;

    void add(const DeepBin& other);
};

/// Bins of some pixels, those of splats and then those of samples, sorted; none of a kind overlap. What is as deep as
/// one but for a hundredth goes into it; where a pixel would have more than kMostBins of a kind, the two that are
/// nearest each other, by the ratio of their depths, become one. Nothing is lost thereby but depth. 64 bytes a bin, 24
/// a pixel.
class DeepBuffer {
  public:
    static constexpr std::size_t kMostBins = 16;
    static constexpr float kTolerance = 0.01f;

    /// Starts with nothing; memory is kept.
    void reset(std::size_t pixels) {
        if (pixels_.size() != pixels) pixels_.resize(pixels);
        for (std::vector<DeepBin>& bins : pixels_) bins.clear();
    }
    /// Adds a bin, of one sample or splat or of many.
    void add(std::size_t pixel, const DeepBin& bin);
    /// Adds pixel `other_pixel` of `other`.
    void add(std::size_t pixel, const DeepBuffer& other, std::size_t other_pixel) {
        for (const DeepBin& bin : other.pixels_[other_pixel]) add(pixel, bin);
    }
    [[nodiscard]] std::span<const DeepBin> bins(std::size_t pixel) const { return pixels_[pixel]; }
    /// Returns the bytes that all pixels take in memory now.
    [[nodiscard]] std::uint64_t bytes() const;
    /// Returns the bytes that a pixel takes at most; `with_splats` if it gets splats.
    [[nodiscard]] static constexpr std::size_t most_bytes(bool with_splats) {
        return sizeof(std::vector<DeepBin>) + (with_splats ? 2 : 1) * kMostBins * sizeof(DeepBin);
    }
    [[nodiscard]] std::size_t pixels() const { return pixels_.size(); }
    /// Puts back what `bins` has given.
    void restore(std::size_t pixel, std::vector<DeepBin> bins) { pixels_[pixel] = std::move(bins); }

  private:
    std::vector<std::vector<DeepBin>> pixels_;
};

/// One depth of a pixel as files hold it: its colour is multiplied by its alpha, and what lies behind shows through by
/// 1 - alpha.
struct DeepSample {
    float r = 0.0f;
    float g = 0.0f;
    float b = 0.0f;
    float alpha = 0.0f;
    float front = 0.0f;
    float back = 0.0f;
};

/// The samples of a pixel whose bins, times the scales, add up to its colour and alpha: composited front to back, they
/// give that colour and alpha. Light in front of nothing opaque, as splats may leave it, goes to the nearest depth that
/// has alpha.
[[nodiscard]] std::vector<DeepSample> deep_samples(std::span<const DeepBin> bins, double scale, double splat_scale);

}  // namespace etendue
