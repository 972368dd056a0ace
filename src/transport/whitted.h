// Whitted's recursive ray tracing ("An Improved Illumination Model for Shaded Display", Communications of the ACM
// 23(6), 1980) for one sample: mirrored and refracted rays are both followed, and surfaces that scatter show direct
// light. Light that surfaces send to each other is left out, glossy reflections and caustics too: the historical
// baseline.
//
// Where the paper shades with Phong's model and point lights, surfaces here scatter with their lobe, and light comes
// from one point of one light, chosen as path tracing does.
#pragma once

#include "scene/integrator_settings.h"
#include "transport/walk.h"

namespace etendue {

/// Returns the light that `sample` finds. Branches end by how little they contribute, whatever `roulette_depth` is.
[[nodiscard]] EyeLight whitted_light(const World& world, const EyeSample& sample, const IntegratorSettings& settings);

}  // namespace etendue
