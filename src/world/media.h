// What fills the space between surfaces.
#pragma once

#include "core/ray.h"
#include "core/ray_cone.h"
#include "medium/homogeneous_medium.h"
#include "world/body.h"
#include "world/hit.h"
#include "world/surface_point.h"
#include "world/world_data.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

class SceneCamera;
class SceneGeometry;

/// Answers which bodies places are in, what media fill these, and how rays cross their boundaries.
class Media {
  public:
    /// Finds the bodies that the camera and the lights are in; all arguments have to stay where they are.
    Media(const WorldData& data, const SceneGeometry& geometry, const SceneCamera& camera);

    /// Returns whether the surface is that of a body.
    [[nodiscard]] bool is_boundary(const SurfacePoint& point) const { return point.material->filling != kNone; }
    /// Returns what a ray from within `current` crosses at a boundary that nothing touches.
    [[nodiscard]] Crossing crossing(const SurfacePoint& point, const Interior& current) const;
    /// Returns what `ray`, which comes from within `current` with `cone` around it, crosses where it has hit a boundary
    /// that others touch. `point` becomes the surface that bounds what fills the space.
    [[nodiscard]] Crossing contact_crossing(SurfacePoint& point, const Interior& current, const Hit& hit,
                                            const Ray& ray, const RayCone& cone) const;
    /// Returns the medium of the body that fills the space within `interior`, null in vacuum and where that body's
    /// medium is empty.
    [[nodiscard]] const HomogeneousMedium* within(const Interior& interior) const {
        return interior.is_empty() ? nullptr : medium_of(interior.filling());
    }
    /// Returns the share of light, [0, 1], that media leave between the ends of `ray`, which starts within `interior`
    /// and passes clear bodies; black where one of these bends it. Does not ask what else is in the way.
    [[nodiscard]] Rgb transmittance(const Interior& interior, const Ray& ray, RayEnds ends) const;
    /// Returns the bodies that `point` is in at `time`, [0, 1], found by a ray through all that lies above it.
    [[nodiscard]] Interior interior_at(const Vec3f& point, float time) const;
    /// Returns the bodies in which `ray` of the camera starts.
    [[nodiscard]] Interior interior_at_camera(const Ray& ray) const {
        return camera_interior_ ? *camera_interior_ : interior_at(ray.origin, ray.time);
    }
    /// Returns the bodies in which all rays of the camera start, or nothing if a boundary may pass between these places
    /// while the shutter is open.
    [[nodiscard]] const std::optional<Interior>& camera_interior() const { return camera_interior_; }
    /// Returns whether some rays of `camera` start in a medium.
    [[nodiscard]] bool has_camera_in_medium(const SceneCamera& camera) const;
    /// Returns the bodies in which all rays start that leave the light of this index, or nothing if these differ, a
    /// boundary moves there or other surfaces lie in the light's plane; there have to be bodies.
    [[nodiscard]] const std::optional<Interior>& light_interior(std::uint32_t light) const {
        return light_interiors_[light];
    }

  private:
    /// Returns what `light_interior` does, found from rays that leave the light in all its parts.
    [[nodiscard]] std::optional<Interior> find_light_interior(std::uint32_t light) const;
    /// Returns the medium of a body, null if it has none.
    [[nodiscard]] const HomogeneousMedium* medium_of(std::uint32_t body) const;

    const WorldData& data_;
    const SceneGeometry& geometry_;
    std::optional<Interior> camera_interior_ = Interior();
    /// Has an element for each light; empty without bodies.
    std::vector<std::optional<Interior>> light_interiors_;
};

}  // namespace etendue
