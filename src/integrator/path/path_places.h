// Where paths are, and by what surfaces scatter them there.
#pragma once

#include "core/columns.h"
#include "integrator/path/path_scattering.h"

#include <array>
#include <cstddef>

namespace etendue {

/// Holds where textured plain surfaces (world/plain_surface.h) are read for a block of paths.
struct TexturedLanes {
    /// Hold the texture coordinates of the triangle's first vertex and of its edges, as in HitCoordinates.
    Vec2Columns uv0, uv_edge1, uv_edge2;
    Column width;  ///< metres, of the path's cone where it hit

    // The point, and what is read around it.
    Vec2Columns uv;
    Vec2Columns along, across;

    void set_hit(std::size_t lane, const HitCoordinates& coordinates, float cone_width) {
        uv0.set(lane, coordinates.uv0);
        uv_edge1.set(lane, coordinates.edge1);
        uv_edge2.set(lane, coordinates.edge2);
        width.set(lane, cone_width);
    }
    /// Computes where textures are read in lanes [0, count), rounded up, of `surfaces`, whose points have been set up.
    void set_up(const BlockLanes& surfaces, std::size_t count);
    [[nodiscard]] TextureFootprint footprint(std::size_t lane) const { return {{along[lane], across[lane]}}; }
};

/// Finds out where a block's paths are, and makes the lobes of surfaces there.
class PathPlaces {
  public:
    /// All arguments have to stay where they are.
    PathPlaces(WavePaths& paths, PathBlock& block, PathLight& light, PathScattering& scattering)
        : paths_(paths), block_(block), light_(light), scattering_(scattering) {}

    /// Finds out where the paths are, and which of them are on surfaces that may scatter them.
    void set_up(const PathContext& context);
    /// Finds the points of the block's paths on plain surfaces, all at once.
    void set_up_plain(const PathContext& context);
    /// Looks up the lobes of textured plain surfaces, all at once.
    void look_up_textures(const PathContext& context);
    /// Makes the lobes of all paths that surfaces may scatter, and lists those that sample lights.
    void make_scattering(const PathContext& context);

    [[nodiscard]] std::size_t bytes() const { return lookups_.bytes(); }

  private:
    /// Sends path `i` of the wave, which has met a surface that the camera does not see, to the background behind the
    /// whole scene.
    void replace_surface(const PathContext& context, std::size_t i);
    /// Finds out where path `k` is, which is on a surface that is not plain; false if the surface ends the path or lets
    /// it pass.
    bool set_up_any(const PathContext& context, std::size_t k);
    /// Has the path of a plain surface that mirrors after all go on as one of any other.
    void set_up_singly(const PathContext& context, std::size_t k);
    /// Makes the lobe of path `k`, which is not on a plain surface, with all its textures.
    void make_scattering_singly(const PathContext& context, std::size_t k);
    /// Makes the Scattering of path `k`, whose lobe is plain, for words to ask.
    void make_wide_scattering(std::size_t k);

    WavePaths& paths_;
    PathBlock& block_;
    PathLight& light_;
    PathScattering& scattering_;
    TexturedLanes textured_;
    std::array<MetallicRoughness, kBlockLanes> textured_lobes_{};
    PlainLookups lookups_;
};

}  // namespace etendue
