// A wave of eye and light subpaths, and all connections between them.
#pragma once

#include "integrator/bdpt/complete_path.h"
#include "integrator/bdpt/connection_lanes.h"
#include "integrator/bdpt/weight_observer.h"
#include "integrator/integrator.h"
#include "transport/strategy_sums.h"
#include "wave/connections.h"
#include "wave/lamps_in_view.h"
#include "wave/photons.h"
#include "wave/subpath/camera_splat.h"
#include "wave/subpath/connectible_vertices.h"
#include "wave/subpath/lamps_to_camera.h"
#include "wave/subpath/subpath_wave.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

class BdptWave final : public IntegratorScratch, private LightFinder {
  public:
    /// Samples in a wave. A vertex takes 316 bytes, its MatteEnd included, and 248 more for a lobe that was evaluated
    /// there: the ten or so of a sample stay in a cache of 2 MiB until they are connected.
    static constexpr std::size_t kCapacity = 512;
    /// Vertices whose connections go from one stage to the next together.
    static constexpr std::size_t kBlock = kBlockLanes;

    [[nodiscard]] std::size_t bytes() const override;

    /// Starts a job, before its samples are traced. `observer` may be null.
    void start(const World& world, const TileJob& job, const IntegratorSettings& settings, WeightObserver* observer);
    /// Ends the job, after its samples are traced.
    void finish(TileBuffer& tile, RenderCounters& counters) { lamps_.finish(tile, counters); }
    /// Appends to `photons` those of the light subpaths of samples [first, first + count) of the job, count <=
    /// kCapacity.
    void trace_photons(const World& world, const TileJob& job, const IntegratorSettings& settings, std::size_t first,
                       std::size_t count, PhotonList& photons, RenderCounters& counters);
    /// Traces samples [first, first + count) of the job, count <= kCapacity.
    void trace(const World& world, const TileJob& job, const IntegratorSettings& settings, std::size_t first,
               std::size_t count, TileBuffer& tile, RenderCounters& counters);

  private:
    struct Context : SubpathJob {
        const IntegratorSettings& settings;

        /// True if the vertex may be connected to those of other samples: each sample has a time and a wavelength of
        /// its own.
        [[nodiscard]] bool is_shared(const ConnectibleVertex& vertex) const {
            return settings.cached_connections > 0 && !world.traits().has_motion && !vertex.is_dispersed;
        }
        [[nodiscard]] bool wants(int edges) const { return edges >= lengths.min_depth && edges <= lengths.max_depth; }
        [[nodiscard]] bool wants(const Strategy& strategy) const {
            return !settings.strategy || *settings.strategy == strategy;
        }
        [[nodiscard]] WeightRule rule() const { return {raised, settings.weighted}; }
    };

    // s = 0: subpaths from the eye that meet a light.
    void on_emitter(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction,
                    const SubpathDensities& arrived) override;
    void on_unlit(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction) override;
    void on_escape(const SubpathState& state, const Vec3f& direction) override;
    void on_first_hits(std::span<const Ray> rays, std::span<const Hit> hits) override;
    [[nodiscard]] bool knows_emission(const Hit& first_hit) const override { return lamps_.finds(first_hit); }
    void add(const SubpathState& state, const Rgb& light, const StrategySums& sums, const PathLightEnd& end,
             const AovSet::Source& source);

    // Connections on their way through the stages, one by one.
    struct ToLight {
        const ConnectibleVertex* vertex = nullptr;
        ChosenLight chosen{};
        Scattering::TwoWayValue scattered{};
    };
    struct ToCamera {
        const ConnectibleVertex* vertex = nullptr;
        CameraView view{};
        Scattering::TwoWayValue scattered{};
    };
    struct Between {
        const ConnectibleVertex* eye = nullptr;
        const ConnectibleVertex* light = nullptr;
        Vec3f w{0.0f};         ///< unit, from `eye` to `light`
        float squared = 0.0f;  ///< squared distance, m²
        float scale = 1.0f;    ///< how many connections this one stands for
        Scattering::TwoWayValue at_eye{};
        Scattering::TwoWayValue at_light{};
    };
    // Those of plain matte surfaces, whose lanes are computed at once.
    struct WideToLight {
        const ConnectibleVertex* vertex;
        std::uint32_t light;     ///< light that was chosen
        std::uint32_t triangle;  ///< triangle of the light
    };
    struct WideToCamera {
        const ConnectibleVertex* vertex;
        CameraView view;
    };
    struct WideBetween {
        const ConnectibleVertex* eye;
        const ConnectibleVertex* light;
        const MatteEnd* eye_end;
        const MatteEnd* light_end;
        float scale;
    };
    /// A light vertex, as eye vertices look for it.
    struct Candidate {
        ConnectibleVertex vertex;
        bool is_shared;
    };

