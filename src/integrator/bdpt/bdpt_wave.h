// A wave of eye and light subpaths, and all connections between them.
#pragma once

#include "integrator/bdpt/bdpt_options.h"
#include "integrator/bdpt/reference_weights.h"
#include "integrator/bdpt/strategy_sums.h"
#include "integrator/connections.h"
#include "integrator/subpath/camera_splat.h"
#include "integrator/subpath/connectible_vertices.h"
#include "integrator/subpath/subpath_wave.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace etendue {

class BdptWave final : public IntegratorScratch, private LightFinder {
  public:
    /// Samples in a wave. A vertex takes 208 bytes, and 248 more for a lobe that was evaluated there: the ten or so of
    /// a sample stay in a cache of 2 MiB until they are connected.
    static constexpr std::size_t kCapacity = 512;
    /// Vertices whose connections go from one stage to the next together.
    static constexpr std::size_t kBlock = 64;

    [[nodiscard]] std::size_t bytes() const override;

    /// Traces samples [first, first + count) of the job, count <= kCapacity.
    void trace(const World& world, const TileJob& job, const BdptOptions& options, std::size_t first, std::size_t count,
               TileBuffer& tile, RenderCounters& counters);

  private:
    struct Context : SubpathJob {
        const BdptOptions& options;

        /// True if the vertex may be connected to those of other samples: each sample has a time and a wavelength of
        /// its own.
        [[nodiscard]] bool is_shared(const PathVertex& vertex) const {
            return options.cached_connections > 0 && !world.has_motion() && !vertex.is_dispersed;
        }
    };

    // s = 0: subpaths from the eye that meet a light.
    void on_emitter(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction,
                    const SubpathDensities& arrived) override;
    void on_unlit(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction) override;
    void on_escape(const SubpathState& state, const Vec3f& direction) override;
    void on_first_hits(std::span<const Ray> rays, std::span<const Hit> hits) override;
    void add(const SubpathState& state, const Rgb& light, const StrategySums& sums, const PathLightEnd& end,
             const AovSet::Source& source);

    // Connections on their way through the stages.
    struct ToLight {
        const PathVertex* vertex = nullptr;
        ChosenLight chosen{};
        Scattering::TwoWayValue scattered{};
    };
    struct ToCamera {
        const PathVertex* vertex = nullptr;
        CameraView view{};
        Scattering::TwoWayValue scattered{};
    };
    struct Between {
        const PathVertex* eye = nullptr;
        const PathVertex* light = nullptr;
        Vec3f w{0.0f};         ///< unit, from `eye` to `light`
        float squared = 0.0f;  ///< of the distance, m²
        float scale = 1.0f;    ///< how many connections this one stands for
        Scattering::TwoWayValue at_eye{};
        Scattering::TwoWayValue at_light{};
    };

    /// s = 1 of eye vertices [first, last): to points on lights that are sampled for them.
    void connect_to_lights(const Context& context, std::size_t first, std::size_t last);
    /// t = 1 of light vertices [first, last): to points on the lens that are sampled for them.
    void connect_to_camera(const Context& context, std::size_t first, std::size_t last);
    /// s > 1, t > 1 of eye vertices [first, last).
    void connect_to_vertices(const Context& context, std::size_t first, std::size_t last);
    /// All of the sample's own light subpath that the cache does not have.
    void find_own(const Context& context, const PathVertex& eye);
    /// `count` vertices drawn from the cache, in place of all that it has of an average light subpath.
    void find_cached(const Context& context, const PathVertex& eye, int count);
    void find(const Context& context, const PathVertex& eye, const PathVertex& light, float scale);
    // With what both ends scatter: weights, and the rays that will tell.
    void weigh(const Context& context, const ToLight& connection);
    void weigh(const Context& context, const ToCamera& connection);
    void weigh(const Context& context, const Between& connection);

    [[nodiscard]] static float weight(const BdptOptions& options, const StrategySums& sums) {
        return options.weighted ? static_cast<float>(sums.weight()) : 1.0f;
    }

    /// Shows the weight of a path to the observer, and in debug builds compares it with the reference. The path leads
    /// from `end` over the subpath that ends in `light` and back over that which ends in `eye`; either may be null.
    void check(const SubpathJob& job, const BdptOptions& options, std::size_t s, float weight, const PathLightEnd& end,
               const PathVertex* light, const PathVertex* eye, const CameraConnection& camera) const;
    [[nodiscard]] PathLightEnd light_end(std::uint32_t slot) const;
    /// How the camera sees the first vertex of a sample's eye subpath.
    [[nodiscard]] CameraConnection camera_of(const SubpathJob& job, const PathVertex& eye) const;

    std::vector<CameraSample> samples_;
    std::vector<Ray> camera_rays_;
    SampleLight found_;
    std::vector<float> alpha_;
    std::vector<ExpressionShare> shares_;  ///< of the path at hand
    SubpathWave eye_{SubpathEnd::AtEye};
    SubpathWave light_{SubpathEnd::AtLight};
    VerticesToLight to_light_;
    VerticesToCamera to_camera_;
    /// Light vertices that eye vertices of any sample may be connected to, if options ask for that.
    std::vector<const PathVertex*> cache_;
    // Of the block at hand.
    std::vector<ToLight> to_lights_;
    std::vector<ToCamera> to_cameras_;
    std::vector<Between> between_;
    // That wait for their rays.
    Connections light_connections_{RayKind::Shadow};
    Connections camera_connections_{RayKind::LightToCamera};
    Connections vertex_connections_{RayKind::Connection};
    const Context* context_ = nullptr;  ///< of the call of `trace` under way, for what eye subpaths find
    TileBuffer* tile_ = nullptr;        ///< the same
};

}  // namespace etendue
