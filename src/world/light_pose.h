// Tells where moving lights are at a time of the shutter.
//
// `WorldData::lights` knows no time: it stores a moving light as `frame_of` places it. The space with the light in this
// place is the light's frame. A query at a time takes points and directions to the light's frame, and its results back
// to the world. The two spaces differ by a rotation and a translation, which change no density.
#pragma once

#include "core/vec.h"
#include "light/emission_sample.h"
#include "light/light_bounds.h"
#include "light/light_sample.h"
#include "scene/mesh_desc.h"
#include "world/world_data.h"

#include <cstdint>
#include <optional>

namespace etendue {

/// Transforms between the frame of a light and the world at one time.
class LightPose {
  public:
    /// Makes the pose at `time`, in [0, 1], of a light with this `rigid_motion`.
    LightPose(const TransformMotion& motion, float time);

    /// Returns the `point` of the world in the light's frame.
    [[nodiscard]] Vec3f point_in_frame(const Vec3f& point) const { return transform_point(to_frame_, point); }
    /// Returns the unit `direction` of the world in the light's frame.
    [[nodiscard]] Vec3f direction_in_frame(const Vec3f& direction) const {
        return normalize(transform_vector(to_frame_, direction));
    }
    /// Transforms `sample`, light that arrives at a point, from the light's frame to the world.
    void to_world(LightSample& sample) const;
    /// Transforms `sample`, the origin and direction of a ray that leaves the light, from the light's frame to the
    /// world.
    void to_world(EmissionSample& sample) const;

  private:
    Mat4f to_world_;
    Mat4f to_frame_;
};

/// Returns the pose of the light of this index at `time`, in [0, 1]; none if the light stands still.
[[nodiscard]] inline std::optional<LightPose> pose_of_light(const WorldData& data, std::uint32_t light, float time) {
    const TransformMotion* const motion = data.motion_of(light);
    return motion != nullptr ? std::optional<LightPose>(std::in_place, *motion, time) : std::nullopt;
}

/// Returns `point` of the world in the frame of a light with this pose; `point` itself if the light has no pose.
[[nodiscard]] inline Vec3f in_frame(const std::optional<LightPose>& pose, const Vec3f& point) {
    return pose ? pose->point_in_frame(point) : point;
}
/// Returns the unit `direction` of the world in the frame of a light with this pose; itself if the light has no pose.
[[nodiscard]] inline Vec3f direction_in_frame(const std::optional<LightPose>& pose, const Vec3f& direction) {
    return pose ? pose->direction_in_frame(direction) : direction;
}

/// Returns the frame of a light that moves by `motion`, of at least two steps: its position in the middle of the
/// shutter, with the rotation of a step near that time. Between two steps, linear interpolation shrinks a rotation.
[[nodiscard]] Mat4f frame_of(const TransformMotion& motion);

/// Returns for each step of `motion`, which has at least two, the transform from `frame_of(motion)` to the place at
/// that step. Returns none unless all these transforms, and those between the steps, are rigid within 0.2%.
[[nodiscard]] std::optional<TransformMotion> rigid_motion(const TransformMotion& motion);

/// Returns bounds of the places and emission directions that the light of this index has while the shutter is open;
/// none for lights at infinity.
[[nodiscard]] std::optional<LightBounds> swept_bounds(const WorldData& data, std::uint32_t light);

}  // namespace etendue
