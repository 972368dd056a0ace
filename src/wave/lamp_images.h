// Images of small lamps in mirrors and behind smooth glass (E S+ L).
//
// No strategy but s = 0 makes such paths, and a pixel's own samples rarely meet a lamp that is small on the film: its
// image would be a few fireflies. So the film is searched once for all samples (lamp_image_search.h): where the way
// that a ray takes by deltas passes a lamp closely, as measured by how fast it sweeps past, the pixel is divided into
// ever smaller cells, down to the size of the lamp's image. Within the cells that are left, samples of their own find
// the lamps that deltas show, and a pixel's samples leave them alone: both parts of the film are sampled without bias,
// however well the cells fit.
#pragma once

#include "core/pixel_rect.h"
#include "core/vec.h"
#include "core/vector_bytes.h"
#include "wave/lamp_image_search.h"
#include "wave/tile_job.h"
#include "world/world.h"

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace etendue {

/// Finds where the film of a render shows images of lamps, a region of it when somebody first asks for that: so tiles,
/// crops and renders that are stopped wait for what they need. Any number of threads may ask.
class LampImages {
  public:
    /// Covers `window`, pixels of the full image of `whole`, whose seed and sequence the search takes. What it finds
    /// depends neither on the window nor on who asks.
    LampImages(const World& world, const TileJob& whole, const PixelRect& window);

    /// Returns false if there is nothing to look for: no mirrors, or no lamps.
    [[nodiscard]] bool may_exist() const { return !lamps_.empty(); }
    /// Returns true if a cell contains `film`, pixels of the full image.
    [[nodiscard]] bool contain(const Vec2f& film) const;
    /// Calls `visit` for all pixels of `rect` that show images, in one order whatever `rect` is.
    void for_each_in(const PixelRect& rect,
                     const std::function<void(const LampPixels& found, const LampPixel& pixel)>& visit) const;
    /// Returns the bytes held by what has been found so far.
    [[nodiscard]] std::size_t bytes() const;

  private:
    /// Holds what a region shows once it has been searched.
    struct Region {
        std::once_flag once;
        LampPixels found;
    };

    /// Returns what the region in column `x` and row `y` of all shows.
    [[nodiscard]] const LampPixels& region(int x, int y) const;

    const World& world_;
    TileJob whole_;
    std::vector<LampSphere> lamps_;
    PixelRect regions_;  ///< columns and rows of regions that cover the window
    std::unique_ptr<Region[]> all_;
    mutable std::atomic<std::size_t> found_bytes_{0};
};

/// Returns the images that a render shows in `window`; null if there can be none.
[[nodiscard]] std::unique_ptr<const LampImages> find_lamp_images(const World& world, const TileJob& whole,
                                                                 const PixelRect& window);

}  // namespace etendue
