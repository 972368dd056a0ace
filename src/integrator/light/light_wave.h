// A wave of light subpaths, all of whose vertices are shown to the camera.
#pragma once

#include "integrator/integrator.h"
#include "wave/shadow_ray_queue.h"
#include "wave/subpath/connectible_vertices.h"
#include "wave/subpath/lamps_to_camera.h"
#include "wave/subpath/subpath_wave.h"

#include <cstddef>
#include <vector>

namespace etendue {

class LightWave final : public IntegratorScratch {
  public:
    static constexpr std::size_t kCapacity = 2048;

    [[nodiscard]] std::size_t bytes() const override;

    /// Traces one subpath for each of the samples [first, first + count) of the job, count <= kCapacity.
    void trace(const World& world, const TileJob& job, const IntegratorSettings& settings, std::size_t first,
               std::size_t count, TileBuffer& tile, RenderCounters& counters);

  private:
    void trace_subpaths(const World& world, const TileJob& job, const IntegratorSettings& settings, TileBuffer& tile,
                        RenderCounters& counters);
    void connect_vertices(const SubpathJob& job, TileBuffer& tile, RenderCounters& counters);

    std::vector<CameraSample> samples_;
    std::vector<Ray> camera_rays_;
    std::vector<Hit> hits_;  ///< hits of the camera rays, if layers ask for them
    std::vector<float> alpha_;
    SampleLight found_;                    ///< nothing but rays: all light falls on the film
    std::vector<ExpressionShare> shares_;  ///< shares of expressions in the light of the path at hand
    SubpathWave subpaths_{SubpathEnd::AtLight, false};
    VerticesToCamera to_camera_;
    LampsToCamera lamps_;
    ShadowRayQueue connections_{RayKind::LightToCamera};
};

}  // namespace etendue
