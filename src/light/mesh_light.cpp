#include "light/mesh_light.h"

#include "core/position_error.h"
#include "light/opposite_triangles.h"
#include "light/surface_departure.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace etendue {

MeshLight::MeshLight(const std::vector<LightTriangle>& triangles, Rgb radiance, Rgb mean_radiance, bool two_sided,
                     bool mirrored, bool is_uniform, const Vec3f& position_error, const Beam& beam)
    : radiance_(radiance), mean_radiance_(mean_radiance), beam_(beam), two_sided_(two_sided), is_uniform_(is_uniform) {
    std::vector<double> areas;
    areas.reserve(triangles.size());
    faces_.reserve(triangles.size());
    double total = 0.0;
    for (const LightTriangle& t : triangles) {
        // In double: squares of small triangles' areas are below what single precision holds.
        const Imath::V3d edge1(t.edge1);
        areas.push_back(0.5 * edge1.cross(Imath::V3d(t.edge2)).length());
        total += areas.back();
        const Vec3f normal = triangle_normal(t.edge1, t.edge2) * (mirrored ? -1.0f : 1.0f);
        Face face{t};
        face.normal = normal;
        face.clearance = clearance(normal, position_error);
        face.opposite = static_cast<std::uint32_t>(faces_.size());
        faces_.push_back(face);
    }
    area_ = static_cast<float>(total);
    by_area_ = AliasTable(areas);
    float most_clearance = 0.0f;
    for (const Face& face : faces_) most_clearance = std::max(most_clearance, face.clearance);
    rectangle_ = LightRectangle::find(triangles, most_clearance);
    if (!two_sided_) pair_opposites(areas);
}

void MeshLight::pair_opposites(std::span<const double> areas) {
    std::vector<Vec3f> normals;
    normals.reserve(faces_.size());
    for (const Face& face : faces_) normals.push_back(face.normal);
    const std::vector<std::uint32_t> opposites = pair_opposite_triangles(normals, areas);
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        const std::uint32_t opposite = opposites[i];
        if (opposite == i) continue;
        has_opposites_ = true;
        faces_[i].opposite = opposite;
        faces_[i].gain = static_cast<float>((areas[i] + areas[opposite]) / areas[i]);
    }
}

void MeshLight::choose_triangles(std::span<const MeshLight* const> lights, std::span<const Vec3f> points,
                                 std::span<const Vec2f> u_triangle, std::span<const Vec2f> u,
                                 std::span<TriangleChoice> choices) {
    const auto for_each = [lights](const auto& step) {
        for (std::size_t i = 0; i < lights.size(); ++i)
            if (lights[i] != nullptr) step(*lights[i], i);
    };
    for_each([&](const MeshLight& light, std::size_t i) { light.by_area_.fetch(u_triangle[i]); });
    for_each([&](const MeshLight& light, std::size_t i) {
        choices[i].triangle = light.by_area_.sample(u_triangle[i]).index;
        __builtin_prefetch(&light.faces_[choices[i].triangle]);
    });
    for_each([&](const MeshLight& light, std::size_t i) {
        __builtin_prefetch(&light.faces_[light.faces_[choices[i].triangle].opposite]);
    });
    for_each([&](const MeshLight& light, std::size_t i) {
        choices[i] = light.choose(choices[i].triangle, points[i], u[i]);
    });
}

MeshLight::TriangleChoice MeshLight::choose_of_rectangle(const SphericalRectangle& seen, const Vec3f& point,
                                                         Vec2f u) const {
    const auto [triangle, b] = rectangle_->place(seen.sample(u));
    const Face& face = faces_[triangle];
    const Vec3f on_light = face.p0 + face.edge1 * b.x + face.edge2 * b.y;
    return {triangle, gain_by_solid_angle(triangle, on_light, point, seen.solid_angle()), triangle_to_square(b)};
}

float MeshLight::gain_of_rectangle(std::uint32_t triangle, const Vec3f& on_light, const Vec3f& point) const {
    const std::optional<SphericalRectangle> seen = rectangle_->seen_from(point);
    return seen ? gain_by_solid_angle(triangle, on_light, point, seen->solid_angle()) : 1.0f;
}

