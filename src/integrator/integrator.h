// What every light transport algorithm is: something that adds samples to one tile.
//
// To add another, see CONTRIBUTING.md (An integrator).
#pragma once

#include "film/film.h"
#include "scene/integrator_settings.h"
#include "wave/lamp_images.h"
#include "wave/photons.h"
#include "wave/render_counters.h"
#include "wave/tile_job.h"
#include "world/world.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

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
    [[nodiscard]] virtual std::vector<std::string> unreachable_light(const World& /*world*/) const { return {}; }

    /// Returns a sentence for each option that was asked for and has no effect on this algorithm in the given world.
    [[nodiscard]] virtual std::vector<std::string> ineffective_options(const World&) const { return {}; }

    /// True if `render_tile` leaves splats, one light path for each of its samples.
    [[nodiscard]] virtual bool makes_splats() const { return false; }

    /// Returns where subpaths of `job`, whose samples have one index, merge. Where they do, a pass has one sample of
    /// every pixel, `trace_photons` is called for all of `job.window` before it, and jobs hold what it has left.
    [[nodiscard]] virtual Merging merging(const World&, const TileJob&) const { return {}; }

    /// Returns the images of lamps that are to get samples of their own in jobs like `whole`, one of the full image;
    /// null for none. They cover `window`, pixels of that image.
    [[nodiscard]] virtual std::unique_ptr<const LampImages> lamp_images(const World&, const TileJob& /*whole*/,
                                                                        const PixelRect& /*window*/) const {
        return nullptr;
    }

    /// Appends to `photons` those of the light subpaths of the samples of `job`.
    virtual void trace_photons(const World&, const TileJob&, IntegratorScratch&, PhotonList&, RenderCounters&) const {}

    /// Adds the samples of `job` to `tile`, which has been reset to its rectangle. The result depends on `job` and the
    /// world only. `scratch` comes from `make_scratch` and is used by no other call at the same time.
    virtual void render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                             RenderCounters& counters) const = 0;
};

/// Names the setting by which integrators that have strategies show one alone.
inline constexpr std::string_view kStrategySetting = "/integrator/strategy";

/// Describes one integrator of the registry.
struct IntegratorEntry {
    std::string_view name;
    std::string_view summary;  ///< for --help
    std::unique_ptr<const Integrator> (*make)(const IntegratorSettings&);
    int longest_path = std::numeric_limits<int>::max();  ///< edges
    /// Lists the settings, by their JSON pointers, that this integrator looks at and not all others do.
    std::span<const std::string_view> own_settings{};
    bool merges = false;          ///< its samples may share photons, so that all pixels have as many
    bool has_expressions = true;  ///< it tells the light of paths apart
    bool has_alpha = true;        ///< the camera sees shadow catchers and holdouts as such
    bool shows_light = true;      ///< false: something else, for finding out what is wrong

    /// Returns true if `own_settings` has this JSON pointer.
    [[nodiscard]] bool owns(std::string_view setting) const {
        return std::ranges::find(own_settings, setting) != own_settings.end();
    }
    [[nodiscard]] bool has_strategies() const { return owns(kStrategySetting); }
};

[[nodiscard]] std::span<const IntegratorEntry> integrator_registry();

/// Returns the integrator of that name in the registry; null if there is none.
[[nodiscard]] const IntegratorEntry* find_integrator(std::string_view name);

/// Makes the integrator of that name, whatever the `type` of `settings`; null if there is none.
[[nodiscard]] std::unique_ptr<const Integrator> make_integrator(std::string_view name,
                                                                const IntegratorSettings& settings);

}  // namespace etendue
