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
#include "wave/subpath/arrival_columns.h"
#include "wave/subpath/matte_lanes.h"
#include "wave/subpath/path_vertex.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// Says which samples one wave of subpaths is traced for, how long paths may be and how strategies are weighed.
struct SubpathJob {
    const World& world;
    const TileJob& job;
    const PathLengths& lengths;
    Raised raised;
    std::span<const CameraSample> samples;
    std::span<const Ray> camera_rays;  ///< rays of the samples, in their order
    Merging merging{};                 ///< where subpaths merge

    /// Returns camera samples per area of the film over light paths, by which the density of the eye's first vertex is
    /// multiplied.
    [[nodiscard]] double samples_per_light_path() const {
        return static_cast<double>(job.full_width) * static_cast<double>(job.full_height) /
               static_cast<double>(job.window.area());
    }
    /// Returns what weights depend on.
    [[nodiscard]] MisContext mis() const { return {world, raised, samples_per_light_path(), merging}; }
    /// Returns the wavelength of the path of the sample in `slot`, if it needs one; both subpaths have the same.
    [[nodiscard]] Wavelength wavelength(std::uint32_t slot) const;
    [[nodiscard]] Rgb wavelength_weight(std::uint32_t slot, bool is_dispersed) const {
        return is_dispersed ? wavelength(slot).weight : Rgb(1.0f);
    }
    /// False if such numbers mean nothing in this World.
    [[nodiscard]] bool needs(SubpathEnd end, SubpathDimension which) const;
    /// Returns the alpha key of rays that connect the vertex of this index; 0 if nothing is transparent.
    [[nodiscard]] std::uint32_t connection_key(SubpathEnd end, int index, std::uint32_t slot) const;
};

/// Holds a subpath under way; ray and interior stand in arrays of their own.
struct SubpathState {
    Rgb throughput{1.0f};
    /// Multiplies the throughput for Russian roulette: eta² over the refractions of radiance, or one over what a light
    /// began with.
    float roulette_scale = 1.0f;
    Vec3f from{0.0f};  ///< the vertex before
    DepartingDensities departing;
    WordRange words;
    std::uint32_t slot = 0;
    std::uint32_t last_vertex = PathVertex::kNoVertex;
    int index = 1;  ///< index of the vertex to come
    int edges = 1;  ///< edges of the path when its ray has hit; media, panes and hidden boundaries add none
    bool is_dispersed = false;
    bool only_delta = true;
    bool lights_directly = true;  ///< every scattering but the last was a delta
    bool is_direct = true;        ///< no boundary that another body hides lies between `from` and where the ray is
};

/// Hears what subpaths from the eye meet.
class LightFinder {
  public:
    virtual ~LightFinder() = default;
    /// `arrived` is for the point as a vertex.
    virtual void on_emitter(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction,
                            const SubpathDensities& arrived) = 0;
    virtual void on_unlit(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction) = 0;
    virtual void on_escape(const SubpathState& state, const Vec3f& direction) = 0;
    /// Hears what all camera rays have met, before any other call tells of it.
    virtual void on_first_hits(std::span<const Ray> rays, std::span<const Hit> hits) = 0;
    /// True if `on_emitter` is not to be told of what a camera ray has hit first.
    [[nodiscard]] virtual bool knows_emission(const Hit& first_hit) const = 0;
};

/// A subpath whose ray has hit a surface, between the stages of its shading.
struct ShadedSubpath {
    SurfacePoint point;           ///< of a plain surface, its material only
    const Bsdf* plain = nullptr;  ///< see Materials::plain_bsdf: shaded with others at once, in `MatteLanes`
    std::size_t lane = 0;         ///< there
    SubpathDensities arrived;
    std::optional<Crossing> crossing;
    std::uint32_t vertex = PathVertex::kNoVertex;  ///< that was stored for it
    bool ends_here = false;  ///< it is as long as it may be, and can only go straight through a pane
    BsdfSample sample;       ///< unless plain
};

class SubpathWave {
  public:
    /// `makes_matte_ends`: whether `matte_end` will be asked.
    SubpathWave(SubpathEnd end, bool makes_matte_ends) : end_(end), makes_matte_ends_(makes_matte_ends) {}

    /// Traces the subpath of each sample. From `roulette_depth` edges on Russian roulette may end it. Vertices of
    /// former calls are gone. `finder` may be null for lights. Rays are counted in `light`.
    void trace(const SubpathJob& job, int roulette_depth, LightFinder* finder, SampleLight& light,
               RenderCounters& counters);

    [[nodiscard]] std::size_t bytes() const;

    /// Returns where the subpaths from lights began, by slot.
    [[nodiscard]] std::span<const Emission> emissions() const { return emissions_; }
    /// Returns the vertices of all slots, in the order of their bounces; their surfaces may be missing, see `whole`.
    [[nodiscard]] std::span<const PathVertex> vertices() const { return vertices_; }
    /// Returns the vertices that can be connected, in the order of `vertices`.
    [[nodiscard]] std::span<const ConnectibleVertex> connectible_vertices() const { return connectible_vertices_; }
    /// Returns one of `vertices` with its surface, which few connections of plain matte vertices ask for.
    [[nodiscard]] const PathVertex& whole(std::uint32_t vertex);
    [[nodiscard]] const PathVertex& whole(const ConnectibleVertex& vertex) { return whole(vertex.vertex); }
    /// Returns what connections need of `vertex`, if it lies on a plain matte surface in vacuum and its light is still
    /// of all wavelengths; otherwise, or where floats do not hold its densities, an end that does not exist.
    [[nodiscard]] const MatteEnd& matte_end(const ConnectibleVertex& vertex) const {
        return matte_ends_[vertex.vertex];
    }
    /// Returns the words of the subpaths as they arrive at their vertices.
    [[nodiscard]] PathWords& words() { return words_; }
    /// Returns the words of a subpath that goes on from `vertex` along `w`, for a connection; they last until the next
    /// call for this wave.
    [[nodiscard]] WordRange words_after(const PathVertex& vertex, const Vec3f& w);

