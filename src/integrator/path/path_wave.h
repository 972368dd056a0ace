// A wave of paths that advance together, one bounce at a time.
#pragma once

#include "core/ray.h"
#include "core/rgb.h"
#include "integrator/camera_wave.h"
#include "integrator/path/path_integrator.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

class Scattering;

/// A path under way; its ray stands beside it in `PathWave::rays`.
struct PathState {
    Rgb throughput{1.0f};
    /// Product of eta² over the refractions so far: what radiance scaling took from the throughput and Russian roulette
    /// must not see.
    float eta_scale = 1.0f;
    float pdf_solid_angle = 0.0f;  ///< of the ray's direction; not meaningful after a delta
    std::uint32_t slot = 0;        ///< which camera sample
    bool after_delta = true;  ///< the last scattering was a delta, or there was none: lights cannot be sampled for it
    bool only_delta = true;   ///< every scattering was: the eye sees this directly or in mirrors
};

/// What a shadow ray brings if it arrives.
struct PendingLight {
    Rgb contribution;
    std::uint32_t slot = 0;
};

/// Structure-of-arrays state of a wave. About 200 bytes a path.
class PathWave final : public IntegratorScratch {
  public:
    /// Paths in a wave: enough to fill ray packets after many have ended, and about 400 KiB, a fifth of an L2 cache of
    /// 2 MiB.
    static constexpr std::size_t kCapacity = 2048;

    PathWave();

    /// Traces samples [first, first + count) of the job, count <= kCapacity.
    void trace(const World& world, const TileJob& job, const PathOptions& options, std::size_t first, std::size_t count,
               TileBuffer& tile, RenderCounters& counters);

  private:
    struct Context {
        const World& world;
        const TileJob& job;
        const PathOptions& options;
        int depth;  ///< edges of the paths when their current rays have hit
    };

    /// Random numbers of all active paths for this bounce, many at a time.
    void draw_numbers(const Context& context);
    void shade(const Context& context);
    /// Advances path `i`; returns false if it ends.
    bool shade_path(const Context& context, std::size_t i, PathState& next, Ray& next_ray);
    void add_environment(const Context& context, const PathState& state, const Ray& ray);
    void add_emission(const Context& context, const PathState& state, const Ray& ray, const Hit& hit,
                      const SurfacePoint& point);
    void queue_direct_light(const Context& context, std::size_t i, const SurfacePoint& point,
                            const Scattering& scattering);
    [[nodiscard]] std::uint32_t alpha_key(const Context& context, std::size_t i) const;
    void add_unoccluded(const World& world, RenderCounters& counters);

    /// Pairs of random numbers, one of each kind per path.
    struct Numbers {
        std::vector<float> x;
        std::vector<float> y;

        [[nodiscard]] Vec2f pair(std::size_t i) const { return {x[i], y[i]}; }
    };
    void draw(const Context& context, std::uint32_t which, Numbers& numbers);

    // By active path; paths that end are squeezed out after every bounce.
    std::size_t active_ = 0;
    std::vector<PathState> states_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<std::uint32_t> pixel_seeds_;
    std::vector<std::uint32_t> sample_indices_;
    Numbers light_choice_;
    Numbers light_triangle_;
    Numbers light_direction_;
    Numbers bsdf_direction_;
    Numbers choices_;  ///< x: which lobe, y: whether the path ends
    std::size_t pending_count_ = 0;
    std::vector<Ray> shadow_rays_;
    std::vector<PendingLight> pending_;
    std::vector<std::uint8_t> occluded_;
    // By slot, that is, by camera sample.
    std::vector<CameraSample> samples_;
    std::vector<Rgb> radiance_;
    std::vector<float> alpha_;
};

}  // namespace etendue