    /// Connects eye vertices [first, last) to points on lights that are sampled for them: s = 1.
    void connect_to_lights(const Context& context, std::size_t first, std::size_t last);
    /// Merges eye vertices with the photons of the job.
    void merge(const Context& context);
    /// Connects light vertices [first, last) to points on the lens that are sampled for them: t = 1.
    void connect_to_camera(const Context& context, std::size_t first, std::size_t last);
    /// Connects eye vertices [first, last) to light vertices: s > 1, t > 1.
    void connect_to_vertices(const Context& context, std::size_t first, std::size_t last);
    /// Brings the light vertices into an order in which those of a sample are side by side, and into the cache.
    void find_candidates(const Context& context);
    /// Finds for `eye` all vertices of its sample's own light subpath that the cache does not have.
    void find_own(const Context& context, const ConnectibleVertex& eye);
    /// Draws `count` vertices from the cache for `eye`, in place of all that the cache has of an average light subpath.
    void find_cached(const Context& context, const ConnectibleVertex& eye, int count);
    void find(const Context& context, const ConnectibleVertex& eye, const MatteEnd& eye_end,
              const ConnectibleVertex& light, float scale);
    void find_singly(const ConnectibleVertex& eye, const ConnectibleVertex& light, float scale);
    // With what both ends scatter: weights, and the rays that will tell.
    void weigh(const Context& context, const ToLight& connection);
    void weigh(const Context& context, const ToCamera& connection);
    void weigh(const Context& context, const Between& connection);
    // All of that at once, for those that are computed so.
    void weigh_wide_to_lights(const Context& context);
    void weigh_wide_to_camera(const Context& context);
    void weigh_wide_between(const Context& context);
    /// Returns false if there is nothing to say of connections but their rays and the light that they bring.
    [[nodiscard]] bool asks_for_each(const Context& context);
    /// Leaves the first `count` connections of a block, of which there is nothing else to say, to `connections`.
    static void queue_wide(const ConnectionColumns& lanes, std::size_t count, Connections& connections);
    // Leaves the rays of connections, with what they bring, to `connections`.
    void queue(const Context& context, const ConnectibleVertex& vertex, const PathLightEnd& end, Ray ray,
               const Brought& brought, Connections& connections);
    void queue(const Context& context, const ConnectibleVertex& vertex, const CameraView& view, Ray ray,
               const Brought& brought, Connections& connections);
    void queue(const Context& context, const ConnectibleVertex& eye, const ConnectibleVertex& light, Ray ray,
               const Brought& brought, Connections& connections);

    [[nodiscard]] static float weight(const IntegratorSettings& settings, const StrategySums& sums) {
        return settings.weighted ? static_cast<float>(sums.weight()) : 1.0f;
    }

    /// Shows the weight of a path to the observer. The path leads from `end` over the subpath that ends in `light` and
    /// back over that which ends in `eye`; either may be null.
    void show(const SubpathJob& job, std::size_t s, float weight, const PathLightEnd& end, const PathVertex* light,
              const PathVertex* eye, const CameraConnection& camera);
    [[nodiscard]] PathLightEnd light_end(std::uint32_t slot) const;
    /// Returns how the camera sees `eye`, the first vertex of a sample's eye subpath.
    [[nodiscard]] CameraConnection camera_of(const SubpathJob& job, const PathVertex& eye) const;

    std::vector<CameraSample> samples_;
    std::vector<Ray> camera_rays_;
    SampleLight found_;
    LampsInView lamps_;
    std::vector<float> alpha_;
    std::vector<ExpressionShare> shares_;  ///< shares of expressions in the light of the path at hand
    SubpathWave eye_{SubpathEnd::AtEye, true};
    SubpathWave light_{SubpathEnd::AtLight, true};
    LampsToCamera lamps_to_camera_;
    VerticesToLight to_light_;
    VerticesToCamera to_camera_;
    std::vector<Candidate> own_;            ///< sample by sample, the last vertex first
    std::vector<std::uint32_t> own_begin_;  ///< by slot, and the end of the last
    /// Holds the light vertices that eye vertices of any sample may be connected to, if settings ask for that.
    std::vector<Candidate> cache_;
    // Of the block at hand.
    std::vector<ToLight> to_lights_;
    std::vector<ToCamera> to_cameras_;
    std::vector<Between> between_;
    std::vector<LightReceiver> receivers_;
    std::vector<Vec2f> choosing_;  ///< numbers for the choice of a light
    std::vector<LightTree::Choice> choices_;
    std::vector<std::size_t> lit_;  ///< whose they are
    std::vector<WideToLight> wide_to_lights_;
    std::vector<WideToCamera> wide_to_cameras_;
    std::array<WideBetween, kBlockLanes> wide_between_{};
    std::size_t wide_between_count_ = 0;
    ToLightLanes to_light_lanes_;
    ToCameraLanes to_camera_lanes_;
    BetweenLanes between_lanes_;
    // That wait for their rays. What is computed at once waits by itself: which comes first of it and of the others of
    // a sample would depend on what other samples are beside it, and not only where a queue fills.
    Connections light_connections_{RayKind::Shadow}, wide_light_connections_{RayKind::Shadow};
    Connections camera_connections_{RayKind::LightToCamera}, wide_camera_connections_{RayKind::LightToCamera};
    Connections vertex_connections_{RayKind::Connection}, wide_vertex_connections_{RayKind::Connection};
    WeightObserver* observer_ = nullptr;  ///< sees weights; null if nobody does
    const Context* context_ = nullptr;    ///< context of the call of `trace` under way
    TileBuffer* tile_ = nullptr;          ///< tile of the call of `trace` under way
    RenderCounters* counters_ = nullptr;  ///< counters of the call of `trace` under way
};

}  // namespace etendue
