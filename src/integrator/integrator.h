// What every light transport algorithm is: something that adds samples to one tile.
//
// To add another, see CONTRIBUTING.md (An integrator).
#pragma once

#include "film/film.h"
#include "transport/heuristic.h"
#include "transport/path_lengths.h"
#include "transport/strategy.h"
#include "wave/photons.h"
#include "wave/render_counters.h"
#include "wave/tile_job.h"
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

/// Holds all that can be asked of integrators; each integrator takes the options that concern it.
struct IntegratorOptions {
    PathLengths lengths{};
    std::uint32_t light_samples = 1;           ///< see PathOptions
    Heuristic heuristic = Heuristic::Balance;  ///< weighs strategies, where an integrator has them
    std::optional<Strategy> strategy{};        ///< this one alone; it exists
    bool weighted = true;                      ///< false: the strategy is all there is, as if no other made its paths
    int cached_connections = 0;                ///< of bdpt: see BdptOptions
    MergeOptions merging{.at = MergeAt::BetweenDeltas};  ///< of vcm
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

    /// Returns where subpaths of `job`, whose samples have one index, merge. Where they do, a pass has one sample of
    /// every pixel, `trace_photons` is called for all of `job.window` before it, and jobs hold what it has left.
    [[nodiscard]] virtual Merging merging(const World&, const TileJob&) const { return {}; }

    /// Appends to `photons` those of the light subpaths of the samples of `job`.
    virtual void trace_photons(const World&, const TileJob&, IntegratorScratch&, PhotonList&, RenderCounters&) const {}

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
    bool merges = false;                                 ///< it looks at IntegratorOptions::merging
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
