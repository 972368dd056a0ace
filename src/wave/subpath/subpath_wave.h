// Subpaths from the eye or from the lights that advance together, one bounce at a time, and leave their vertices
// behind.
#pragma once

#include "core/ray.h"
#include "core/rgb.h"
#include "scene/integrator_settings.h"
#include "transport/dimensions.h"
#include "wave/camera_wave.h"
#include "wave/number_pairs.h"
#include "wave/profile/wave_profile.h"
#include "wave/subpath/diffuse_lanes.h"
#include "wave/subpath/subpath_job.h"
#include "wave/subpath/subpath_vertices.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// Hears what subpaths from the eye meet.
class LightFinder {
  public:
    virtual ~LightFinder() = default;
    /// `arrived` holds the densities with which the subpath arrives at `point`.
    virtual void on_emitter(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction,
                            const SubpathDensities& arrived) = 0;
    virtual void on_unlit(const SubpathState& state, const SurfacePoint& point) = 0;
    virtual void on_escape(const SubpathState& state, const Vec3f& direction) = 0;
    /// Hears that `ray` has hit a surface in whose place the camera sees something else. The subpath ends there, as if
    /// it had met nothing.
    virtual void on_replaced_surface(SubpathState& state, const Ray& ray, const Interior& interior, const Hit& hit) = 0;
    /// Hears what all camera rays have met, before any other call tells of it.
    virtual void on_first_hits(std::span<const Ray> rays, std::span<const Hit> hits) = 0;
    /// True if `on_emitter` is not to be told of what a camera ray has hit first.
    [[nodiscard]] virtual bool finds_emission(const Hit& first_hit) const = 0;
};

/// A subpath whose ray has hit a surface, between the stages of its shading.
struct ShadedSubpath {
    SurfacePoint point;           ///< surface point; for a plain surface its material only
    const Bsdf* plain = nullptr;  ///< see Materials::plain_bsdf: shaded with others at once, in `DiffuseLanes`
    std::size_t lane = 0;         ///< lane of the surface, which plain ones have in `DiffuseLanes`
    SubpathDensities arrived;
    std::optional<Crossing> crossing;
    std::uint32_t vertex = PathVertex::kNoVertex;  ///< place of the vertex that was stored for it
    bool ends_here = false;  ///< it is as long as it may be, and can only go straight through a clear surface
    BsdfSample sample;       ///< unless plain
};

class SubpathWave {
  public:
    /// Makes an empty wave. `makes_diffuse_ends` says whether `SubpathVertices::diffuse_end` will be called.
    SubpathWave(SubpathEnd end, bool makes_diffuse_ends)
        : end_(end), makes_diffuse_ends_(makes_diffuse_ends), vertices_(end, makes_diffuse_ends) {}

    /// Traces the subpath of each sample. After `roulette_depth` rays Russian roulette may end it. Vertices of
    /// former calls are gone. `finder` may be null for lights. Rays are counted in `light`.
    void trace(const SubpathJob& job, int roulette_depth, LightFinder* finder, SampleLight& light,
               RenderCounters& counters);

    [[nodiscard]] std::size_t bytes() const;

    /// Returns where the subpaths from lights began, by slot.
    [[nodiscard]] std::span<const Emission> emissions() const { return emissions_; }
    /// Returns the vertices of all slots, in the order of their bounces.
    [[nodiscard]] SubpathVertices& vertices() { return vertices_; }
    [[nodiscard]] const SubpathVertices& vertices() const { return vertices_; }

