// The camera, as it moves while the shutter is open.
#pragma once

#include "camera/camera.h"
#include "core/bounds.h"
#include "core/ray.h"
#include "world/hit.h"
#include "world/scene_traits.h"
#include "world/world_data.h"

#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// Makes camera rays, and says how the camera sees points, at any time in [0, 1] in which the shutter is open.
class SceneCamera {
  public:
    /// Gathers what lamps the camera may see; both arguments have to stay where they are.
    SceneCamera(const WorldData& data, const SceneTraits& traits);

    /// Returns the camera as it is in the middle of the shutter.
    [[nodiscard]] const Camera& model() const { return data_.camera; }
    /// Returns the ray of the camera as it is at `time`, through film point `film` and the lens point made from `lens`,
    /// all in [0, 1); the ray has that time.
    [[nodiscard]] Ray generate_ray(Vec2f film, Vec2f lens, float time) const;
    /// Generates a ray for each of many film points, lens points and times, as `generate_ray` does; all spans have one
    /// length.
    void generate_rays(std::span<const Vec2f> film, std::span<const Vec2f> lens, std::span<const float> times,
                       std::span<Ray> rays) const;
    /// Says how the camera as it is at `time` sees `point` through the lens point made from `lens` in [0, 1)².
    [[nodiscard]] CameraConnection connect(const Vec3f& point, Vec2f lens, float time) const;
    /// Returns the distance of `point` from the camera as it is at `time`, metres along its viewing direction.
    [[nodiscard]] float depth(const Vec3f& point, float time) const;
    /// Returns where `point` is seen at `time` through the middle of the lens, in units of the film and at whatever
    /// depth; none behind a perspective camera and where a panoramic one stands.
    [[nodiscard]] std::optional<Vec2f> project(const Vec3f& point, float time) const;
    /// Returns `hit`, which the eye meets along `ray`; in place of one that lies farther than the camera shows, none,
    /// whose `t` is how far the camera shows.
    [[nodiscard]] Hit cut_far(const Ray& ray, const Hit& hit) const;
    /// Returns a box around all places where rays of the camera begin while the shutter is open.
    [[nodiscard]] Bounds bounds_of_origins() const;
    /// Returns false if no camera ray through the part of the film from `least` to `most` can meet a surface that emits
    /// light.
    [[nodiscard]] bool may_show_lamps(Vec2f least, Vec2f most) const;

  private:
    [[nodiscard]] Camera at(float time) const;

    const WorldData& data_;
    const SceneTraits& traits_;
    std::vector<Bounds> lamp_bounds_;  ///< bounds of the surfaces that are lamps; not used if anything moves
};

}  // namespace etendue
