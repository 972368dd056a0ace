// A wave of paths that advance together, one bounce at a time.
#pragma once

#include "core/ray.h"
#include "core/rgb.h"
#include "integrator/path/block_lanes.h"
#include "integrator/path/glossy_lanes.h"
#include "integrator/path/path_columns.h"
#include "integrator/path/path_integrator.h"
#include "integrator/path/textured_lanes.h"
#include "transport/dimensions.h"
#include "wave/aov/path_words.h"
#include "wave/aov/sample_light.h"
#include "wave/camera_wave.h"
#include "wave/connections.h"
#include "wave/lamps_in_view.h"
#include "wave/lane_list.h"
#include "wave/number_pairs.h"
#include "wave/profile/wave_profile.h"
#include "world/plain_lookups.h"
#include "world/scattering.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

/// Holds what all stages of shading ask of a path whose ray has hit a surface.
struct ShadedPath {
    const PlainSurface* plain = nullptr;        ///< see Materials::plain_surface
    const MetallicRoughness* glossy = nullptr;  ///< lobe of the path, where many are evaluated at once
    std::uint32_t light = kNone;                ///< light that is sampled
    bool is_wide = false;                       ///< scattered by a lobe that is evaluated for many paths at once
};

/// Holds what else paths have that are shaded one by one: some 700 bytes, apart from what stays in the first-level
/// cache.
struct SingleShading {
    SurfacePoint point;  ///< of a plain surface its material only, where words are followed
    std::optional<Crossing> crossing;
    Wavelength wavelength{};  ///< wavelength with which the path goes on, and its weight
    bool chooses_wavelength = false;
    Bsdf storage;
    std::optional<Scattering> scattering;  ///< unless it is_wide; of glossy ones where words are followed
    BsdfValue towards_light;
    BsdfSample sample;
};

/// State that a path keeps when it goes straight through a pane: its last vertex stays the one before.
struct PanePassage {
    LightReceiver from;
    float passed = 0.0f;  ///< metres, behind the pane
};

/// The state of a wave: its paths as columns, and what lies between the stages of a block of them as shorter ones.
/// About 250 bytes a path with its shadow ray, 50 more where lights are chosen by what they light. Where lights are
/// sampled more than once, shadow rays are traced before they are more than a batch and a block's.
class PathWave final : public IntegratorScratch {
  public:
    static constexpr std::size_t kCapacity = PathColumns::kCapacity;
    /// Paths that go from one stage of shading to the next together: what lies between the stages stays in the
    /// first-level cache.
    static constexpr std::size_t kBlock = kBlockLanes;

    PathWave();
    [[nodiscard]] std::size_t bytes() const override;

    /// Returns the estimate of lamps in view, to be started before the job's samples are traced and finished after
    /// them.
    [[nodiscard]] LampsInView& lamps() { return lamps_; }
    /// Traces samples [first, first + count) of the job, count <= kCapacity.
    void trace(const World& world, const TileJob& job, const IntegratorSettings& settings, std::size_t first,
               std::size_t count, TileBuffer& tile, RenderCounters& counters);

  private:
    struct Context {
        const World& world;
        const TileJob& job;
        const IntegratorSettings& settings;
        int depth;  ///< rays that each path has traced; its edges, if the World has no bodies

        /// Returns true if paths sample lights, and do not find them by chance only.
        [[nodiscard]] bool samples_lights() const { return settings.light_samples > 0; }
    };

