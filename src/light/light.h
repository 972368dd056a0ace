// All lights, and the choice between them.
//
// To add another, see CONTRIBUTING.md (A light).
#pragma once

#include "light/environment_light.h"
#include "light/light_bounds.h"
#include "light/mesh_light.h"
#include "light/profile_light.h"
#include "light/punctual_light.h"
#include "sampling/alias_table.h"

#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace etendue {

using Light = std::variant<PointLight, SpotLight, ProfileLight, DirectionalLight, MeshLight, ConstantEnvironment,
                           ImageEnvironment>;

/// Light at `point` from a direction chosen with `u`; of a mesh, `u_triangle` chooses the triangle. Both in [0, 1)².
[[nodiscard]] LightSample sample_light(const Light& light, const Vec3f& point, Vec2f u_triangle, Vec2f u);
/// The same, but of an environment only what `compensated_environment_pdf_solid_angle` says: the samples of the BSDF,
/// combined with these by multiple importance sampling, find the rest (light/environment_light.h).
[[nodiscard]] LightSample sample_light_compensated(const Light& light, const Vec3f& point, Vec2f u_triangle, Vec2f u);
/// The same of an environment, as many at once as there are `samples`.
void sample_environment_compensated(const Light& light, std::span<const Vec2f> u, std::span<LightSample> samples);

/// A ray that leaves the light, for subpaths that begin there. Black where the light emits nothing.
[[nodiscard]] EmissionSample sample_emission(const Light& light, const EmissionNumbers& u, const SceneSphere& scene);

/// Of what `sample_emission` samples, once the point of the light is given, or at infinity the direction: the density
/// of the ray's `direction`, 1/sr, or at infinity of the place where it passes, 1/m² across it. `cos_light`: between
/// the direction and the geometric normal of a mesh light's front.
[[nodiscard]] float emission_pdf(const Light& light, const Vec3f& direction, float cos_light, const SceneSphere& scene);
/// True if it has no extent, in space or in direction, so that no ray meets it by chance.
[[nodiscard]] bool is_delta_light(const Light& light);
/// Bytes that it holds beside itself: triangles, images and tables.
[[nodiscard]] std::size_t light_bytes(const Light& light);
/// True if it shines from infinitely far away.
[[nodiscard]] bool is_at_infinity(const Light& light);

/// Emitted power in watts, mean of the channels; lights at infinity count what crosses a disk of `scene_radius` metres.
[[nodiscard]] float light_power(const Light& light, float scene_radius);
/// The same, but of an environment only what is brighter than its mean: what `sample_light_compensated` is for.
[[nodiscard]] float compensated_power(const Light& light, float scene_radius);

/// Where it is and where it shines, unless at infinity.
[[nodiscard]] std::optional<LightBounds> light_bounds(const Light& light);

/// Radiance from infinity along `-direction`; zero for lights that are no environment.
[[nodiscard]] Rgb environment_radiance(const Light& light, const Vec3f& direction);
/// Density with which `sample_light` picks `direction`; zero for lights that are no environment.
[[nodiscard]] float environment_pdf_solid_angle(const Light& light, const Vec3f& direction);
/// The same of `sample_light_compensated`.
[[nodiscard]] float compensated_environment_pdf_solid_angle(const Light& light, const Vec3f& direction);

/// Both along as many `directions` at once.
void look_at_environment(const Light& light, std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen);

/// Chooses a light by its power, and one time in ten any: a lamp beside the sun must be found too, and the light of one
/// that is almost never chosen would come as fireflies.
class LightSelector {
  public:
    LightSelector() = default;
    LightSelector(std::span<const Light> lights, float scene_radius);

    /// `u` in [0, 1)². Must not be empty.
    [[nodiscard]] AliasTable::Choice sample(Vec2f u) const { return table_.sample(u); }
    [[nodiscard]] float probability(std::size_t light) const { return table_.probability(light); }
    [[nodiscard]] bool empty() const { return table_.empty(); }
    [[nodiscard]] std::size_t size() const { return table_.size(); }
    [[nodiscard]] std::size_t bytes() const { return table_.bytes(); }

  private:
    AliasTable table_;
};

}  // namespace etendue
