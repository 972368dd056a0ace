// Trees of mirrored and refracted rays, one for each of a run of camera samples, traced in batches.
#pragma once

#include "core/ray.h"
#include "core/ray_cone.h"
#include "core/rgb.h"
#include "wave/camera_wave.h"
#include "wave/connections.h"
#include "wave/lamps_in_view.h"
#include "wave/number_pairs.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

class Scattering;

/// A ray of a tree that is yet to be traced.
struct WhittedBranch {
    Ray ray;
    Interior interior;  ///< only if the World has bodies
    Rgb throughput{1.0f};
    /// Product of eta² over the refractions so far: what radiance scaling took from the throughput and the choice of
    /// branches must not see.
    float eta_scale = 1.0f;
    float wavelength_nm = 0.0f;  ///< nanometres once a dispersive body has refracted it, 0 for all wavelengths
    RayCone cone;                ///< followed only where there are textures to filter
    std::uint32_t slot = 0;      ///< which camera sample
    std::uint32_t seed = 0;      ///< of its random numbers: unlike those of all other branches
    int edges = 1;               ///< when the ray has hit; hidden boundaries add none
    int rays = 1;                ///< from the camera to here, this one included
};

class WhittedWave final : public IntegratorScratch {
  public:
    /// Camera samples in a wave, and rays in a batch.
    static constexpr std::size_t kCapacity = 2048;

    [[nodiscard]] std::size_t bytes() const override;

    /// Returns the estimate of lamps in view, to be started before the job's samples are traced and finished after
    /// them.
    [[nodiscard]] LampsInView& lamps() { return lamps_; }
    /// Traces samples [first, first + count) of the job, count <= kCapacity.
    void trace(const World& world, const TileJob& job, const PathLengths& lengths, std::size_t first, std::size_t count,
               TileBuffer& tile, RenderCounters& counters);

  private:
    struct Context {
        const World& world;
        const TileJob& job;
        const PathLengths& lengths;
    };

    /// Takes the youngest branches, at most kCapacity, and replaces them by those that grow from them. What waits is so
    /// at most the depth of the trees times what one batch grows.
    void trace_batch(const Context& context, TileBuffer& tile, RenderCounters& counters);
    void shade(const Context& context, std::size_t i);
    void scatter(const Context& context, std::size_t i, const SurfacePoint& point,
                 const std::optional<Crossing>& crossing);
    /// Samples a light and the environment. `factor` is what the throughput has to be multiplied by for direct light.
    void queue_direct_light(const Context& context, std::size_t i, const SurfacePoint& point,
                            const Scattering& scattering, const std::optional<Crossing>& crossing, const Rgb& factor);
    /// Queues the light along a sample, times `weight` over its density.
    void queue(const Context& context, std::size_t i, const SurfacePoint& point, const Scattering& scattering,
               const std::optional<Crossing>& crossing, const LightSample& light, const Rgb& weight);
    void add_environment(const Context& context, const WhittedBranch& branch);
    /// Returns a branch that goes on from branch `i` as its child number `child`, without ray, throughput and edges.
    [[nodiscard]] WhittedBranch grow(const Context& context, std::size_t i, std::uint32_t child) const;
    /// Keeps `branch` for a later batch, unless it ends here.
    void push(WhittedBranch branch);

    std::vector<WhittedBranch> waiting_;
    // By branch of the batch.
    std::vector<WhittedBranch> batch_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    SampleKeys keys_;
    NumberPairs light_choice_, light_triangle_, light_direction_, environment_direction_;
    Connections shadow_rays_{RayKind::Shadow};
    LampsInView lamps_;
    // By slot, that is, by camera sample.
    std::vector<CameraSample> samples_;
    SampleLight found_;
    std::vector<float> alpha_;
};

}  // namespace etendue