    /// Draws the random numbers of the block for this bounce, many at a time.
    void draw_numbers(const Context& context);
    /// Draws the random numbers for the `round`-th light sample of the block's paths.
    void draw_light_numbers(const Context& context, std::uint32_t round);
    /// Returns the key from which the numbers of the `round`-th light sample of path `k` come.
    [[nodiscard]] SampleKey light_sample_key(const Context& context, std::size_t k, std::uint32_t round) const;
    /// Returns how many light samples path `i` of the wave has: where it is, if nothing but deltas has scattered it yet
    /// (`kOnlyDelta`), or where its ray comes from, if nothing else had there (`kIsDirect`).
    [[nodiscard]] std::uint32_t light_samples(const Context& context, std::size_t i, std::uint32_t first_vertex) const {
        return paths_.is(first_vertex, i) ? context.settings.light_samples : 1u;
    }
    /// Returns how many light samples at the last vertex of path `i` could have found the light that it meets.
    [[nodiscard]] std::uint32_t samples_of_met_light(const Context& context, std::size_t i) const {
        if (!context.samples_lights() || paths_.is(path_history::kUnsampled, i)) return 0;
        return light_samples(context, i, path_history::kIsDirect);
    }
    /// Shades all paths, block by block, and calls `trace_shadow_rays` whenever there are enough shadow rays for a
    /// batch.
    template <typename TraceShadowRays>
    void shade(const Context& context, const TraceShadowRays& trace_shadow_rays);
    /// Advances paths [first, first + count), count <= kBlock, stage by stage, and moves those that go on to where
    /// `kept` says.
    void shade_block(const Context& context, std::size_t first, std::size_t count, std::size_t& kept);
    // Path `k` of the block is path `first_` + `k` of the wave, and has lane `k` of `lanes_`.
    /// Finds out where the paths are, and which of them are on surfaces that may scatter them.
    void set_up(const Context& context);
    /// Finds out where path `k` is, which is on a surface that is not plain; false if the surface ends the path or lets
    /// it pass.
    bool set_up_any(const Context& context, std::size_t k);
    /// Finds the points of the block's paths on plain surfaces, all at once.
    void set_up_plain(const Context& context);
    /// Looks up the lobes of textured plain surfaces, all at once.
    void look_up_textures(const Context& context);
    /// Has the path of a plain surface that mirrors after all go on as one of any other.
    void set_up_singly(const Context& context, std::size_t k);
    /// Makes the lobes of all paths that surfaces may scatter, and lists those that sample lights.
    void make_scattering(const Context& context);
    /// Makes the lobe of path `k`, which is not on a plain surface, with all its textures.
    void make_scattering_singly(const Context& context, std::size_t k);
    void set_wide(std::size_t k, bool is_wide) {
        block_[k].is_wide = is_wide;
        lanes_.is_wide.set(k, is_wide ? 1.0f : 0.0f);
    }
    /// Makes the Scattering of path `k`, whose lobe is plain, for words to ask.
    void make_wide_scattering(std::size_t k);
    /// Returns what a light is chosen for at the surface of path `k`.
    [[nodiscard]] LightReceiver make_receiver(std::size_t k) const;
    // What is done `round` after round, for another light sample of paths each time.
    /// Samples a light for each of `paths`.
    void sample_lights(const Context& context, const LaneList& paths, std::uint32_t round);
    /// Takes a light sample for each of `paths`, on to its shadow ray. Lanes also sample the BSDF.
    template <typename Stamp>
    void sample_direct_light(const Context& context, const LaneList& paths, std::uint32_t round, const Stamp& stamp);
    /// Takes all light samples of the block.
    template <typename Stamp>
    void sample_direct_light_in_rounds(const Context& context, const Stamp& stamp);
    // The sample of path `k`, from the lanes or to them.
    void take_light_from_lanes(std::size_t k);
    void put_light_into_lanes(std::size_t k);
    /// Evaluates the BSDF of path `k`, which is not wide, towards its light sample.
    void evaluate_light(std::size_t k);
    /// Samples the BSDF of path `k`, which is not wide.
    void sample_bsdf(std::size_t k);
    // Evaluation and sample, of all paths that lanes scatter.
    void evaluate_and_sample_matte();
    void evaluate_and_sample_glossy();
    /// Takes path `k` through the medium that its ray is in; true if it scatters there.
    bool scatter_in_medium(const Context& context, std::size_t k);
    /// Takes path `k` through a boundary that another body hides.
    void pass_hidden(const Context& context, std::size_t k);
    /// Takes path `k` straight through a pane, which is no vertex: light samples pass panes, too.
    void pass_pane(const Context& context, std::size_t k);
    /// Takes path `k` where the sample of its BSDF says; false if it ends.
    bool scatter_at_surface(const Context& context, std::size_t k);
    /// Takes all paths that are wide where the samples of their BSDFs say, at once.
    void scatter_by_lanes(const Context& context);
    /// Returns what scattering towards `wi` by the surface of path `k`, which is wide, may be taken for.
    [[nodiscard]] VertexEvent wide_event(const Context& context, std::size_t k, const Vec3f& wi) const;
    /// Tells the profile, if there is one, how path `k` scattered.
    void count_sample(const Context& context, std::size_t k, const BsdfSample& sample) const;
    /// Bends the cone of path `k`, which has arrived as `arriving`, as `sample` does, before the path's ray is changed.
    void bend_cone(const World& world, std::size_t k, const RayCone& arriving, const Vec3f& geometric_normal,
                   const BsdfSample& sample);
    /// Bends the cones of all paths that are wide.
    void bend_cones(const World& world);
    [[nodiscard]] RayCone arriving_cone(std::size_t k) const { return paths_.cone(first_ + k).at(hits_[first_ + k].t); }
    /// Returns what the lanes have sampled for path `k`, but for its direction.
    [[nodiscard]] BsdfSample sample_of_lane(std::size_t k) const;
    /// Takes the words of path `k` past a vertex that scatters as `event`.
    void follow(std::size_t k, const VertexEvent& event) {
        ranges_[first_ + k] = words_.scatter_from_eye(ranges_[first_ + k], event);
    }
    /// Russian roulette for the paths of the block. Moves those that go on to where `kept` says, their throughput
    /// divided by their chance.
    void keep_survivors(const Context& context, std::size_t& kept);
    /// Tells the profile, if there is one, of the end of path `k`.
    void end_path(const Context& context, std::size_t k, PathEnding ending) const;
    /// Adds the light of the environment to paths of the block that have left the scene.
    void add_environment(const Context& context);
    void add_emission(const Context& context, std::size_t k);
    /// Returns where the ray of path `i` starts, as far as the choice of a light depends on that.
    [[nodiscard]] LightReceiver receiver(std::size_t i) const {
        return receivers_.empty() ? LightReceiver{} : receivers_[i];
    }
    /// Returns the metres from the vertex that path `i` comes from to where its ray starts, behind panes.
    [[nodiscard]] float passed(std::size_t i) const { return passed_.empty() ? 0.0f : passed_[i]; }
    /// Queues shadow rays from `paths` to the lights that the block has sampled.
    void queue_direct_light(const Context& context, const LaneList& paths, std::uint32_t round);
    void queue_singly(const Context& context, std::size_t k, std::uint32_t round);
    void queue_by_lanes(const Context& context, std::size_t k, std::uint32_t round);
    /// Queues the shadow rays of all paths that are wide, at once, where no words are followed and there are no bodies.
    void queue_by_lanes(const Context& context, std::uint32_t round);
    void queue_direct_light_in_medium(const Context& context, std::size_t k, const Vec3f& position,
                                      const HomogeneousMedium& medium);
    /// Returns the numbers from which the light sample of path `k` is made.
    [[nodiscard]] LightNumbers light_numbers(std::size_t k) const {
        return {light_choice_[k], light_triangle_[k], light_direction_[k]};
    }
    /// Draws the numbers for the `round`-th light sample of path `k` alone.
    [[nodiscard]] LightNumbers light_numbers(const Context& context, std::size_t k, std::uint32_t round) const;
    /// Queues `ray` of path `k` towards `light` with its `contribution`; `event` is how the vertex scatters towards
    /// that light.
    void queue(const Context& context, std::size_t k, std::uint32_t round, Ray ray, const Rgb& contribution,
               std::uint32_t light, const VertexEvent& event);
    /// Adds `light` that path `i` of the wave has met.
    void add_light(std::size_t i, const Rgb& light, const AovSet::Source& source);
    [[nodiscard]] std::uint32_t alpha_key(const Context& context, std::size_t k) const;
    /// Returns the alpha key of the shadow ray of the `round`-th light sample of path `k`, unlike those of other rounds
    /// and of the ray that goes on.
    [[nodiscard]] std::uint32_t shadow_alpha_key(const Context& context, std::size_t k, std::uint32_t round) const {
        return etendue::shadow_alpha_key(alpha_key(context, k), round);
    }

