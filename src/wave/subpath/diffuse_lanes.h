// Scattering of a block of subpaths at plain diffuse surfaces.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "wave/subpath/diffuse_end.h"
#include "wave/surface_lanes.h"
#include "world/oriented_surface.h"

#include <cstddef>
#include <span>

namespace etendue {

/// Holds a block of subpaths on plain diffuse surfaces: about 16 KiB, which stay in the first-level cache.
struct DiffuseLanes : SurfaceLanes {
    Vec3Columns wo;
    RgbColumns albedo;
    RgbColumns throughput;  ///< that arrives

    // The surface as it faces wo: `tangent` and `normal` are turned to it, too.
    Vec3Columns facing_normal;
    Column reverse_pdf;  ///< density of turning back, 1/sr, wherever the walk comes from

    // The following columns become `origin`, `weight` and `fewer` of DiffuseEnd.
    Vec3Columns end_origin;
    RgbColumns end_weight;
    Column end_fewer;  ///< set by the caller

    // Where the subpath goes on.
    Vec3Columns next_origin, next_direction;
    RgbColumns next_weight;
    Column next_pdf;     ///< per solid angle
    Column next_cosine;  ///< to the geometric normal, absolute

    [[nodiscard]] OrientedSurface<float> surface(std::size_t lane) const {
        return {{tangent[lane], bitangent[lane], normal[lane]}, facing_normal[lane], wo[lane], false};
    }

    // Each computes lanes [0, count), rounded up, from the columns that the one before and the caller have set.

    /// Computes what `surface` returns and what ends hold, but `end_fewer`, from the points, `wo`, `albedo` and
    /// `throughput`.
    void orient(std::size_t count, TransportMode mode);
    /// Samples the lobes, from `albedo` and `u`, which now holds numbers for directions.
    void sample(std::size_t count, TransportMode mode);
    /// Writes the end of each lane to where `ends` has its place; null if it has none.
    void store_ends(std::span<DiffuseEnd* const> ends) const;
};

}  // namespace etendue