  private:
    void begin_at_eye(const SubpathJob& job);
    void begin_at_lights(const SubpathJob& job);
    /// True if rays light several surfaces, of which the subpath takes one.
    [[nodiscard]] bool chooses_surfaces(const World& world) const {
        return end_ == SubpathEnd::AtLight && world.traits().culls_backs;
    }
    void draw_numbers(const SubpathJob& job);
    /// Advances subpaths [first, first + count), count <= kBlockLanes, stage by stage, and moves those that go on to
    /// where `kept` says.
    void advance_block(const SubpathJob& job, LightFinder* finder, std::size_t first, std::size_t count,
                       std::size_t& kept);
    /// Finds out where subpath `i` is; false if it is on no surface: it left the scene, or a medium has scattered it.
    bool set_up(const SubpathJob& job, std::size_t i, ShadedSubpath& path);
    /// Finds and turns the points of the block's subpaths on plain surfaces, with what diffuse ends hold, all at once.
    void set_up_plain();
    /// Computes with which densities the block's subpaths arrive at surfaces.
    void arrive_at_surfaces(const SubpathJob& job, std::size_t first);
    /// Takes subpath `i` through a boundary that another body hides.
    void pass_hidden(std::size_t i, const ShadedSubpath& path);
    /// Stores the vertex of the `k`-th subpath of the block from `first` on, if it may have one more; false if it ends,
    /// or only passes through.
    bool make_vertex(const SubpathJob& job, std::size_t first, std::size_t k);
    /// Gives the lane of the vertex just stored, which is plain, a place for its DiffuseEnd and `end_fewer`; false if
    /// the vertex has no such end.
    bool make_diffuse_end(const SubpathJob& job, const ShadedSubpath& path, const PathVertex& vertex, double merged);
    /// Stores the diffuse ends of the whole block.
    void store_diffuse_ends();
    /// Samples the BSDFs of the first `vertices` in `on_surface_`.
    void sample_bsdfs(std::size_t first, std::size_t vertices);
    bool scatter_in_medium(const SubpathJob& job, std::size_t i);
    /// Takes the subpath straight through a clear surface, where it has no vertex.
    void pass_straight(std::size_t i, const ShadedSubpath& path);
    /// Takes the subpath where the sample of the BSDF at its vertex says; false if it ends.
    bool scatter_at_surface(const SubpathJob& job, std::size_t i, const ShadedSubpath& path);
    bool scatter_at_plain(const SubpathJob& job, std::size_t i, const ShadedSubpath& path);
    /// Takes subpath `i` past a vertex on a surface, at `position`, whose sample has `weight`; false if the sample is
    /// black. Ray and words of the subpath are left to the caller.
    bool scatter(const SubpathJob& job, std::size_t i, const Vec3f& position, const Rgb& weight, bool is_delta);
    [[nodiscard]] SubpathDensities arrive(const SubpathJob& job, std::size_t i, const Vec3f& position, double cosine,
                                          bool in_dense = false) const;
    /// Russian roulette for subpaths [first, first + count). Moves those that go on to where `kept` says, their
    /// throughput divided by their chance.
    void keep_survivors(const SubpathJob& job, std::size_t first, std::size_t count, std::size_t& kept);
    /// Tells the profile, if there is one, of the end of eye subpath `i`.
    void end_path(const SubpathJob& job, std::size_t i, PathEnding ending) const;
    SubpathEnd end_;
    bool makes_diffuse_ends_;
    int bounce_ = 0;
    int roulette_depth_ = 1;
    // By active subpath; those that end are squeezed out after every bounce.
    std::vector<SubpathState> states_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<float> lit_counts_;    ///< LitSurface::count, only of light subpaths where backs are culled
    std::vector<Interior> interiors_;  ///< only if the World has bodies
    SampleKeys keys_;
    NumberPairs scattering_, choices_, medium_;
    // Of the block that advances.
    std::array<ShadedSubpath, kBlockLanes> block_;
    /// Holds places in the block of those on surfaces, then with vertices.
    std::array<std::uint8_t, kBlockLanes> on_surface_{};
    std::size_t surfaces_ = 0;
    DiffuseLanes lanes_;
    std::array<std::uint32_t, kBlockLanes> ends_{};  ///< by lane, the vertex of its DiffuseEnd; kNoVertex if none
    std::array<bool, kBlockLanes> goes_on_{};
    // By slot.
    NumberPairs light_choice_, triangle_, position_,
        direction_;  ///< numbers that choose where subpaths from lights begin
    std::vector<Emission> emissions_;
    SubpathVertices vertices_;
};

}  // namespace etendue