    // By active path; paths that end are squeezed out after every bounce.
    std::size_t active_ = 0;
    PathColumns paths_;
    std::vector<Hit> hits_;
    std::vector<Interior> interiors_;       ///< only if the World has bodies
    std::vector<LightReceiver> receivers_;  ///< where rays start; only if the World chooses lights by that
    std::vector<float> passed_;             ///< see `passed`; only if the World has panes
    std::vector<WordRange> ranges_;         ///< words of the paths so far; only if words are followed
    PathWords words_;
    std::vector<ExpressionShare> shares_;  ///< shares of expressions in the contribution at hand
    Connections shadow_rays_{RayKind::Shadow};
    LampsInView lamps_;
    // Of the block that is shaded.
    std::size_t first_ = 0;  ///< the block's first path, in the wave
    std::size_t count_ = 0;  ///< paths in the block
    NumberPairs light_choice_, light_triangle_, light_direction_, bsdf_direction_;
    NumberPairs choices_;  ///< x: which lobe, y: whether the path ends
    NumberPairs medium_;   ///< x: how far, y: by which channel
    std::array<ShadedPath, kBlock> block_{};
    std::vector<SingleShading> singles_;
    std::vector<PanePassage> panes_;                         ///< only if the World has panes
    std::array<ChosenLight, kBlock> lights_{};               ///< light samples outside the lanes, by path
    std::array<LightSample, kBlock> environment_samples_{};  ///< light samples of the environment, side by side
    LaneList escaped_;                                       ///< paths that have left the scene
    LaneList on_emitter_, on_hidden_;                        ///< paths on surfaces that emit, on hidden boundaries
    LaneList on_surface_;                                    ///< paths on surfaces that may scatter them
    LaneList sampling_;                                      ///< paths of `on_surface_` that sample lights
    LaneList on_texture_, on_gloss_;                         ///< paths on textured plain surfaces, in GlossyLanes
    BlockLanes lanes_;
    GlossyLanes glossy_;
    TexturedLanes textured_;
    std::array<MetallicRoughness, kBlock> textured_lobes_{};
    PlainLookups lookups_;
    std::array<LightReceiver, kBlock> to_light_;  ///< what lights are chosen for, side by side
    // By slot, that is, by camera sample.
    std::vector<CameraSample> samples_;
    std::vector<Ray> camera_rays_;
    SampleLight light_;
    std::vector<float> alpha_;
};

}  // namespace etendue
