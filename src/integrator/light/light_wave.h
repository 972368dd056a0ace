// A wave of light subpaths that advance together, one bounce at a time.
#pragma once

#include "core/ray.h"
#include "core/rgb.h"
#include "integrator/camera_wave.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

class Scattering;

/// A subpath under way.
struct LightPathState {
    Ray ray;
    Rgb throughput;
    float begun_with = 0.0f;     ///< largest channel of the throughput at the light, for Russian roulette
    float wavelength_nm = 0.0f;  ///< nanometres once a dispersive body has refracted it, 0 for all wavelengths
    SampleKey key;
    int edges = 1;  ///< of the path when its ray has hit; media and hidden boundaries add none
    Interior interior;
};

/// What the camera sees if nothing is in the way.
struct PendingSplat {
    Splat splat;
    SampleKey key;  ///< whose light it is
};

class LightWave final : public IntegratorScratch {
  public:
    static constexpr std::size_t kCapacity = 2048;

    /// Traces one subpath for each of the samples [first, first + count) of the job, count <= kCapacity.
    void trace(const World& world, const TileJob& job, const IntegratorOptions& options, std::size_t first,
               std::size_t count, TileBuffer& tile, RenderCounters& counters);

  private:
    struct Context {
        const World& world;
        const TileJob& job;
        const IntegratorOptions& options;
        int depth;  ///< rays that each path has traced
    };

    /// Begins a path for each camera sample, and shows the camera where it begins.
    void emit(const Context& context);
    void shade(const Context& context);
    /// Advances a path; false if it ends.
    bool shade_path(const Context& context, const Hit& hit, LightPathState& state);
    bool scatter_in_medium(const Context& context, const Hit& hit, LightPathState& state);
    bool scatter_at_surface(const Context& context, const SurfacePoint& point, const std::optional<Crossing>& crossing,
                            LightPathState& state);
    bool survives(const Context& context, LightPathState& state) const;
    /// The camera sees a point if `reflected(direction)`, what goes from there along the unit direction towards the
    /// lens, is not black. Rays start at `start(direction)`.
    template <typename Reflected, typename Start>
    void connect(const Context& context, const LightPathState& state, const Vec3f& position, const Reflected& reflected,
                 const Start& start);
    void add_unoccluded(const World& world, TileBuffer& tile, RenderCounters& counters);

    std::vector<LightPathState> paths_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<CameraSample> samples_;
    std::vector<Ray> shadow_rays_;
    std::vector<PendingSplat> pending_;
    std::vector<std::uint8_t> occluded_;
};

}  // namespace etendue
