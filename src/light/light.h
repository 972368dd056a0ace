// All lights, and the choice between them.
//
// To add another: a struct with `sample(point, u)` and `power(scene_radius)`, its place in the variant, one case in
// world/compile_lights.cpp, and its row in tests/light.
#pragma once

#include "light/environment_light.h"
#include "light/mesh_light.h"
#include "light/punctual_light.h"
#include "sampling/alias_table.h"

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace etendue {

using Light = std::variant<PointLight, SpotLight, DirectionalLight, MeshLight, ConstantEnvironment, ImageEnvironment>;

/// Light at `point` from a direction chosen with `u` in [0, 1)².
[[nodiscard]] LightSample sample_light(const Light& light, const Vec3f& point, Vec2f u);

/// Emitted power in watts, mean of the channels; lights at infinity count what crosses a disk of `scene_radius` metres.
[[nodiscard]] float light_power(const Light& light, float scene_radius);

/// Radiance from infinity along `-direction`; zero for lights that are no environment.
[[nodiscard]] Rgb environment_radiance(const Light& light, const Vec3f& direction);
/// Density with which `sample_light` picks `direction`; zero for lights that are no environment.
[[nodiscard]] float environment_pdf_solid_angle(const Light& light, const Vec3f& direction);

/// Chooses a light with a probability proportional to its power.
class LightSelector {
  public:
    LightSelector() = default;
    LightSelector(std::span<const Light> lights, float scene_radius);

    [[nodiscard]] bool empty() const { return by_power_.empty(); }
    /// `u` in [0, 1). Must not be empty.
    [[nodiscard]] AliasTable::Choice sample(float u) const { return by_power_.sample(u); }
    [[nodiscard]] float probability(std::size_t light) const { return by_power_.probability(light); }

  private:
    AliasTable by_power_;
};

}  // namespace etendue
