// Light that is brought to any pixel: what subpaths from the light leave on the film.
//
// A splat falls into every pixel whose filter reaches it. The image is their sum over the number of light paths, times
// the pixels of the film; there is no filter weight to divide by, and a crop window sees what the full image would.
#pragma once

#include "core/parallel.h"
#include "core/pixel_rect.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "film/pixel_filter.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Light at a place on the film.
struct Splat {
    Vec2f position;           ///< pixels of the full image, x right and y down from its corner
    Rgb value;                ///< light that the splat adds to the integral over the film of area 1
    std::uint32_t layer = 0;  ///< layer of SplatFilm: the image, or one of the film's light layers
    float depth = 0.0f;       ///< metres along the viewing direction, of what it shows; of deep images only
};

/// Sums of one pixel, in double because they grow. 24 bytes.
struct SplatSum {
    double r = 0.0;
    double g = 0.0;
    double b = 0.0;
};

/// True if some pixel of `window` sees what falls on `position` through `filter`.
[[nodiscard]] bool reaches(const PixelRect& window, const PixelFilter& filter, const Vec2f& position);

/// A pixel of the full image that sees a splat, and the filter there.
struct ReachedPixel {
    int x = 0;
    int y = 0;
    float weight = 0.0f;
};
/// Puts those of `window` that see what falls on `position` through `filter` into `reached`, row by row, in place of
/// what it holds: the edge of the filter included, as in SplatFilm. Of windows that are parts of one, each pixel is in
/// the list of its part alone.
void find_reached_pixels(const PixelRect& window, const PixelFilter& filter, const Vec2f& position,
                         std::vector<ReachedPixel>& reached);

/// Sums of splats, of the image and of the light layers of a film. 24 bytes a pixel and layer.
class SplatFilm {
  public:
    static constexpr std::size_t kBeauty = 0;
    static constexpr std::size_t kFirstLayer = 1;

    /// Makes a film without splats; with moments it keeps the sums of the squares of what the splats of the image
    /// bring, in one more layer.
    SplatFilm(int full_width, int full_height, const PixelRect& window, const PixelFilter& filter,
              std::size_t light_layers = 0, bool has_moments = false);

    /// Adds lists of splats, which came from `light_paths` paths. The sums are those of adding one after the other in
    /// the order of `lists`, whatever the number of threads.
    void add(std::span<const std::vector<Splat>> lists, std::uint64_t light_paths, const ThreadPool& threads);

    /// Adds the sums of `other`, which has the same window and layers.
    void add(const SplatFilm& other);

    /// Returns half of the light paths: their mean, and `stretch` times what the mean of `part` is off from it.
    [[nodiscard]] SplatFilm as_half(const SplatFilm& part, double stretch) const;

    /// Adds a layer to that of a `Film` whose `window` lies in this one's, `channels` floats a pixel, of which the
    /// first three are red, green and blue.
    void add_to(std::span<float> image, std::size_t channels, const PixelRect& window, std::size_t layer) const {
        add_to(image, channels, window, layer, static_cast<double>(light_paths_));
    }
    /// Adds a layer that `light_paths` of all paths have splats in to that of a `Film`, as `add_to` does for all paths.
    void add_to(std::span<float> image, std::size_t channels, const PixelRect& window, std::size_t layer,
                double light_paths) const;
    /// Adds an estimate of the variance of the image to that of such a film, three floats a pixel: as if each light
    /// path left one splat in a pixel at most, so that those that leave several count too little.
    void add_variance_to(std::span<float> variance, const PixelRect& window) const;

    [[nodiscard]] const PixelFilter& filter() const { return filter_; }
    /// Returns what the sums are to be multiplied by.
    [[nodiscard]] double scale() const { return scale(static_cast<double>(light_paths_)); }
    /// Layer by layer, each of the window, row by row.
    [[nodiscard]] std::span<const SplatSum> sums() const { return pixels_; }
    [[nodiscard]] std::uint64_t light_paths() const { return light_paths_; }
    /// Returns the image's red, green and blue in column `x` and row `y` of the full image.
    [[nodiscard]] std::array<double, 3> mean(int x, int y) const;
    /// Puts back what `sums` and `light_paths` of such a film have given.
    void restore(std::vector<SplatSum> sums, std::uint64_t light_paths);

  private:
    /// Adds what falls on rows [y0, y1) of the full image.
    void add_splat(const Splat& splat, int y0, int y1, std::vector<float>& along_x);
    /// Returns the index, in `layer`, of the pixel of the window in column `x` and row `y` of the full image.
    [[nodiscard]] std::size_t index(int x, int y, std::size_t layer) const;
    [[nodiscard]] double scale(double light_paths) const;

    int full_width_;
    int full_height_;
    PixelRect window_;
    PixelFilter filter_;
    std::size_t moment_layer_;  ///< kBeauty if there is none
    std::vector<SplatSum> pixels_;
    std::uint64_t light_paths_ = 0;
};

}  // namespace etendue
