// A wave of eye and light subpaths, and all connections between them.
#pragma once

#include "integrator/bdpt/bdpt_job.h"
#include "integrator/bdpt/connection_lanes.h"
#include "integrator/bdpt/light_vertices.h"
#include "integrator/integrator.h"
#include "transport/strategy_sums.h"
#include "wave/lamps_in_view.h"
#include "wave/photons.h"
#include "wave/shadow_ray_queue.h"
#include "wave/subpath/connectible_vertices.h"
#include "wave/subpath/lamps_to_camera.h"
#include "wave/subpath/subpath_wave.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

namespace etendue {

/// Traces and connects the subpaths of many samples.
class BdptWave final : public IntegratorScratch {
  public:
    /// Bounds the samples of a wave, so that their ten or so vertices each, with 248 bytes more for a lobe that was
    /// evaluated there, stay in a cache of 2 MiB until they are connected.
    static constexpr std::size_t kCapacity = 512;
    static_assert(sizeof(PathVertex) + sizeof(DiffuseEnd) <= 320);

    [[nodiscard]] std::size_t bytes() const override;

    /// Starts a job, before its samples are traced.
    void start(const World& world, const TileJob& job, const IntegratorSettings& settings);
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
    /// Holds a connection of two plain diffuse vertices. Many such connections are computed at once, one in each lane.
    struct WideBetween {
        const ConnectibleVertex* eye;
        const ConnectibleVertex* light;
        const DiffuseEnd* eye_end;
        const DiffuseEnd* light_end;
        float scale;
    };
    /// Chooses lights for those of eye vertices [first, last) whose connections to them are wanted.
    void choose_lights(const BdptJob& job, std::size_t first, std::size_t last);
    /// Connects eye vertices [first, last) to points on lights that are sampled for them: s = 1.
    void connect_to_lights(const BdptJob& job, std::size_t first, std::size_t last);
    /// Merges eye vertices with the photons of the job.
    void merge(const BdptJob& job);
    /// Connects light vertices [first, last) to points on the lens that are sampled for them: t = 1.
    void connect_to_camera(const BdptJob& job, std::size_t first, std::size_t last);
    /// Connects eye vertices [first, last) to light vertices: s > 1, t > 1. Adds what connections bring, as soon as
    /// there are enough of them to be traced together, to `found_` and `tile`.
    void connect_to_vertices(const BdptJob& job, std::size_t first, std::size_t last, TileBuffer& tile,
                             RenderCounters& counters);
    /// Empties each of `queues` that is full, by tracing its rays.
    void resolve_full(const BdptJob& job, std::initializer_list<ShadowRayQueue*> queues, TileBuffer& tile,
                      RenderCounters& counters);
    /// Weighs and queues the connections in `between_`, and clears it.
    void weigh_between(const BdptJob& job);
    /// Draws `count` vertices from the cache for `eye`, in place of all that the cache has of an average light subpath.
    void find_cached(const BdptJob& job, const ConnectibleVertex& eye, int count);
    void find(const BdptJob& job, const ConnectibleVertex& eye, const DiffuseEnd& eye_end,
              const ConnectibleVertex& light, float scale);
    void find_singly(const BdptJob& job, const ConnectibleVertex& eye, const ConnectibleVertex& light, float scale);
    // With what both ends scatter: weights, and the rays that will tell.
    void weigh(const BdptJob& job, const ToLight& connection);
    void weigh(const BdptJob& job, const ToCamera& connection);
    void weigh(const BdptJob& job, const Between& connection);
    // All of that at once, for those that are computed so.
    void weigh_wide_to_lights(const BdptJob& job);
    void weigh_wide_to_camera(const BdptJob& job);
    void weigh_wide_between(const BdptJob& job);
    /// Returns false if there is nothing to say of connections but their rays and the light that they bring.
    [[nodiscard]] bool asks_for_each(const BdptJob& job);
    /// Leaves the first `count` connections of a block, of which there is nothing else to say, to `connections`.
    static void queue_wide(const ConnectionColumns& lanes, std::size_t count, ShadowRayQueue& connections);
    // Leaves the rays of connections, with what they bring, to `connections`.
    void queue(const BdptJob& job, const ConnectibleVertex& vertex, std::uint32_t light, const Vec3f& wi, Ray ray,
               const Rgb& brought, ShadowRayQueue& connections);
    void queue(const BdptJob& job, const ConnectibleVertex& vertex, const CameraView& view, Ray ray, const Rgb& brought,
               ShadowRayQueue& connections);
    void queue(const BdptJob& job, const ConnectibleVertex& eye, const ConnectibleVertex& light, Ray ray,
               const Rgb& brought, ShadowRayQueue& connections);

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
    LightVertices light_vertices_;
    // Of the block at hand.
    std::vector<ToLight> to_lights_;
    std::vector<ToCamera> to_cameras_, wide_to_cameras_;
    static constexpr std::size_t kMostBetween = 4096;  ///< size at which `between_` is weighed and cleared
    std::vector<Between> between_;
    std::vector<LightReceiver> receivers_;
    std::vector<Vec2f> choosing_;  ///< numbers for the choice of a light
    std::vector<LightTree::Choice> choices_;
    std::vector<std::size_t> lit_;  ///< vertices that the numbers and choices are for, as places in `to_light_`
    std::vector<std::size_t> wide_to_lights_;  ///< vertices whose lanes are computed at once, as places in `lit_`
    std::array<WideBetween, kBlockLanes> wide_between_{};
    std::size_t wide_between_count_ = 0;
    ToLightLanes to_light_lanes_;
    ToCameraLanes to_camera_lanes_;
    BetweenLanes between_lanes_;
    // Queues of shadow rays. Connections that lanes compute have queues of their own, so that the order in which a
    // sample's light is added does not depend on the samples beside it.
    ShadowRayQueue light_connections_{RayKind::Shadow}, wide_light_connections_{RayKind::Shadow};
    ShadowRayQueue camera_connections_{RayKind::LightToCamera}, wide_camera_connections_{RayKind::LightToCamera};
    ShadowRayQueue vertex_connections_{RayKind::Connection}, wide_vertex_connections_{RayKind::Connection};
};

}  // namespace etendue
