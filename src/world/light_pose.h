// Where a light that moves is at a time of the shutter.
//
// `WorldData::lights` has it where it is in the middle. Points that ask about it are taken to where it then sees them
// from there, and what it answers is taken back: this turns and shifts, and changes no density.
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

/// Takes a light from where it is in the middle of the shutter to where it is at a time, and back.
class LightPose {
  public:
    /// Takes the pose at `time`, in [0, 1], of a light that moves by `motion`.
    LightPose(const TransformMotion& motion, float time);

    /// Returns where `point` is seen from the light as it is in the middle.
    [[nodiscard]] Vec3f point_in(const Vec3f& point) const { return transform_point(in_, point); }
    /// Returns the unit `direction` as the light has it in the middle.
    [[nodiscard]] Vec3f direction_in(const Vec3f& direction) const {
        return normalize(transform_vector(in_, direction));
    }
    /// Takes out `sample`, of light at `point_in(point)`.
    void take_out(LightSample& sample, const Vec3f& point) const;
    /// Takes out the beginning of a ray that leaves the light.
    void take_out(EmissionSample& sample) const;

  private:
    Mat4f out_;
    Mat4f in_;
};

/// Returns the pose of the light of this index at `time`; none if it stands still.
[[nodiscard]] inline std::optional<LightPose> pose_of_light(const WorldData& data, std::uint32_t light, float time) {
    const TransformMotion* const motion = data.motion_of(light);
    return motion != nullptr ? std::optional<LightPose>(std::in_place, *motion, time) : std::nullopt;
}

/// Returns the motion relative to the place in the middle of the shutter of what is at `motion`, with at least two
/// steps; none unless it turns and shifts alone, within 0.2%.
[[nodiscard]] std::optional<TransformMotion> rigid_motion(const TransformMotion& motion);

/// Returns where the light of this index is and where it shines while the shutter is open; none at infinity.
[[nodiscard]] std::optional<LightBounds> swept_bounds(const WorldData& data, std::uint32_t light);

}  // namespace etendue
