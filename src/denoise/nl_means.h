// Non-local means with the variance of the pixels known: Rousselle, Knaus and Zwicker, "Adaptive Rendering with
// Non-Local Means Filtering" (SIGGRAPH Asia 2012), section 4.
#pragma once

#include "core/parallel.h"
#include "core/pixel_rect.h"
#include "denoise/planes.h"

#include <cstddef>
#include <span>
#include <vector>

namespace etendue {

/// Images are filtered in tiles of this many pixels a side.
inline constexpr int kDenoiseTileSide = 2 * kLargestWindowRadius;

struct NlMeansSettings {
    int radius = 9;  ///< R, of the window that a pixel is averaged over; in [1, kLargestWindowRadius]
    int patch = 3;   ///< F, of the patches that pixels are compared by; in [0, kLargestPatchRadius]
    float k = 1.0f;  ///< bandwidth, > 0: how far apart values may lie, in standard deviations of their difference
};

/// Holds what weights are computed from: an image, and its variance times a factor. Borders are filled.
struct NlMeansGuide {
    const Planes& image;
    const Planes& variance;
    float variance_scale = 1.0f;
};

/// Weights of all windows whose centres lie in one tile. Scratch memory of one thread.
///
///     d²(p, q) = ((u(p) - u(q))² - (Var(p) + min(Var(p), Var(q)))) / (ε + k² (Var(p) + Var(q)))
///     w(p, q)  = exp(-max(0, mean of d² over the channels and over the patch))
///
/// The second term of the numerator is what two noisy pixels of the same colour differ by. Pixels outside the image
/// have weight 0.
class WindowWeights {
  public:
    explicit WindowWeights(const NlMeansSettings& settings);

    /// `tile` lies in the image and has sides of at most kDenoiseTileSide.
    void compute(const NlMeansGuide& guide, const PixelRect& tile);

    /// Returns the weights of the window around (x, y), a pixel of the tile: `rows()` rows of `row_stride()` weights,
    /// of which the first `rows()` count and the others are 0.
    [[nodiscard]] std::span<const float> window(int x, int y) const;
    [[nodiscard]] int rows() const { return 2 * settings_.radius + 1; }
    [[nodiscard]] int row_stride() const { return row_stride_; }
    /// Returns the number of weights of one window: rows() * row_stride().
    [[nodiscard]] std::size_t window_size() const {
        return static_cast<std::size_t>(rows()) * static_cast<std::size_t>(row_stride_);
    }

  private:
    void compute_offset(const NlMeansGuide& guide, int dx, int dy);
    void sum_distances(const NlMeansGuide& guide, int dx, int dy);

    NlMeansSettings settings_;
    int row_stride_;
    PixelRect tile_;
    std::vector<float> weights_;
    std::vector<float> distances_;  ///< d², summed over channels, of the tile and a patch's radius around it
    std::vector<float> row_sums_;   ///< distances_ summed over rows of patches, for the columns of the tile
};

/// The tiles of an image of this size, row by row.
[[nodiscard]] std::vector<PixelRect> denoise_tiles(int width, int height);

/// `target`, each pixel the mean of its window with the weights that `guide` gives. Exactly the same for every number
/// of threads. The border is filled.
[[nodiscard]] Planes nl_means(const Planes& target, const NlMeansGuide& guide, const NlMeansSettings& settings,
                              const ThreadPool& threads);

}  // namespace etendue
