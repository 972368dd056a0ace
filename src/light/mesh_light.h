// An emissive mesh: triangles chosen by area, points uniform by area.
//
// For a lit point half of a closed lamp would be chosen in vain, as it faces away. So triangles that face opposite ways
// are paired where only their fronts emit, and a sample that falls on one which faces away moves to the other, if that
// faces the point: where only one of two faces it, that one has the chance of both. Two triangles that make a rectangle
// are sampled as one (light/light_rectangle.h). Light subpaths leave all of them by area.
//
// Radiance that varies over the mesh (textures, partial transparency) is the World's to evaluate at the sampled point:
// the same code that evaluates it where a ray hits, so that both strategies of MIS agree.
#pragma once

#include "core/ray.h"
#include "core/vector_bytes.h"
#include "light/beam.h"
#include "light/emission_sample.h"
#include "light/light_aim.h"
#include "light/light_bounds.h"
#include "light/light_rectangle.h"
#include "light/light_sample.h"
#include "light/light_triangle.h"
#include "sampling/alias_table.h"
#include "sampling/warp.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// A point of a triangle of a mesh light as the lit point sees it. A template of its lane type, see core/lane.h.
template <typename T>
struct LightTriangleSample {
    Imath::Vec2<T> barycentric;
    Imath::Vec3<T> wi;  ///< unit, towards the light; not meaningful at a distance of 0
    T distance;         ///< metres
    T cos_light;        ///< between -wi and the normal of the front
    T pdf_solid_angle;  ///< 0 where nothing is emitted towards the point
    Imath::Vec3<T> end;
};

/// A triangle of a mesh light with all that sampling it needs. A template of its lane type, see core/lane.h.
template <typename T>
struct LightTriangleFront {
    Imath::Vec3<T> p0, edge1, edge2;
    Imath::Vec3<T> normal;  ///< unit, of the front
    T clearance;            ///< metres, as in SurfacePoint
    T area;                 ///< one over the density of points on the triangle, m²: if by area, the whole mesh's
    T back;                 ///< share of the front's radiance that the back emits: 1 if two-sided, else 0

    /// d² / (A |cos|), 0 where nothing is emitted. `cos_light` as in the sample.
    [[nodiscard]] T pdf_solid_angle(T distance, T cos_light) const {
        const T cosine = max(cos_light, -cos_light * back);
        return select(cosine > T(0.0f), distance * distance / (area * cosine), T(0.0f));
    }
    /// Returns the directions into which the triangle shines, if its light has no beam.
    [[nodiscard]] LightCone<T> cone() const { return {normal, -back}; }
    /// Returns the density of rays that leave the light from a given point, 1/sr.
    [[nodiscard]] T emission_pdf_solid_angle(T cos_light) const {
        // Of rays from two sides half leave each.
        const T cosine = max(cos_light, -cos_light * back) * (1.0f - 0.5f * back);
        return select(cosine > T(0.0f), cosine * kInvPi, T(0.0f));
    }
    /// `u` in [0, 1)².
    [[nodiscard]] LightTriangleSample<T> sample(const Imath::Vec3<T>& point, const Imath::Vec2<T>& u) const {
        LightTriangleSample<T> s;
        s.barycentric = square_to_triangle(u);
        const Imath::Vec3<T> on_light = p0 + edge1 * s.barycentric.x + edge2 * s.barycentric.y;
        const Imath::Vec3<T> to_light = on_light - point;
        s.distance = length(to_light);
        s.wi = to_light * (1.0f / s.distance);
        s.cos_light = -dot(s.wi, normal);
        s.pdf_solid_angle = pdf_solid_angle(s.distance, s.cos_light);
        s.end = offset_origin(on_light, normal, clearance, -s.wi);
        return s;
    }
};