float MeshLight::gain_by_solid_angle(std::uint32_t triangle, const Vec3f& on_light, const Vec3f& point,
                                     double solid_angle) const {
    // Not 0 in the plane of the rectangle, where nothing is seen of it: others divide by it.
    constexpr float kLeastCosine = 1e-12f;
    const Vec3f to_point = point - on_light;
    const float squared = std::max(length_squared(to_point), std::numeric_limits<float>::min());
    // From a vertex and not from `on_light`, which rounding moves off the plane: all have to say the same.
    const Face& face = faces_[triangle];
    const float cosine = std::max(kLeastCosine, std::abs(dot(face.normal, point - face.p0)) / std::sqrt(squared));
    return area_ * cosine / (squared * static_cast<float>(solid_angle));
}

LightSample MeshLight::sample(const Vec3f& point, Vec2f u_triangle, Vec2f u) const {
    const TriangleChoice choice = choose_triangle(point, u_triangle, u);
    const LightTriangleSample<float> on_triangle = front(choice).sample(point, choice.u);
    if (!(on_triangle.distance > 0.0f)) return {};
    LightSample sample;
    sample.distance = on_triangle.distance;
    sample.wi = on_triangle.wi;
    sample.cos_light = on_triangle.cos_light;
    sample.pdf_solid_angle = on_triangle.pdf_solid_angle;
    sample.triangle = choice.triangle;
    sample.barycentric = on_triangle.barycentric;
    if (!(sample.pdf_solid_angle > 0.0f)) return sample;
    sample.end = on_triangle.end;
    sample.radiance = radiance_;
    return sample;
}

EmissionSample MeshLight::sample_emission(const EmissionNumbers& u, const SceneSphere&) const {
    const AliasTable::Choice choice = by_area_.sample(u.triangle);
    const Face& face = faces_[choice.index];
    const Vec2f b = square_to_triangle(u.position);
    EmissionSample sample;
    leave_surface(face.normal, face.clearance, u.direction, two_sided_, beam_, sample);
    sample.position = face.p0 + face.edge1 * b.x + face.edge2 * b.y;
    sample.pdf_position_area = 1.0f / area_;
    if (sample.pdf_direction_solid_angle > 0.0f) sample.radiance = radiance_;
    sample.triangle = choice.index;
    sample.barycentric = b;
    return sample;
}

LightCone<float> MeshLight::cone(std::uint32_t triangle) const {
    return {faces_[triangle].normal, two_sided_ ? -1.0f : std::cos(beam_.half_angle())};
}

void MeshLight::turn(EmissionSample& sample, const Vec3f& direction) const {
    const Face& face = faces_[sample.triangle];
    turn_on_surface(face.normal, face.clearance, two_sided_, direction, sample);
    sample.pdf_direction_solid_angle = emission_pdf(direction, dot(face.normal, direction), {});
    sample.radiance = sample.pdf_direction_solid_angle > 0.0f ? radiance_ : Rgb();
}

float MeshLight::emission_pdf(const Vec3f&, float cos_light, const SceneSphere&) const {
    return any_front().emission_pdf_solid_angle(cos_light) * beam_.density_factor(cos_light);
}

float MeshLight::pdf_solid_angle(std::uint32_t triangle, const Vec3f& point, float distance, float cos_light) const {
    const float by_area = any_front().pdf_solid_angle(distance, cos_light);
    if (!rectangle_) return by_area * gain_of_pair(triangle, point);
    const std::optional<SphericalRectangle> seen = rectangle_->seen_from(point);
    if (!seen || !(by_area > 0.0f)) return by_area;
    return static_cast<float>(1.0 / seen->solid_angle());
}

float MeshLight::power(float) const {
    return kPi * area_ * average(mean_radiance_) * beam_.mean_factor() * (two_sided_ ? 2.0f : 1.0f);
}

LightBounds MeshLight::bounds() const {
    LightBounds bounds;
    bounds.power = static_cast<double>(power(0.0f));
    Vec3d facing(0.0);
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        const Face& t = faces_[i];
        for (const Vec3f& p : {t.p0, t.p0 + t.edge1, t.p0 + t.edge2}) bounds.box.extend(p);
        facing += Vec3d(t.normal) * static_cast<double>(by_area_.probability(i));
    }
    EmissionCone& cone = bounds.cone;
    cone = {.axis = Vec3f(facing.normalized()),
            .theta_e = static_cast<double>(beam_.half_angle()),
            .two_sided = two_sided_};
    if (!(facing.length() > 0.0)) cone.theta_o = std::numbers::pi;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        if (!(by_area_.probability(i) > 0.0f)) continue;
        const auto cosine = static_cast<double>(dot(faces_[i].normal, cone.axis));
        cone.theta_o = std::max(cone.theta_o, std::acos(std::clamp(cosine, -1.0, 1.0)));
    }
    return bounds;
}

}  // namespace etendue
