// Where samples end: sums per pixel, first of one tile, then of the image.
#pragma once

#include "core/pixel_rect.h"
#include "core/rgb.h"
#include "core/vector_bytes.h"
#include "film/layers.h"
#include "film/splat_film.h"
#include "film/wave_hits.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// Returns what to multiply sums by whose samples have this weight together. Dividing by the weights keeps even regions
/// even. Where a filter with negative parts has by chance left little weight (a few samples), their number, which is
/// the weight's mean, stands in.
[[nodiscard]] inline double scale_of(double weight, double samples) {
    const double divisor = weight > 0.5 * samples ? weight : samples;
    return divisor > 0.0 ? 1.0 / divisor : 0.0;
}

/// Sums of one pixel, in double because they grow. 48 bytes.
struct PixelSum {
    double r = 0.0;
    double g = 0.0;
    double b = 0.0;
    double alpha = 0.0;
    double weight = 0.0;
    std::uint64_t samples = 0;

    /// `filter_weight` is 1 on average; negative in the negative parts of a filter.
    void add(const Rgb& radiance, float sample_alpha, float filter_weight) {
        const auto w = static_cast<double>(filter_weight);
        r += w * static_cast<double>(radiance.r);
        g += w * static_cast<double>(radiance.g);
        b += w * static_cast<double>(radiance.b);
        alpha += w * static_cast<double>(sample_alpha);
        weight += w;
        ++samples;
    }
    void add(const PixelSum& other) {
        r += other.r;
        g += other.g;
        b += other.b;
        alpha += other.alpha;
        weight += other.weight;
        samples += other.samples;
    }
    [[nodiscard]] double scale() const { return scale_of(weight, static_cast<double>(samples)); }
};

/// The pixels of one tile while it is rendered; used by one thread.
class TileBuffer {
  public:
    /// Starts a tile; memory is kept from the one before.
    void reset(const PixelRect& rect, const LayerLayout& layout = {}) {
        rect_ = rect;
        pixels_.assign(rect.area(), PixelSum{});
        layers_.reset(layout, rect.area());
        splats_.clear();
    }
    [[nodiscard]] const PixelRect& rect() const { return rect_; }
    /// Pixel `index` of the rectangle, row by row.
    [[nodiscard]] PixelSum& pixel(std::size_t index) { return pixels_[index]; }
    [[nodiscard]] const PixelSum& pixel(std::size_t index) const { return pixels_[index]; }
    /// Returns the layers of the rectangle's pixels.
    [[nodiscard]] LayerBuffer& layers() { return layers_; }
    [[nodiscard]] const LayerBuffer& layers() const { return layers_; }
    /// Returns the light for any pixel of the image, of integrators that make such.
    [[nodiscard]] std::vector<Splat>& splats() { return splats_; }
    /// Returns the bytes held, without those of layers.
    [[nodiscard]] std::size_t bytes() const { return vector_bytes(pixels_, splats_); }
    /// Returns what the camera rays of a wave's samples have met; for layers that tell of it.
    [[nodiscard]] WaveHits& wave_hits() { return wave_hits_; }

  private:
    PixelRect rect_;
    std::vector<PixelSum> pixels_;
    LayerBuffer layers_;
    std::vector<Splat> splats_;
    WaveHits wave_hits_;
};

/// The image, or its crop window. Tiles of one pass do not overlap, so that they can be added from any thread in any
/// order with the same result: each pixel receives its passes in their order.
class Film {
  public:
    /// Splats are kept for all of `splat_window`, which need not be the window of the pixels: the light paths of one
    /// part of an image shine on the others.
    Film(int full_width, int full_height, const PixelRect& window, const PixelRect& splat_window,
         const LayerLayout& layout = {});
    Film(int full_width, int full_height, const PixelRect& window) : Film(full_width, full_height, window, window) {}

    /// Adds the pixels of a finished tile. Calls for tiles that do not overlap may run at the same time.
    void add(const TileBuffer& tile);
    /// Adds only those of its pixels that are `chosen`: their indices in the tile.
    void add(const TileBuffer& tile, std::span<const std::uint32_t> chosen);
    /// Adds what tiles have for any pixel, in the order of `lists`, from `light_paths` paths; seen through `filter`,
    /// which must be the same in all calls.
    void add_splats(std::span<const std::vector<Splat>> lists, std::uint64_t light_paths, const PixelFilter& filter,
                    const ThreadPool& threads);

