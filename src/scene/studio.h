// The studio: what lights a scene that brings no light. Softboxes around it, and a ground below it that looks as if it
// went on for ever, since the environment below and about the horizon is as bright as the ground is where nothing
// shadows it. All of it is computed; the front of the scene is towards +Z, as in glTF.
#pragma once

#include "core/vec.h"
#include "scene/scene_desc.h"
#include "scene/swept_space.h"

namespace etendue {

/// Radiance of the ground without shadows, and of the environment below and about the horizon.
inline constexpr float kStudioBackdrop = 0.5f;

/// Returns the radiance, equal in all channels, that comes from `direction`, a unit vector. A level surface that looks
/// up receives the irradiance pi.
[[nodiscard]] float studio_radiance(const Vec3f& direction);

/// Makes the studio the environment of `scene`, and puts its ground below the lowest vertex of `swept` if the settings
/// want one; an empty one is that of the scene as it is. Tells `problems` if the chosen camera is below, where a
/// ground would hide the scene and is left out.
void add_studio(SceneDesc& scene, const SweptSpace& swept, ProblemList& problems);

}  // namespace etendue
