// Where a light that moves is at a time of the shutter.
//
// `WorldData::lights` knows no time: it has each light where it is in the middle of the shutter. That is the light's
// frame. What asks about a light at another time asks in this frame, and takes the answer back to the world. From one
// to the other lead turns and shifts, which change no density.
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

/// Leads from the frame of a light to the world at one time, and back.
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
    /// Takes to the world a sample of the light that arrives at `point` of the world.
    void to_world(LightSample& sample, const Vec3f& point) const;
    /// Takes to the world the beginning of a ray that leaves the light.
    void to_world(EmissionSample& sample) const;

  private:
    Mat4f to_world_;
    Mat4f to_frame_;
};

/// Returns the pose of the light of this index at `time`; none if it stands still.
[[nodiscard]] inline std::optional<LightPose> pose_of_light(const WorldData& data, std::uint32_t light, float time) {
    const TransformMotion* const motion = data.motion_of(light);
    return motion != nullptr ? std::optional<LightPose>(std::in_place, *motion, time) : std::nullopt;
}

/// Returns the steps from where something is in the middle of the shutter to where it is at each of the steps of
/// `motion`, at least two. None if these do more than turn and shift, within 0.2%.
[[nodiscard]] std::optional<TransformMotion> rigid_motion(const TransformMotion& motion);

/// Returns where the light of this index is and where it shines while the shutter is open; none at infinity.
[[nodiscard]] std::optional<LightBounds> swept_bounds(const WorldData& data, std::uint32_t light);

}  // namespace etendue