class MeshLight {
  public:
    /// `radiance` is emitted by every point on the front side (counter-clockwise seen from there); by both if
    /// `two_sided`. `mean_radiance` is its mean over the area, for the choice between lights. Triangles without area
    /// get no samples. `mirrored`: the triangles went through a transform that turned their winding around, so that
    /// their front is where they are clockwise. `position_error`: of points of the mesh, metres per axis; shadow rays
    /// end that far before it. `beam` multiplies the radiance of one-sided lights, which then are not uniform.
    /// 76 bytes a triangle.
    MeshLight(const std::vector<LightTriangle>& triangles, Rgb radiance, Rgb mean_radiance, bool two_sided,
              bool mirrored, bool is_uniform, const Vec3f& position_error, const Beam& beam = {});

    /// Samples light at `point`: `u_triangle` chooses the triangle, `u` the point in it; both in [0, 1)².
    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u_triangle, Vec2f u) const;
    struct TriangleChoice {
        std::uint32_t triangle;
        float gain;  ///< factor of the density at the point, as `gain()` says
        Vec2f u;     ///< numbers for the point on the triangle
    };
    /// Returns the triangle that `sample` chooses for `point` with `u_triangle`, or of a near rectangle with `u`.
    [[nodiscard]] TriangleChoice choose_triangle(const Vec3f& point, Vec2f u_triangle, Vec2f u) const {
        return choose(by_area_.sample(u_triangle).index, point, u);
    }
    /// Chooses a triangle as `choose_triangle` does for each of many lights, with its point and its numbers, of which
    /// there have to be as many; choices of those that are null stay as they are. What a step reads has been fetched in
    /// the one before: tables and triangles of large lights are far apart in memory.
    static void choose_triangles(std::span<const MeshLight* const> lights, std::span<const Vec3f> points,
                                 std::span<const Vec2f> u_triangle, std::span<const Vec2f> u,
                                 std::span<TriangleChoice> choices);
    /// Density of the samples for `point` at `on_light`, on this triangle, over that by area. `point` has to be the
    /// very one, not one moved off its surface: of a triangle in whose plane it lies that may see another side.
    [[nodiscard]] float gain(std::uint32_t triangle, const Vec3f& on_light, const Vec3f& point) const {
        return rectangle_ ? gain_of_rectangle(triangle, on_light, point) : gain_of_pair(triangle, point);
    }
    /// Returns whether densities need the very point that samples are for, and not one along a ray up to rounding.
    [[nodiscard]] bool needs_exact_point() const { return has_opposites_; }
    [[nodiscard]] LightTriangleFront<float> front(const TriangleChoice& choice) const {
        const Face& face = faces_[choice.triangle];
        return {face.p0, face.edge1, face.edge2, face.normal, face.clearance, area_ / choice.gain, back()};
    }
    /// The first five of `front` where they stand, number after number: a row of core/wide_rows.h.
    [[nodiscard]] const float* row(std::uint32_t triangle) const { return &faces_[triangle].p0.x; }
    /// Returns the share of the front's radiance that the back emits: 1 if two-sided, else 0.
    [[nodiscard]] float back() const { return two_sided_ ? 1.0f : 0.0f; }
    /// Returns the radiance of the front, W/(m² sr).
    [[nodiscard]] const Rgb& radiance() const { return radiance_; }
    /// Density of `sample` for a hit of this triangle at `distance` from `point`, where `cos_light` is the cosine
    /// between the geometric normal and the direction back to the point. 0 for the back of a one-sided light.
    [[nodiscard]] float pdf_solid_angle(std::uint32_t triangle, const Vec3f& point, float distance,
                                        float cos_light) const;
    /// Uniform over the area, by the cosine over the directions of each side that emits, within the beam.
    [[nodiscard]] EmissionSample sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const;
    [[nodiscard]] float emission_pdf(const Vec3f& direction, float cos_light, const SceneSphere& scene) const;
    [[nodiscard]] LightCone<float> cone(std::uint32_t triangle) const;
    void turn(EmissionSample& sample, const Vec3f& direction) const;
    [[nodiscard]] float power(float scene_radius) const;
    /// Returns bounds as if every point of the mesh shone as much as any other.
    [[nodiscard]] LightBounds bounds() const;
    [[nodiscard]] static std::optional<Vec3f> point() { return std::nullopt; }
    [[nodiscard]] static constexpr bool is_delta() { return false; }
    [[nodiscard]] static constexpr bool is_at_infinity() { return false; }
    [[nodiscard]] static constexpr bool is_environment() { return false; }

    [[nodiscard]] float area() const { return area_; }
    /// True if `radiance` of a sample is right as it is; false if the World must evaluate it at the sampled point.
    [[nodiscard]] bool is_uniform() const { return is_uniform_; }
    [[nodiscard]] std::size_t triangle_count() const { return faces_.size(); }
    [[nodiscard]] const LightTriangle& triangle(std::size_t index) const { return faces_[index]; }
    [[nodiscard]] std::size_t bytes() const { return vector_bytes(faces_) + by_area_.bytes(); }

  private:
    /// All that is known of a triangle, in one line of the cache.
    struct alignas(64) Face : LightTriangle {
        Vec3f normal{0.0f};          ///< unit
        float clearance = 0.0f;      ///< metres, as in SurfacePoint
        std::uint32_t opposite = 0;  ///< the triangle that faces the other way; itself if it has none
        float gain = 1.0f;           ///< factor of the density where only this one of the two faces a point

        /// Written so that compilers contract nothing: all who ask about a point get the same answer.
        [[nodiscard]] bool is_seen_from(const Vec3f& point) const {
            const Vec3f to_point = point - p0;
            return std::fma(to_point.x, normal.x, std::fma(to_point.y, normal.y, to_point.z * normal.z)) > 0.0f;
        }
    };

    static_assert(sizeof(Face) == 64);

    void pair_opposites(std::span<const double> areas);
    /// Chooses of this triangle and its opposite the one that alone faces the point; else the triangle itself.
    [[nodiscard]] TriangleChoice choose_of_pair(std::uint32_t triangle, const Vec3f& point, Vec2f u) const {
        const std::uint32_t other = faces_[triangle].opposite;
        if (other == triangle) return {triangle, 1.0f, u};
        const bool is_seen = faces_[triangle].is_seen_from(point);
        if (is_seen == faces_[other].is_seen_from(point)) return {triangle, 1.0f, u};
        const std::uint32_t chosen = is_seen ? triangle : other;
        return {chosen, faces_[chosen].gain, u};
    }
    [[nodiscard]] float gain_of_pair(std::uint32_t triangle, const Vec3f& point) const {
        const Face& face = faces_[triangle];
        if (face.opposite == triangle) return 1.0f;
        const bool is_seen = face.is_seen_from(point);
        if (is_seen == faces_[face.opposite].is_seen_from(point)) return 1.0f;
        return is_seen ? face.gain : 0.0f;
    }
    /// Chooses for `point` where the choice by area is `triangle`.
    [[nodiscard]] TriangleChoice choose(std::uint32_t triangle, const Vec3f& point, Vec2f u) const {
        if (rectangle_)
            if (const auto seen = rectangle_->seen_from(point)) return choose_of_rectangle(*seen, point, u);
        return choose_of_pair(triangle, point, u);
    }
    [[nodiscard]] TriangleChoice choose_of_rectangle(const SphericalRectangle& seen, const Vec3f& point, Vec2f u) const;
    [[nodiscard]] float gain_of_rectangle(std::uint32_t triangle, const Vec3f& on_light, const Vec3f& point) const;
    /// Returns the gain where the rectangle is seen under `solid_angle`.
    [[nodiscard]] float gain_by_solid_angle(std::uint32_t triangle, const Vec3f& on_light, const Vec3f& point,
                                            double solid_angle) const;

    /// Returns what the fronts of all triangles have in common: the area and the share of the back.
    [[nodiscard]] LightTriangleFront<float> any_front() const {
        LightTriangleFront<float> any{};
        any.area = area_;
        any.back = back();
        return any;
    }

    std::vector<Face> faces_;
    AliasTable by_area_;
    std::optional<LightRectangle> rectangle_;  ///< if the light is one
    Rgb radiance_;
    Rgb mean_radiance_;
    Beam beam_;
    float area_ = 0.0f;  ///< m²
    bool two_sided_ = false;
    bool is_uniform_ = true;
    bool has_opposites_ = false;
};

}  // namespace etendue
