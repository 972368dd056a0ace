// Where textured plain surfaces (world/plain_surface.h) are read for a block of paths.
#pragma once

#include "core/columns.h"
#include "integrator/path/block_lanes.h"
#include "world/world.h"

#include <cstddef>

namespace etendue {

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

}  // namespace etendue
