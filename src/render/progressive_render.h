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

/// Says which samples are taken, and of which pixels.
struct SamplingOptions {
    int full_width = 1024;
    int full_height = 576;
    PixelRect window{0, 0, 1024, 576};  ///< may go beyond the full image, not empty
    /// Names the rectangle that `window` is a part of, of which other renders have the rest: splats are kept for all of
    /// it. Empty for `window` itself.
    PixelRect splat_window{};
    std::uint32_t seed = 0;
    SampleSequence sequence = SampleSequence::Sobol;
    PixelFilter filter{FilterShape::BlackmanHarris};
    /// Not 0: tiles are taken in an order shuffled by this number. The image does not depend on it; tests show that.
    std::uint32_t tile_order_seed = 0;
    std::shared_ptr<const AovSet> aovs{};                           ///< layers to keep besides the image; null for none
    float clamp_indirect = std::numeric_limits<float>::infinity();  ///< as TileJob has it; infinity: no limit
    RenderProfile* profile = nullptr;                               ///< has a slot per thread; null if nobody asks
    std::size_t brightest = 0;  ///< how many of the brightest contributions to remember, [0, BrightestSamples::kMost]
};

/// Makes the film of a render with these options, without samples.
[[nodiscard]] Film make_film(const SamplingOptions& options);
/// Makes the film of every other pass of such a render, without samples, mattes and depths: half of the samples of
/// mattes and depths are compared with nothing.
[[nodiscard]] Film make_second_film(const SamplingOptions& options);

/// Called from rendering threads whenever a tile is done, with what it took.
using TileCallback = std::function<void(std::uint64_t samples, std::uint64_t rays)>;

/// Asked from rendering threads whether to stop for now.
using StopPredicate = std::function<bool()>;

/// Holds the samples of a render whose pixels need not have equally many; arrays are of the window, row by row.
struct AdaptiveState {
    std::uint32_t passes = 0;               ///< finished passes that were adaptive
    std::vector<std::uint32_t> samples{};   ///< samples of each pixel in finished passes; empty: spp_done
    std::vector<std::uint8_t> is_active{};  ///< 1 for the pixels of the pass under way; empty: all of them, or no pass

    [[nodiscard]] bool is_uniform() const { return samples.empty(); }
};

/// How far a render has come: all that is needed to go on with it.
struct RenderState {
    Film film;
    std::uint32_t first_sample = 0;          ///< index of the first sample of every pixel
    std::uint32_t spp_done = 0;              ///< samples that every pixel has; some have more in an adaptive render
    std::uint32_t pass_size = 0;             ///< samples of the pass that was stopped; 0 if none was
    std::vector<std::uint8_t> tiles_done{};  ///< 1 for tiles that have the samples of the stopped pass
    RenderCounters counters{};
    double wall_seconds = 0.0;  ///< seconds of rendering
    double cpu_seconds = 0.0;   ///< processor seconds of rendering, of all threads
    /// Holds the film of every other pass, to be compared with the whole; none unless it was there from the beginning.
    std::optional<Film> every_other_pass{};
    std::uint32_t every_other_spp = 0;  ///< samples per pixel in every_other_pass that all pixels got alike
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

    /// Takes the next `count` samples as `add_samples` does, of active pixels only: `is_active` has 1 for them, for all
    /// of the window, row by row, at least one. Each pixel's samples are the first of its own sequence, however many
    /// others have. The second film gets a pixel's pass if it has less than half of the pixel's samples, and every
    /// other light image. Tiles without active pixels cost nothing.
    bool add_samples_to(std::vector<std::uint8_t> is_active, std::uint32_t count, const StopPredicate& stop,
                        const TileCallback& tile_done = {});

    /// Returns the state; the film holds those samples of a stopped pass that complete tiles have.
    [[nodiscard]] const RenderState& state() const { return state_; }
    /// Returns the bytes that all threads keep between tiles, without the tiles themselves; threads that had no tile
    /// keep none.
    [[nodiscard]] std::size_t scratch_bytes() const;
    /// Returns the bytes of tiles under way, of splats that wait to be added and of photons, without layers.
    [[nodiscard]] std::size_t tile_bytes() const;
    /// Moves the state out; nothing else may be called then.
    [[nodiscard]] RenderState take_state() { return std::move(state_); }

  private:
    /// Holds what one thread keeps between tiles.
    struct Worker {
        std::unique_ptr<IntegratorScratch> scratch;  ///< made with its first tile
        TileBuffer tile;
        RenderCounters counters;
        std::vector<PixelJob> pixels;                   ///< active pixels of the tile, if only some are
        std::vector<std::uint32_t> every_other_pixels;  ///< pixels of the tile that the second film gets too
    };

    /// Tiles whose splats are added together: few enough for the render to stop within seconds. The image does not
    /// depend on it.
    [[nodiscard]] std::size_t splat_group_size() const;
    /// Returns the job of the pass under way for the pixels of `rect`.
    [[nodiscard]] TileJob make_job(const PixelRect& rect) const;
    /// Traces the photons that the samples of the pass under way share, if they merge.
    void trace_photons();
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
    std::unique_ptr<const LampImages> lamp_images_;  ///< null if there are none
    RenderCounters photon_counters_;                 ///< counters of tracing `photons_`
    std::optional<SharedPhotons> photons_;           ///< photons of the pass under way, if its samples merge
    std::vector<std::vector<Splat>> splats_;         ///< splats of each tile of a group
    double seconds_per_tile_ = 0.0;                  ///< seconds per tile of the last group; 0: not known
};

}  // namespace etendue
