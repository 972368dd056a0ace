// What light meets where backs are culled.
//
// What the eye sees from behind is not there for it, so light that arrives at the front of a culled surface does two
// things: it is scattered there, for eyes in front, and it goes on, for eyes behind. Along a ray from a light lie all
// the fronts of culled surfaces before the first surface that stops light: one that is not culled, or a culled one that
// the light meets from behind. A light path takes one of these surfaces at random, and carries as much more light as
// there are.
#pragma once

#include "core/ray.h"
#include "world/world.h"

namespace etendue {

/// Names the surface that a light path takes of those that its ray lights.
struct LitSurface {
    Hit hit;             ///< none if the ray lights nothing
    float count = 1.0f;  ///< how many there were to choose from: one over the chance of this one
};

/// Returns a surface that `ray` from a light lights, chosen by its alpha key. Where media scatter light it may be one
/// that absorbs all of it (`is_lit`), since the ray is to be followed to there.
[[nodiscard]] LitSurface find_lit_surface(const World& world, const Ray& ray);

/// Returns true if light that arrives at `hit` (valid) along `direction` may be scattered to where the eye sees it.
[[nodiscard]] bool is_lit(const World& world, const Hit& hit, const Vec3f& direction);

/// Returns the factor of a light path that was to reach a surface chosen from `count` others, and is scattered before
/// it by a medium at `position`, along `ray`: those that lie before are no part of the choice.
[[nodiscard]] float chance_beyond(const World& world, const Ray& ray, const Vec3f& position);

}  // namespace etendue
