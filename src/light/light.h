// All lights, and the choice between them.
//
// To add another, see CONTRIBUTING.md (A light).
#pragma once

#include "light/environment_light.h"
#include "light/light_aim.h"
#include "light/light_bounds.h"
#include "light/mesh_light.h"
#include "light/profile_light.h"
#include "light/punctual_light.h"
#include "light/shape_light.h"
#include "light/sun_light.h"
#include "sampling/alias_table.h"

#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace etendue {

using Light = std::variant<PointLight, SpotLight, ProfileLight, DirectionalLight, SunLight, MeshLight, ShapeLight,
                           ConstantEnvironment, ImageEnvironment>;

/// True of the kinds of light that are surfaces of the scene, which rays meet.
template <typename Kind>
inline constexpr bool kIsSurfaceLight = !Kind::is_delta() && !Kind::is_at_infinity();

/// Returns what `use` says of the light if that is a surface, else `otherwise`. A kind that `use` does not take does
/// not compile.
template <typename Result, typename Use>
[[nodiscard]] Result of_surface_light(const Light& light, const Result& otherwise, const Use& use) {
    return std::visit(
        [&]<typename Kind>(const Kind& l) -> Result {
            if constexpr (kIsSurfaceLight<Kind>)
                return use(l);
            else
                return otherwise;
        },
        light);
}

/// Light at `point` from a direction chosen with `u`; of a mesh, `u_triangle` chooses the triangle, of a shape the
/// face. Both in [0, 1)².
[[nodiscard]] LightSample sample_light(const Light& light, const Vec3f& point, Vec2f u_triangle, Vec2f u);
/// Samples light at `point` as `sample_light` does, but of an environment only what
/// `compensated_pdf_solid_angle_from_afar` says: the samples of the BSDF, combined with these by multiple importance
/// sampling, find the rest (light/environment_light.h).
[[nodiscard]] LightSample sample_light_compensated(const Light& light, const Vec3f& point, Vec2f u_triangle, Vec2f u);
/// Samples an environment as `sample_light_compensated` does, as many times at once as there are `samples`.
void sample_environment_compensated(const Light& light, std::span<const Vec2f> u, std::span<LightSample> samples);

/// A ray that leaves the light, for subpaths that begin there. Black where the light emits nothing.
[[nodiscard]] EmissionSample sample_emission(const Light& light, const EmissionNumbers& u, const SceneSphere& scene);

/// Returns the density with which `sample_emission` picks the ray's `direction` once the point of the light is given,
/// 1/sr, or at infinity the place where the ray passes once the direction is given, 1/m² across it. `cos_light`:
/// between the direction and the geometric normal of a mesh light's front.
[[nodiscard]] float emission_pdf(const Light& light, const Vec3f& direction, float cos_light, const SceneSphere& scene);
/// Returns the directions into which a point of the light shines, for a mesh light one on `triangle`; none for lights
/// at infinity.
[[nodiscard]] std::optional<LightCone<float>> light_cone(const Light& light, std::uint32_t triangle);
/// Has `sample`, of a light that is not at infinity, leave along `direction` from where it is: with the radiance, the
/// cosine and the light's own density of that direction.
void turn_emission(const Light& light, EmissionSample& sample, const Vec3f& direction);
/// Returns whether no ray meets the light by chance: it has no extent, or is only ever sampled.
[[nodiscard]] bool is_delta_light(const Light& light);
/// Returns the bytes that the light holds beside itself: triangles, images and tables.
[[nodiscard]] std::size_t light_bytes(const Light& light);
/// Returns whether the light shines from infinitely far away.
[[nodiscard]] bool is_at_infinity(const Light& light);

/// Emitted power in watts, mean of the channels; lights at infinity count what crosses a disk of `scene_radius` metres.
[[nodiscard]] float light_power(const Light& light, float scene_radius);
/// Returns the emitted power in watts as `light_power` does, but of an environment only what is brighter than its mean:
/// what `sample_light_compensated` is for.
[[nodiscard]] float compensated_power(const Light& light, float scene_radius);

/// Returns where the light is and where it shines; none for lights at infinity.
[[nodiscard]] std::optional<LightBounds> light_bounds(const Light& light);
/// Returns where a light is that shines from a point; none for others.
[[nodiscard]] std::optional<Vec3f> light_point(const Light& light);

/// Returns the radiance that a ray along `direction` meets infinitely far away; zero for lights that are no environment
/// and no sun.
[[nodiscard]] Rgb radiance_from_afar(const Light& light, const Vec3f& direction);
/// Returns the density with which `sample_light` picks `direction`, 1/sr; zero for lights that no ray meets infinitely
/// far away.
[[nodiscard]] float pdf_solid_angle_from_afar(const Light& light, const Vec3f& direction);
/// Returns the density with which `sample_light_compensated` picks `direction`, 1/sr; zero for lights that no ray meets
/// infinitely far away.
[[nodiscard]] float compensated_pdf_solid_angle_from_afar(const Light& light, const Vec3f& direction);

/// Fills `seen` with the radiance and the density of `sample_light_compensated` along as many `directions` at once.
void look_at_environment(const Light& light, std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen);

/// Returns the choice of a light by its power, and one time in ten of any: a lamp beside the sun must be found too, and
/// the light of one that is almost never chosen would come as fireflies.
[[nodiscard]] AliasTable choice_by_power(std::span<const Light> lights, float scene_radius);

}  // namespace etendue