    /// Adds the sums of `other`, which has the same filter, splat window and layers, and a window inside this one's.
    /// Either may be without mattes and depths.
    void add(const Film& other);

    /// Returns what `part` might be if it held half of the samples and light paths of this film, of every pixel, in
    /// place of the share of each that it does hold: off from the image by sqrt(s / (1 - s)) times what it is off, so
    /// that it and the other half differ as two halves of as many samples do. What cannot be averaged is that of
    /// `part`.
    [[nodiscard]] Film as_half(const Film& part) const;

    /// All that it holds: of the window, row by row, and the splats, if there have been any.
    [[nodiscard]] std::span<const PixelSum> sums() const { return pixels_; }
    [[nodiscard]] const LayerBuffer& layers() const { return layers_; }
    [[nodiscard]] const SplatFilm* splats() const { return splats_ ? &*splats_ : nullptr; }
    /// Puts back what `sums`, `layers` and `splats` of such a film have given.
    void restore(std::vector<PixelSum> sums, LayerBuffer layers, std::optional<SplatFilm> splats);

    [[nodiscard]] int full_width() const { return full_width_; }
    [[nodiscard]] int full_height() const { return full_height_; }
    [[nodiscard]] const PixelRect& window() const { return window_; }
    [[nodiscard]] const PixelRect& splat_window() const { return splat_window_; }

    /// Means of red, green, blue and alpha of the window, row by row, four floats a pixel, with the splats; pixels
    /// without samples are zero.
    [[nodiscard]] std::vector<float> resolve() const;
    [[nodiscard]] std::uint64_t sample_count() const;
    /// Samples of the pixel in column `x` and row `y` of the full image.
    [[nodiscard]] std::uint64_t sample_count(int x, int y) const { return pixels_[index(x, y)].samples; }
    /// Means of red, green and blue of the same pixel: of what its own samples brought, and of what light paths did.
    [[nodiscard]] std::array<double, 3> eye_mean(int x, int y) const;
    [[nodiscard]] std::array<double, 3> light_mean(int x, int y) const;
    /// Returns the number of light paths that the film has splats of; 0 if it has none.
    [[nodiscard]] std::uint64_t light_paths() const { return splats_ ? splats_->light_paths() : 0; }

    /// Returns the means of the light layer of this index with its splats, of the window row by row, three floats a
    /// pixel.
    [[nodiscard]] std::vector<float> resolve_light(std::size_t layer) const;
    /// Means of the values [first, first + count), as many floats a pixel.
    [[nodiscard]] std::vector<float> resolve_values(std::size_t first, std::size_t count) const;
    /// Returns the numbers [first, first + count) of each pixel's nearest sample; `background` where nothing was hit.
    [[nodiscard]] std::vector<float> resolve_nearest(std::size_t first, std::size_t count, float background) const;
    /// Estimate of the variance of each pixel's mean, red, green and blue, from the squares of what its samples and
    /// splats brought: as if all were independent, which samples that fill each other's gaps are better than. Zero with
    /// fewer than two samples. The film must have moments.
    [[nodiscard]] std::vector<float> resolve_variance() const;
    /// Rays per sample. The film must have ray counts.
    [[nodiscard]] std::vector<float> resolve_ray_counts() const;
    [[nodiscard]] std::vector<float> resolve_sample_counts() const;
    /// Returns the samples of each pixel of the window, row by row, from front to back. The film must be deep.
    [[nodiscard]] std::vector<std::vector<DeepSample>> resolve_deep() const;
    /// Returns the heaviest `ranks` ids of each pixel in the matte of this index with their coverage, the share of the
    /// pixel's weight: two floats a rank, the first of which has the id as its bits; zeros where there are fewer.
    [[nodiscard]] std::vector<float> resolve_matte(std::size_t matte, std::size_t ranks) const;

  private:
    /// The splats of the image by their depths.
    void add_deep_splats(std::span<const std::vector<Splat>> lists, const PixelFilter& filter,
                         const ThreadPool& threads);
    /// Returns the index of the pixel in column `x` and row `y` of the full image.
    [[nodiscard]] std::size_t index(int x, int y) const;
    /// Means of the layers' sums [first, first + count).
    [[nodiscard]] std::vector<float> resolve_sums(std::size_t first, std::size_t count) const;

    int full_width_;
    int full_height_;
    PixelRect window_;
    PixelRect splat_window_;
    std::vector<PixelSum> pixels_;
    LayerBuffer layers_;
    std::optional<SplatFilm> splats_;
};

}  // namespace etendue
