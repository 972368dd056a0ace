// Where samples end: sums per pixel, first of one tile, then of the image.
#pragma once

#include "core/pixel_rect.h"
#include "core/rgb.h"
#include "film/splat_film.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

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
};

/// The pixels of one tile while it is rendered; used by one thread.
class TileBuffer {
  public:
    /// Starts a tile; memory is kept from the one before.
    void reset(const PixelRect& rect) {
        rect_ = rect;
        pixels_.assign(rect.area(), PixelSum{});
        splats_.clear();
    }
    [[nodiscard]] const PixelRect& rect() const { return rect_; }
    /// Pixel `index` of the rectangle, row by row.
    [[nodiscard]] PixelSum& pixel(std::size_t index) { return pixels_[index]; }
    [[nodiscard]] const PixelSum& pixel(std::size_t index) const { return pixels_[index]; }
    /// Light for any pixel of the image, of integrators that make such.
    [[nodiscard]] std::vector<Splat>& splats() { return splats_; }

  private:
    PixelRect rect_;
    std::vector<PixelSum> pixels_;
    std::vector<Splat> splats_;
};

/// The image, or its crop window. Tiles of one pass do not overlap, so that they can be added from any thread in any
/// order with the same result: each pixel receives its passes in their order.
class Film {
  public:
    /// Splats are kept for all of `splat_window`, which need not be the window of the pixels: the light paths of one
    /// part of an image shine on the others.
    Film(int full_width, int full_height, const PixelRect& window, const PixelRect& splat_window);
    Film(int full_width, int full_height, const PixelRect& window) : Film(full_width, full_height, window, window) {}

    /// Adds the pixels of a finished tile. Calls for tiles that do not overlap may run at the same time.
    void add(const TileBuffer& tile);
    /// Adds what tiles have for any pixel, in the order of `lists`, from `light_paths` paths; seen through `filter`,
    /// which must be the same in all calls.
    void add_splats(std::span<const std::vector<Splat>> lists, std::uint64_t light_paths, const PixelFilter& filter,
                    const ThreadPool& threads);

    /// Adds the sums of `other`, which has the same filter and splat window, and a window inside this one's.
    void add(const Film& other);

    /// All that it holds: of the window, row by row, and the splats, if there have been any.
    [[nodiscard]] std::span<const PixelSum> sums() const { return pixels_; }
    [[nodiscard]] const SplatFilm* splats() const { return splats_ ? &*splats_ : nullptr; }
    /// Puts back what `sums` and `splats` of such a film have given.
    void restore(std::vector<PixelSum> sums, std::optional<SplatFilm> splats);

    [[nodiscard]] int full_width() const { return full_width_; }
    [[nodiscard]] int full_height() const { return full_height_; }
    [[nodiscard]] const PixelRect& window() const { return window_; }
    [[nodiscard]] const PixelRect& splat_window() const { return splat_window_; }

    /// Means of red, green, blue and alpha of the window, row by row, four floats a pixel, with the splats; pixels
    /// without samples are zero.
    [[nodiscard]] std::vector<float> resolve() const;
    [[nodiscard]] std::uint64_t sample_count() const;

  private:
    /// Of the window's row `y`, from its column `x` on.
    [[nodiscard]] PixelSum* row(int x, int y);

    int full_width_;
    int full_height_;
    PixelRect window_;
    PixelRect splat_window_;
    std::vector<PixelSum> pixels_;
    std::optional<SplatFilm> splats_;
};

}  // namespace etendue
