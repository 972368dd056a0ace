// An emissive shape: spheres are sampled uniformly within the cone under which the lit point sees them, all else, and
// spheres from inside, uniformly by area. Of ellipsoids, this is so in the space of the unit sphere.
//
// Radiance that varies over the shape is the World's to evaluate, as with mesh lights.
#pragma once

#include "light/beam.h"
#include "light/emission_sample.h"
#include "light/light_aim.h"
#include "light/light_bounds.h"
#include "light/light_sample.h"
#include "light/mesh_light.h"
#include "sampling/alias_table.h"
#include "shape/shape.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace etendue {

class ShapeLight {
  public:
    /// Makes a light of `shape`, in world space, which `can_be` one. The other arguments are those of MeshLight.
    ShapeLight(const ExactShape& shape, Rgb radiance, Rgb mean_radiance, bool two_sided, bool is_uniform,
               const Vec3f& position_error, const Beam& beam = {});

    /// Returns whether `shape` can be sampled: all can but elliptic and slanted cylinders.
    [[nodiscard]] static bool can_be(const ExactShape& shape) {
        return shape.kind() != ShapeKind::Cylinder || shape.is_round();
    }

    /// Samples light at `point`: `u_face` chooses the face, `u` the place on it; both in [0, 1)².
    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u_face, Vec2f u) const;
    /// Returns the density of `sample` for a hit at `on_light`, where `cos_light` is the cosine between the normal of
    /// the front and the direction back to `point`; 0 for the back of a one-sided light.
    [[nodiscard]] float pdf_solid_angle(const Vec3f& point, const Vec3f& on_light, float cos_light) const;
    /// Returns the density per area of the samples for `point` at `on_light` over that of `sample_emission`.
    [[nodiscard]] float gain(const Vec3f& on_light, const Vec3f& point) const;
    /// Returns the density of the places of `sample_emission` at `on_light`, 1/m².
    [[nodiscard]] float pdf_area(const Vec3f& on_light) const;
    /// Samples places by the area of the unit shape, directions by the cosine on each side that emits, within the beam.
    [[nodiscard]] EmissionSample sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const;
    [[nodiscard]] float emission_pdf(const Vec3f& direction, float cos_light, const SceneSphere& scene) const;
    /// Returns the directions into which a flat shape shines; all of them for others, whose normals differ.
    [[nodiscard]] const LightCone<float>& cone(std::uint32_t) const { return cone_; }
    void turn(EmissionSample& sample, const Vec3f& direction) const;
    [[nodiscard]] float power(float scene_radius) const;
    /// Returns bounds as if every point of the shape shone as much as any other.
    [[nodiscard]] LightBounds bounds() const;
    [[nodiscard]] static std::optional<Vec3f> point() { return std::nullopt; }
    [[nodiscard]] static constexpr bool is_delta() { return false; }
    [[nodiscard]] static constexpr bool is_at_infinity() { return false; }
    [[nodiscard]] static constexpr bool is_environment() { return false; }
    [[nodiscard]] std::size_t bytes() const { return by_area_.bytes(); }

    [[nodiscard]] float area() const { return area_; }
    [[nodiscard]] const ExactShape& shape() const { return shape_; }
    /// Returns whether `radiance` of a sample is right as it is; if not, the World must evaluate it at the sampled
    /// point.
    [[nodiscard]] bool is_uniform() const { return is_uniform_; }
    /// Returns whether densities need the very point that samples are for, and not one along a ray up to rounding.
    [[nodiscard]] bool needs_exact_point() const { return shape_.kind() == ShapeKind::Sphere; }

  private:
    /// Holds a sphere as it is seen from a point outside of it, in the space of the unit sphere.
    struct Cone {
        Vec3d axis;            ///< unit, from the centre to the point
        double distance;       ///< from the centre, in radii
        double one_minus_cos;  ///< one minus the cosine of its half angle
        [[nodiscard]] float pdf() const;
    };

    /// Returns nothing where places are chosen by area.
    [[nodiscard]] std::optional<Cone> cone_from(const Vec3f& point) const;
    /// Returns the place that `u` chooses in the cone.
    [[nodiscard]] static ShapePlace sample_cone(const Cone& cone, Vec2f u);
    /// Returns what a place of this density, 1/m², has in common with those of a mesh light.
    [[nodiscard]] LightTriangleFront<float> any_front(float pdf_area) const;
    [[nodiscard]] float clearance_along(const Vec3f& normal) const;

    ExactShape shape_;
    AliasTable by_area_;  ///< the faces
    Rgb radiance_;
    Rgb mean_radiance_;
    Vec3f position_error_;
    Beam beam_;
    LightCone<float> cone_{{0.0f, 1.0f, 0.0f}, -1.0f};
    float area_ = 0.0f;  ///< m²
    bool two_sided_ = false;
    bool is_uniform_ = true;
    bool is_stretched_ = false;  ///< a sphere that is an ellipsoid
};

}  // namespace etendue
