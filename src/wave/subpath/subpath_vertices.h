// The states of subpaths under way, and the vertices that they leave behind.
#pragma once

#include "bsdf/bsdf.h"
#include "transport/dimensions.h"
#include "transport/mis.h"
#include "wave/aov/path_words.h"
#include "wave/subpath/diffuse_end.h"
#include "wave/subpath/path_vertex.h"
#include "world/world.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace etendue {

/// Holds a subpath under way; ray and interior stand in arrays of their own.
struct SubpathState : SubpathProgress {
    WordRange words;
    std::uint32_t slot = 0;
    bool lights_directly = true;  ///< every scattering but the last was a delta
};

/// Holds the bodies on the front and on the back of a vertex; in a medium both are alike.
struct SideInteriors {
    Interior outside, inside;
};

/// Keeps the vertices of a wave of subpaths, in the order of their bounces, with the lobes and words that they point
/// to, and what connections of plain diffuse vertices need.
class SubpathVertices {
  public:
    /// Makes a store without vertices. `makes_diffuse_ends` says whether `diffuse_end` will be called.
    SubpathVertices(SubpathEnd end, bool makes_diffuse_ends) : end_(end), makes_diffuse_ends_(makes_diffuse_ends) {}

    /// Forgets all vertices; those to come have the words of `aovs`, which may be null.
    void reset(const AovSet* aovs);
    /// Marks the words so far as those of vertices: what comes after them is of connections.
    void finish() { words_of_vertices_ = words_.size(); }

    /// Returns all vertices; their surfaces may be missing, see `whole`.
    [[nodiscard]] std::span<const PathVertex> all() const { return vertices_; }
    /// Returns the vertices that can be connected, in the order of `all`.
    [[nodiscard]] std::span<const ConnectibleVertex> connectible() const { return connectible_; }
    /// Returns the vertex at a place in `all` with its surface, which few connections of plain diffuse vertices ask
    /// for.
    [[nodiscard]] const PathVertex& whole(std::uint32_t place);
    [[nodiscard]] const PathVertex& whole(const ConnectibleVertex& vertex) { return whole(vertex.vertex); }
    /// Returns what connections need of `vertex`, if it lies on a plain diffuse surface in vacuum and its light is
    /// still of all wavelengths; otherwise, or where floats do not hold its densities, an end that does not exist.
    [[nodiscard]] const DiffuseEnd& diffuse_end(const ConnectibleVertex& vertex) const {
        return diffuse_ends_[vertex.vertex];
    }
    /// Returns the share of light, [0, 1], that gets past media between the ends of `ray`, `distance` metres apart,
    /// which starts at `vertex`, one of `all`.
    [[nodiscard]] Rgb transmittance(const World& world, const PathVertex& vertex, const Ray& ray, float distance,
                                    RayEnds ends = RayEnds::InScene) const;
    /// Returns the words of the subpaths as they arrive at their vertices.
    [[nodiscard]] PathWords& words() { return words_; }
    /// Returns the words of a subpath that goes on from `vertex` along `w`, for a connection; they last until the next
    /// call.
    [[nodiscard]] WordRange words_after(const PathVertex& vertex, const Vec3f& w);

    /// Stores the next vertex, with what `state` knows of it.
    PathVertex& store(SubpathState& state);
    /// Keeps the bodies on both sides of the vertex just stored, which `transmittance` asks for where there are clear
    /// ones.
    void keep_interiors(const SideInteriors& interiors) { interiors_.push_back(interiors); }
    /// Puts the vertex just stored among those that can be connected. `state` is the subpath's before it scatters.
    void list_connectible(const SubpathState& state, int next_edges, float merged, bool is_in_dense = false);
    /// Puts `vertex` on the surface at `point`, with lobes for the index `relative_ior` as in Materials::bsdf.
    void place(const World& world, const SurfacePoint& point, float relative_ior, PathVertex& vertex);
    /// Returns the vertex at a place in `all`.
    [[nodiscard]] PathVertex& operator[](std::uint32_t place) { return vertices_[place]; }
    /// Returns the diffuse end, to be filled in, of the vertex at a place in `all`.
    [[nodiscard]] DiffuseEnd& diffuse_end_at(std::uint32_t place) { return diffuse_ends_[place]; }
    /// Takes the words of a subpath past a vertex.
    void follow_words(SubpathState& state, const VertexEvent& event) { state.words = scatter(state.words, event); }

    [[nodiscard]] std::size_t bytes() const;

  private:
    /// Returns `words` past a vertex that scatters as `event`.
    [[nodiscard]] WordRange scatter(const WordRange& words, const VertexEvent& event) {
        return end_ == SubpathEnd::AtEye ? words_.scatter_from_eye(words, event)
                                         : words_.scatter_from_light(words, event);
    }

    SubpathEnd end_;
    bool makes_diffuse_ends_;
    std::vector<PathVertex> vertices_;
    std::vector<SideInteriors> interiors_;  ///< of each vertex; empty without clear bodies
    std::vector<ConnectibleVertex> connectible_;
    std::vector<DiffuseEnd> diffuse_ends_;
    PathWords words_;
    std::size_t words_of_vertices_ = 0;  ///< the others are of the last connection
    // Lobes that vertices point to; it only grows, so that they stay where they are.
    std::deque<Bsdf> bsdfs_;
    std::size_t bsdf_count_ = 0;
};

}  // namespace etendue
