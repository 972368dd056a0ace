// What lies between the stages of shading a block of paths.
#pragma once

#include "integrator/path/path_columns.h"
#include "wave/light_front_columns.h"
#include "wave/surface_lanes.h"
#include "world/oriented_surface.h"

#include <cstddef>

namespace etendue {

/// Holds a block of paths between the stages of shading: about 21 KiB, which stay in the first-level cache.
struct BlockLanes : SurfaceLanes {
    Vec3Columns wo;
    RgbColumns albedo;

    // The sample of a light.
    Vec2Columns u_light;  ///< numbers for a point on it
    LightFrontColumns front;
    Column expected_samples;  ///< as in ChosenLight; 0 where `front` is not sampled
    Vec3Columns light_wi, light_end;
    Column light_distance;
    Column light_pdf;        ///< of the sample, choice included, 1/sr; of a delta that of the choice; 0 without light
    Column light_by_chance;  ///< 1 where the BSDF's samples may find the light too, 0 for a delta
    RgbColumns light_radiance;

    // Towards it.
    RgbColumns f_cos;
    Column pdf;
    RgbColumns contribution;
    Column arrives;  ///< 1 where the contribution is not black, else 0
    Vec3Columns shadow_origin, shadow_direction;
    Column shadow_t_max;

    // Where the path goes on.
    Vec2Columns u_bsdf;  ///< numbers for its direction
    Vec3Columns next_origin, next_direction;
    RgbColumns next_weight;
    Column next_pdf;
    Column is_glossy;  ///< 1 where its lobe is one of GlossyLanes, else 0
    Column is_wide;    ///< 1 where the path is scattered by the columns above, else 0
    Column goes_on;    ///< 1 where it does, else 0

    /// Starts a block of whose paths nothing is known yet.
    void start() {
        front.clear();
        forget_light();
        for (std::size_t l = 0; l < kBlockLanes; l += Wide::kWidth) {
            is_glossy.store(l, Wide(0.0f));
            is_wide.store(l, Wide(0.0f));
            goes_on.store(l, Wide(0.0f));
        }
    }
    /// Leaves all paths without a sample of a light.
    void forget_light() {
        for (std::size_t l = 0; l < kBlockLanes; l += Wide::kWidth) {
            expected_samples.store(l, Wide(0.0f));
            light_pdf.store(l, Wide(0.0f));
            light_by_chance.store(l, Wide(1.0f));
        }
    }

    // Each computes lanes [0, count), rounded up, from the columns that the one before and the caller have set.

    /// Samples mesh lights from `position`, the triangles and `u_light`.
    void sample_mesh_lights(std::size_t count);
    /// Computes `f_cos` and `pdf` of diffuse surfaces towards the light, and `next_direction`, `next_weight` and
    /// `next_pdf` from `u_bsdf` if `kSamples`.
    template <bool kSamples>
    void evaluate_diffuse(std::size_t count);
    /// Computes `next_origin` from `next_direction`.
    void set_next_origins(std::size_t count);
    /// Computes `contribution`, whether it `arrives`, and its shadow ray, for the paths from `first` of the wave on.
    void weigh_light(std::size_t count, const PathColumns& paths, std::size_t first);
    /// Takes the paths on for which `is_wide` is 1, unless nothing was scattered.
    void scatter(std::size_t count, PathColumns& paths, std::size_t first);

  private:
    /// Returns the surfaces of lanes from `l` on, turned to `wo`.
    [[nodiscard]] OrientedSurface<Wide> surface(std::size_t l) const {
        return {{tangent.load(l), bitangent.load(l), normal.load(l)}, geometric_normal.load(l), wo.load(l), true};
    }
};

}  // namespace etendue
