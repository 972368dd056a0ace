// What every light transport algorithm is: something that adds samples to one tile.
//
// To add another, see CONTRIBUTING.md (An integrator).
#pragma once

#include "film/dropped_sample.h"
#include "film/film.h"
#include "film/pixel_filter.h"
#include "integrator/aov/aov_set.h"
#include "integrator/bright_sample.h"
#include "integrator/ray_kind.h"
#include "integrator/strategy.h"
#include "sampling/sampler.h"
#include "transport/heuristic.h"
#include "transport/path_lengths.h"
#include "world/world.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

class WaveProfile;

/// A pixel that is to get samples: its index in the tile, row by row, and that of its first sample.
struct PixelJob {
    std::uint32_t pixel = 0;
    std::uint32_t first_sample = 0;
};

/// The samples to take: `sample_count` of every pixel of `rect`, beginning with index `first_sample`, or of `pixels`
/// alone, each beginning with its own.
struct TileJob {
    PixelRect rect;
    PixelRect window;  ///< pixels that splats may fall into; each has a light path per sample
    int full_width = 0;
    int full_height = 0;
    std::uint32_t first_sample = 0;
    std::uint32_t sample_count = 1;
    std::uint32_t seed = 0;
    SampleSequence sequence = SampleSequence::Sobol;
    const PixelFilter* filter = nullptr;  ///< not null
    const AovSet* aovs = nullptr;         ///< what the tile's layers hold; null if it has none
    /// Most that the largest component of an indirect contribution may have, as a sample of a pixel has it; hues are
    /// kept. Direct is the light of paths C S* L and C S* . L: what the eye sees, mirrors and smooth glass apart, and
    /// what lights it without another bounce. All other light is indirect.
    float clamp_indirect = std::numeric_limits<float>::infinity();
    std::span<const PixelJob> pixels{};  ///< empty for all
    WaveProfile* profile = nullptr;      ///< profile of the thread that renders; null if nobody asks
};

/// Holds what one thread counts as it renders; those of all threads are added up at the end.
struct RenderCounters {
    RaysByKind rays;
    std::uint64_t samples = 0;
    std::uint64_t dropped = 0;
    std::vector<DroppedSample> first_dropped;  ///< at most kMaxLocated
    BrightestSamples brightest;

    static constexpr std::size_t kMaxLocated = 8;

    void drop(const DroppedSample& sample);
    void add(const RenderCounters& other);
};

/// Holds all that can be asked of integrators; each integrator takes the options that concern it.
struct IntegratorOptions {
    PathLengths lengths{};
    std::uint32_t light_samples = 1;           ///< see PathOptions
    Heuristic heuristic = Heuristic::Balance;  ///< weighs strategies, where an integrator has them
    std::optional<Strategy> strategy{};        ///< this one alone; it exists
    bool weighted = true;                      ///< false: the strategy is all there is, as if no other made its paths
    int cached_connections = 0;                ///< of bdpt: see BdptOptions
};

/// Memory that a thread keeps from tile to tile; each integrator has its own kind.
class IntegratorScratch {
  public:
    virtual ~IntegratorScratch() = default;
    /// Returns how many bytes of memory the scratch holds.
    [[nodiscard]] virtual std::size_t bytes() const = 0;
};

class Integrator {
  public:
    virtual ~Integrator() = default;

    [[nodiscard]] virtual std::unique_ptr<IntegratorScratch> make_scratch() const = 0;

    /// Returns a sentence for each kind of light in `world` that this algorithm can never find; none if it finds all.
    [[nodiscard]] virtual std::vector<std::string> unreachable_light(const World& world) const = 0;

    /// Returns a sentence for each option that was asked for and has no effect on this algorithm in the given world.
    [[nodiscard]] virtual std::vector<std::string> ineffective_options(const World&) const { return {}; }

    /// True if `render_tile` leaves splats, one light path for each of its samples.
    [[nodiscard]] virtual bool makes_splats() const { return false; }

    /// Adds the samples of `job` to `tile`, which has been reset to its rectangle. The result depends on `job` and the
    /// world only. `scratch` comes from `make_scratch` and is used by no other call at the same time.
    virtual void render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                             RenderCounters& counters) const = 0;
};

/// Describes one integrator of the registry.
struct IntegratorEntry {
    std::string_view name;
    std::string_view summary;  ///< for --help
    std::unique_ptr<const Integrator> (*make)(const IntegratorOptions&);
    int longest_path = std::numeric_limits<int>::max();  ///< edges
    bool splits_light_samples = false;                   ///< it looks at IntegratorOptions::light_samples
    bool has_strategies = false;                         ///< it looks at the options for them
    bool has_expressions = true;                         ///< it tells the light of paths apart
    bool shows_light = true;                             ///< false: something else, for finding out what is wrong
};

[[nodiscard]] std::span<const IntegratorEntry> integrator_registry();

/// Returns the integrator of that name in the registry; null if there is none.
[[nodiscard]] const IntegratorEntry* find_integrator(std::string_view name);

/// Makes the integrator of that name; null if there is none.
[[nodiscard]] std::unique_ptr<const Integrator> make_integrator(std::string_view name,
                                                                const IntegratorOptions& options);

}  // namespace etendue
