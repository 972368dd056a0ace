// Light that paths meet, and light that is sampled for where they are.
#pragma once

#include "core/rgb.h"
#include "integrator/path/path_block.h"
#include "wave/aov/sample_light.h"
#include "wave/lamps_in_view.h"
#include "wave/shadow_ray_queue.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace etendue {

/// Finds the light of a wave's paths: what they meet, and what is sampled for them, with the shadow rays that tell
/// whether it arrives. Holds at most one batch of shadow rays and those of one block.
class PathLight {
  public:
    /// Keeps references to `paths` and `block`, which must outlive it.
    PathLight(WavePaths& paths, PathBlock& block) : paths_(paths), block_(block) {}
    PathLight(const PathLight&) = delete;
    PathLight& operator=(const PathLight&) = delete;

    /// Adds the light of the environment to paths of the block that have left the scene.
    void add_environment(const PathContext& context);
    /// Adds the light of suns to those of them that scatter or mirror it.
    void add_suns(const PathContext& context);
    /// Adds the light of the surface that path `k` has met.
    void add_emission(const PathContext& context, std::size_t k);
    /// Adds `light` that path `i` of the wave has met.
    void add(std::size_t i, const Rgb& light, const AovSet::Source& source);

    // What is done `round` after round, for another light sample of paths each time.
    /// Samples a light for each of `paths`.
    void sample(const PathContext& context, const LaneList& paths, std::uint32_t round);
    /// Evaluates the BSDF of path `k`, which is not wide, towards its light sample.
    void evaluate(std::size_t k);
    /// Queues shadow rays from `paths` to the lights that the block has sampled.
    void queue_shadow_rays(const PathContext& context, const LaneList& paths, std::uint32_t round);
    /// Samples all lights of path `k`, which `medium` has scattered at `position`, and queues the shadow rays.
    void queue_shadow_rays_in_medium(const PathContext& context, std::size_t k, const Vec3f& position,
                                     const HomogeneousMedium& medium);

    [[nodiscard]] std::size_t bytes() const;

    ShadowRayQueue shadow_rays{RayKind::Shadow};
    LampsInView lamps;
    SampleLight found;         ///< what the samples have found, by slot, that is, by camera sample
    std::vector<float> alpha;  ///< alpha of the samples, by slot

  private:
    /// Counts for a profile that a direction which path `i` sampled has led to light.
    void count_met_light(const PathContext& context, std::size_t i) const;

    /// Says which lights some paths sample; those paths are known by their places among themselves.
    struct LightChoices {
        std::array<LightTree::Choice, kBlockLanes> choices;
        std::array<const MeshLight*, kBlockLanes> meshes;  ///< null where the light is no even mesh light
        LaneList by_mesh, by_environment, singly;          ///< places, by how the light is sampled
    };

    /// Chooses a light for each of `paths`.
    void choose_lights(const PathContext& context, const LaneList& paths, std::uint32_t round, LightChoices& chosen);
    /// Samples the even mesh lights that are chosen for some of `paths`.
    void sample_meshes(const LaneList& paths, const LightChoices& chosen);
    /// Samples the environment where it is chosen for some of `paths`.
    void sample_environment(const World& world, const LaneList& paths, const LightChoices& chosen);
    /// Returns the weight of what path `i` has met of `light`, infinitely far away, whose samples pick its direction
    /// with this density.
    [[nodiscard]] float weight_from_afar(const PathContext& context, std::size_t i, std::uint32_t light,
                                         float pdf_solid_angle) const;
    /// Returns what a light is chosen for at the surface of path `k`.
    [[nodiscard]] LightReceiver make_receiver(std::size_t k) const;
    // The sample of path `k`, from the lanes or to them.
    void take_from_lanes(std::size_t k);
    void put_into_lanes(std::size_t k);
    void queue_shadow_ray_of_single(const PathContext& context, std::size_t k, std::uint32_t round);
    void queue_shadow_ray_of_lane(const PathContext& context, std::size_t k, std::uint32_t round);
    /// Queues the shadow rays of all paths that are wide, at once, where no words are followed and there are no bodies.
    void queue_shadow_rays_of_lanes(const PathContext& context, std::uint32_t round);
    /// Draws the numbers for the `round`-th light sample of path `k` alone.
    [[nodiscard]] LightNumbers draw_numbers(const PathContext& context, std::size_t k, std::uint32_t round) const;
    /// Holds a shadow ray, but for its time and alpha key.
    struct RayToLight {
        Ray ray;
        float distance = 0.0f;               ///< metres from the vertex to the light
        const Interior* interior = nullptr;  ///< the bodies that it starts in; null for those that the path is in
        std::uint32_t light = 0;
    };
    /// Queues the shadow ray of path `k` with its `contribution`, which media on the way are yet to weaken; `event` is
    /// how the vertex scatters towards the light.
    void queue_shadow_ray(const PathContext& context, std::size_t k, std::uint32_t round, RayToLight to_light,
                          Rgb contribution, const VertexEvent& event);

    WavePaths& paths_;
    PathBlock& block_;
    std::array<LightSample, kBlockLanes> environment_samples_{};  ///< light samples of the environment
    std::array<LightReceiver, kBlockLanes> receivers_;            ///< vertices that lights are chosen for, side by side
    std::vector<ExpressionShare> shares_;                         ///< shares of expressions in the contribution at hand
};

}  // namespace etendue
