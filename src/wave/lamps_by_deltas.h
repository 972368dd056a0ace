// The lamps that a point of the film shows by way of deltas.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "scene/integrator_settings.h"
#include "transport/delta_tree.h"
#include "wave/aov/path_words.h"
#include "wave/tile_job.h"

#include <vector>

namespace etendue {

/// Holds the light of a lamp that a point of the film shows by way of deltas.
struct LampSeen {
    Rgb light;                       ///< W/(m² sr)
    ExpressionMask expressions = 0;  ///< expressions that the light is a part of
    Vec3f first_position{0.0f};      ///< metres, of the surface that the camera ray has met
    float time = 0.0f;               ///< time of the camera ray, [0, 1] while the shutter is open
};

/// Returns where `film`, pixels of the full image of `job`, is on the film of the camera, in [0, 1)² within the image.
[[nodiscard]] inline Vec2f on_film(const TileJob& job, const Vec2f& film) {
    return {film.x / static_cast<float>(job.full_width), film.y / static_cast<float>(job.full_height)};
}

/// Returns the tree of the camera ray `ray`, whose numbers `key` draws; `tracer` may be null.
[[nodiscard]] DeltaBranch branch_along(const World& world, const TileJob& job, const Ray& ray, SampleKey key,
                                       SampleTracer* tracer);
/// Returns the tree of the ray through `film`, pixels of the full image of `job`, whose lens point and time `key`
/// draws; `tracer` may be null.
[[nodiscard]] DeltaBranch branch_through(const World& world, const TileJob& job, const Vec2f& film, SampleKey key,
                                         SampleTracer* tracer);

/// Appends to `seen` the lamps that `branch`, of a camera ray, shows by paths of `lengths` with at least one delta.
void look_for_lamps(const World& world, const DeltaBranch& branch, const PathLengths& lengths, PathWords& words,
                    std::vector<LampSeen>& seen);

}  // namespace etendue
