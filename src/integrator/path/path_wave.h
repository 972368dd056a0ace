// A wave of paths that advance together, one bounce at a time.
#pragma once

#include "core/ray.h"
#include "integrator/integrator.h"
#include "integrator/path/path_light.h"
#include "integrator/path/path_places.h"
#include "integrator/path/path_scattering.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace etendue {

/// Orders the stages that paths go through: about 250 bytes a path with its shadow ray, 64 more where lights are chosen
/// by what they light.
class PathWave final : public IntegratorScratch {
  public:
    static constexpr std::size_t kCapacity = PathColumns::kCapacity;

    PathWave();
    [[nodiscard]] std::size_t bytes() const override;

    /// Returns the estimate of lamps in view, to be started before the job's samples are traced and finished after
    /// them.
    [[nodiscard]] LampsInView& lamps() { return light_.lamps; }
    /// Traces samples [first, first + count) of the job, count <= kCapacity.
    void trace(const World& world, const TileJob& job, const IntegratorSettings& settings, std::size_t first,
               std::size_t count, TileBuffer& tile, RenderCounters& counters);

  private:
    /// Finds what the eye sees through clear surfaces where rays have hit what is hidden from it or too far away.
    void look_again(const World& world, const TileJob& job, RenderCounters& counters);
    /// Shades all paths, block by block, and calls `trace_shadow_rays` whenever there are enough shadow rays for a
    /// batch.
    template <typename TraceShadowRays>
    void shade(const PathContext& context, const TraceShadowRays& trace_shadow_rays);
    /// Advances paths [first, first + count), count <= kBlockLanes, stage by stage, and moves those that go on to
    /// where `kept` says.
    void shade_block(const PathContext& context, std::size_t first, std::size_t count, std::size_t& kept);
    /// Queues the shadow rays of the `round`-th light samples of `paths`, whose BSDFs lanes have evaluated.
    template <typename Stamp>
    void queue_light_samples(const PathContext& context, const LaneList& paths, std::uint32_t round,
                             const Stamp& stamp);
    /// Takes all light samples of the block but the first, for paths that have more than one.
    template <typename Stamp>
    void take_more_light_samples(const PathContext& context, const Stamp& stamp);
    /// Russian roulette for the paths of the block. Moves those that go on to where `kept` says, their throughput
    /// divided by their chance.
    void keep_survivors(const PathContext& context, std::size_t& kept);

    std::size_t active_ = 0;  ///< paths that are under way; those that end are squeezed out after every bounce
    WavePaths paths_;
    PathBlock block_;
    PathLight light_{paths_, block_};
    PathScattering scattering_{paths_, block_, light_};
    PathPlaces places_{paths_, block_, light_, scattering_};
    std::vector<Ray> camera_rays_;  ///< by slot
};

}  // namespace etendue