  private:
    void begin_at_eye(const SubpathJob& job);
    void begin_at_lights(const SubpathJob& job);
    void draw_numbers(const SubpathJob& job);
    /// Subpaths that go from one stage of shading to the next together, as in PathWave.
    static constexpr std::size_t kBlock = kBlockLanes;
    /// Advances subpaths [first, first + count), count <= kBlock, stage by stage, and moves those that go on to where
    /// `kept` says.
    void advance_block(const SubpathJob& job, LightFinder* finder, std::size_t first, std::size_t count,
                       std::size_t& kept);
    /// Finds out where subpath `i` is; false if it is on no surface: it left the scene, or a medium has scattered it.
    bool set_up(const SubpathJob& job, std::size_t i, ShadedSubpath& path);
    /// Finds the points of the block's subpaths on plain surfaces, all at once.
    void set_up_plain();
    /// Computes with which densities the block's subpaths arrive at surfaces.
    void arrive_at_surfaces(const SubpathJob& job, std::size_t first);
    /// Tells `finder` what light subpath `i` meets where its ray ends.
    void find_light(LightFinder& finder, std::size_t i, const ShadedSubpath& path) const;
    /// Stores the vertex, if the subpath may have one more; false if it ends, or only passes through.
    bool make_vertex(const SubpathJob& job, std::size_t i, ShadedSubpath& path);
    /// Puts `vertex` where the surface is; unless that is plain, with lobes for the index `relative_ior` as in
    /// Materials::bsdf.
    void place(const World& world, const ShadedSubpath& path, float relative_ior, PathVertex& vertex);
    /// Gives the lane of the vertex just stored, which is plain, a place for its MatteEnd and `end_fewer`; false if the
    /// vertex has no such end.
    bool make_matte_end(const SubpathJob& job, const ShadedSubpath& path, const PathVertex& vertex);
    /// Stores the matte ends of the whole block.
    void store_matte_ends();
    /// Samples the BSDFs of the first `vertices` in `on_surface_`.
    void sample_bsdfs(std::size_t first, std::size_t vertices);
    bool scatter_in_medium(const SubpathJob& job, std::size_t i);
    /// Takes the subpath straight through a pane, where it has no vertex.
    void pass_pane(std::size_t i, const ShadedSubpath& path);
    /// Takes the subpath where the sample of the BSDF at its vertex says; false if it ends.
    bool scatter_at_surface(const SubpathJob& job, std::size_t i, const ShadedSubpath& path);
    bool scatter_at_plain(const SubpathJob& job, std::size_t i, const ShadedSubpath& path);
    /// Takes subpath `i` past a vertex on a surface, at `position`, whose sample has `weight`; false if the sample is
    /// black. Ray and words of the subpath are left to the caller.
    bool scatter(const SubpathJob& job, std::size_t i, const Vec3f& position, const Rgb& weight, bool is_delta);
    [[nodiscard]] SubpathDensities arrive(const SubpathJob& job, std::size_t i, const Vec3f& position,
                                          double cosine) const;
    /// Russian roulette for subpaths [first, first + count). Moves those that go on to where `kept` says, their
    /// throughput divided by their chance.
    void keep_survivors(const SubpathJob& job, std::size_t first, std::size_t count, std::size_t& kept);
    /// Tells the profile, if there is one, of the end of eye subpath `i`.
    void end_path(const SubpathJob& job, std::size_t i, PathEnding ending) const;
    /// Takes the subpath's words past a vertex.
    void follow_words(SubpathState& state, const VertexEvent& event);
    /// Stores the next vertex, with what `state` knows of it.
    PathVertex& store(SubpathState& state);
    /// Puts the vertex just stored among those that can be connected. `state` is the subpath's before it scatters.
    void list_connectible(const SubpathState& state, int next_edges);

    [[nodiscard]] TransportMode mode() const {
        return end_ == SubpathEnd::AtEye ? TransportMode::Radiance : TransportMode::Importance;
    }

    SubpathEnd end_;
    bool makes_matte_ends_;
    int bounce_ = 0;
    int roulette_depth_ = 1;
    // By active subpath; those that end are squeezed out after every bounce.
    std::vector<SubpathState> states_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<Interior> interiors_;  ///< only if the World has bodies
    SampleKeys keys_;
    NumberPairs scattering_, choices_, medium_;
    // Of the block that advances.
    std::array<ShadedSubpath, kBlock> block_;
    std::array<std::uint8_t, kBlock> on_surface_{};  ///< places in the block of those on surfaces, then with vertices
    std::size_t surfaces_ = 0;
    MatteLanes lanes_;
    std::array<std::uint32_t, kBlock> ends_{};  ///< by lane, whose MatteEnd that is; kNoVertex if there is none
    ArrivalColumns arrivals_;
    std::array<bool, kBlock> goes_on_{};
    // By slot.
    NumberPairs light_choice_, triangle_, position_, direction_;  ///< of where subpaths from lights begin
    std::vector<Emission> emissions_;
    std::vector<PathVertex> vertices_;
    std::vector<ConnectibleVertex> connectible_vertices_;
    std::vector<MatteEnd> matte_ends_;
    PathWords words_;
    std::size_t words_of_vertices_ = 0;  ///< the others are of the last connection
    // Lobes that vertices point to; it only grows, so that they stay where they are.
    std::deque<Bsdf> bsdfs_;
    std::size_t bsdf_count_ = 0;
};

}  // namespace etendue
