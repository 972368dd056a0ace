// A render that goes on for as long as it is asked to, and whose image can be looked at in between.
#pragma once

#include "core/parallel.h"
#include "film/film.h"
#include "film/pixel_filter.h"
#include "integrator/integrator.h"
#include "world/world.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace etendue {

/// What samples are taken, and of which pixels.
struct SamplingOptions {
    int full_width = 1024;
    int full_height = 576;
    PixelRect window{0, 0, 1024, 576};  ///< inside the full image, not empty
    std::uint32_t seed = 0;
    SampleSequence sequence = SampleSequence::Sobol;
    PixelFilter filter{FilterShape::BlackmanHarris};
    /// Not 0: tiles are taken in an order shuffled by this number. The image does not depend on it; tests show that.
    std::uint32_t tile_order_seed = 0;
};

/// Called from rendering threads whenever a tile is done, with what it took.
using TileCallback = std::function<void(std::uint64_t samples, std::uint64_t rays)>;

class ProgressiveRender {
  public:
    /// All but the options must outlive it.
    ProgressiveRender(const World& world, const Integrator& integrator, const SamplingOptions& options,
                      const ThreadPool& threads);

    /// Takes the next `count` > 0 samples of every pixel. The image is bit-identical for every thread count and tile
    /// order. `stop` is looked at before every tile: when it becomes true, the tiles under way are finished and false
    /// is returned; some pixels have their samples then.
    bool add_samples(std::uint32_t count, const std::atomic<bool>& stop, const TileCallback& tile_done = {});

    [[nodiscard]] const Film& film() const { return film_; }
    /// Samples that every pixel has.
    [[nodiscard]] std::uint32_t spp_done() const { return spp_done_; }
    [[nodiscard]] RenderCounters counters() const;
    /// Moves the image out; nothing else may be called then.
    [[nodiscard]] Film take_film() { return std::move(film_); }

  private:
    /// What one thread keeps between tiles.
    struct Worker {
        std::unique_ptr<IntegratorScratch> scratch;
        TileBuffer tile;
        RenderCounters counters;
    };

    void render_group(std::size_t first, std::size_t size, std::uint32_t count, const std::atomic<bool>& stop,
                      const TileCallback& tile_done);

    const World& world_;
    const Integrator& integrator_;
    SamplingOptions options_;
    const ThreadPool& threads_;
    Film film_;
    std::vector<PixelRect> tiles_;
    std::vector<Worker> workers_;
    std::vector<std::vector<Splat>> splats_;  ///< of each tile of a group
    std::uint32_t spp_done_ = 0;
};

}  // namespace etendue
