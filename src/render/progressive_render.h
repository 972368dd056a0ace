// A render that goes on for as long as it is asked to, and whose image can be looked at in between.
#pragma once

#include "core/parallel.h"
#include "film/film.h"
#include "film/pixel_filter.h"
#include "integrator/integrator.h"
#include "world/world.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace etendue {

class RenderProfile;

/// What samples are taken, and of which pixels.
struct SamplingOptions {
    int full_width = 1024;
    int full_height = 576;
    PixelRect window{0, 0, 1024, 576};  ///< inside the full image, not empty
    /// What the window is a part of that other renders have the rest of: splats are kept for all of it. Empty for the
    /// window itself.
    PixelRect splat_window{};
    std::uint32_t seed = 0;
    SampleSequence sequence = SampleSequence::Sobol;
    PixelFilter filter{FilterShape::BlackmanHarris};
    /// Not 0: tiles are taken in an order shuffled by this number. The image does not depend on it; tests show that.
    std::uint32_t tile_order_seed = 0;
    std::shared_ptr<const AovSet> aovs{};                           ///< layers to keep besides the image; null for none
    float clamp_indirect = std::numeric_limits<float>::infinity();  ///< as in TileJob
    RenderProfile* profile = nullptr;  ///< for as many threads as render; null if nobody asks
    std::size_t brightest = 0;  ///< how many of the brightest contributions to remember, [0, BrightestSamples::kMost]
};

/// A film without samples for such a render.
[[nodiscard]] Film make_film(const SamplingOptions& options);
/// The same for every other pass: without mattes and depths, of which half of the samples are compared with nothing.
[[nodiscard]] Film make_second_film(const SamplingOptions& options);

/// Called from rendering threads whenever a tile is done, with what it took.
using TileCallback = std::function<void(std::uint64_t samples, std::uint64_t rays)>;

/// Asked from rendering threads whether to stop for now.
using StopPredicate = std::function<bool()>;

/// Of a render whose pixels need not have equally many samples. All of the window, row by row.
struct AdaptiveState {
    std::uint32_t passes = 0;               ///< finished ones that were adaptive
    std::vector<std::uint32_t> samples{};   ///< that each pixel has from finished passes; empty: all have spp_done
    std::vector<std::uint8_t> is_active{};  ///< 1 for the pixels of the pass under way; empty: all of them, or no pass

    [[nodiscard]] bool is_uniform() const { return samples.empty(); }
};

/// How far a render has come: all that is needed to go on with it.
struct RenderState {
    Film film;
    std::uint32_t first_sample = 0;          ///< index of the first sample of every pixel
    std::uint32_t spp_done = 0;              ///< samples that every pixel has; some have more in an adaptive render
    std::uint32_t pass_size = 0;             ///< samples of the pass that was stopped; 0 if none was
    std::vector<std::uint8_t> tiles_done{};  ///< of that pass: 1 for those that have its samples
    RenderCounters counters{};
    double wall_seconds = 0.0;  ///< of rendering
    double cpu_seconds = 0.0;   ///< the same, of all threads
    /// What every other pass gave, to be compared with the whole; kept if it is there from the beginning.
    std::optional<Film> every_other_pass{};
    std::uint32_t every_other_spp = 0;  ///< samples per pixel in it, of those that all pixels got alike
    AdaptiveState adaptive{};

    /// Index of the next sample of every pixel.
    [[nodiscard]] std::uint32_t next_sample() const { return first_sample + spp_done; }
};

class ProgressiveRender {
  public:
    /// All but the options must outlive it.
    ProgressiveRender(const World& world, const Integrator& integrator, const SamplingOptions& options,
                      const ThreadPool& threads);
    /// Goes on with `state`, which comes from a render of the same world, integrator and options.
    ProgressiveRender(const World& world, const Integrator& integrator, const SamplingOptions& options,
                      const ThreadPool& threads, RenderState state);

    /// Takes the next `count` samples of every pixel, > 0 unless a pass was stopped. The image is bit-identical for
    /// every thread count and tile order, and however often it is stopped. `stop` is looked at before every tile, or
    /// every group of them if the integrator makes splats: when it becomes true, those under way are finished and false
    /// is returned; some pixels have their samples then, and the next call takes those that are missing, whatever its
    /// `count`.
    bool add_samples(std::uint32_t count, const StopPredicate& stop, const TileCallback& tile_done = {});

    /// The same for those pixels alone that are active: 1 for them, of the window, row by row; at least one. Every
    /// pixel's samples are the first of its own sequence, however many others have. Of every other pass, each pixel's
    /// own is kept apart, and every other light image. Tiles without active pixels cost nothing.
    bool add_samples_to(std::vector<std::uint8_t> is_active, std::uint32_t count, const StopPredicate& stop,
                        const TileCallback& tile_done = {});

    /// Of a pass that was stopped, what its complete tiles have is in the film.
    [[nodiscard]] const RenderState& state() const { return state_; }
    /// That all threads keep between tiles, without the tiles themselves; of those that have had one.
    [[nodiscard]] std::size_t scratch_bytes() const;
    /// Tiles under way, and splats that wait to be added; without layers.
    [[nodiscard]] std::size_t tile_bytes() const;
    /// Moves the state out; nothing else may be called then.
    [[nodiscard]] RenderState take_state() { return std::move(state_); }

  private:
    /// What one thread keeps between tiles.
    struct Worker {
        std::unique_ptr<IntegratorScratch> scratch;  ///< made with its first tile
        TileBuffer tile;
        RenderCounters counters;
        std::vector<PixelJob> pixels;                   ///< of the tile, if only some are active
        std::vector<std::uint32_t> every_other_pixels;  ///< of these, those whose pass is kept apart
    };

    /// Tiles whose splats are added together: few enough for the render to stop within seconds. The image does not
    /// depend on it.
    [[nodiscard]] std::size_t splat_group_size() const;
    /// Begins a pass, unless one was stopped.
    void begin_pass(std::uint32_t count);
    void finish_pass();
    bool go_on(const StopPredicate& stop, const TileCallback& tile_done);
    /// The film of every other pass, if it gets all of this one, or its splats if only some pixels are active.
    [[nodiscard]] Film* second_film();
    /// Fills the lists of `worker` with what is active of a tile.
    void choose_pixels(const PixelRect& rect, Worker& worker) const;
    /// Adds what `worker` has rendered, but for splats, which are added in the order of the tiles.
    void add_tile(const Worker& worker, Film* second);
    void render_group(std::size_t first, std::size_t size, const StopPredicate& stop, const TileCallback& tile_done);

    const World& world_;
    const Integrator& integrator_;
    SamplingOptions options_;
    const ThreadPool& threads_;
    RenderState state_;
    std::vector<PixelRect> tiles_;
    std::vector<Worker> workers_;
    std::vector<std::vector<Splat>> splats_;  ///< of each tile of a group
    double seconds_per_tile_ = 0.0;           ///< of the last group; 0: not known
};

}  // namespace etendue
