#include "light/shape_light.h"

#include "core/frame.h"
#include "core/position_error.h"
#include "core/ray.h"
#include "core/trigonometry.h"
#include "light/surface_departure.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace etendue {

ShapeLight::ShapeLight(const ExactShape& shape, Rgb radiance, Rgb mean_radiance, bool two_sided, bool is_uniform,
                       const Vec3f& position_error, const Beam& beam)
    : shape_(shape),
      radiance_(radiance),
      mean_radiance_(mean_radiance),
      position_error_(position_error),
      beam_(beam),
      two_sided_(two_sided),
      is_uniform_(is_uniform) {
    std::vector<double> areas;
    double total = 0.0;
    for (std::uint32_t face = 0; face < shape_.face_count(); ++face) {
        areas.push_back(shape_.area(face));
        total += areas.back();
    }
    by_area_ = AliasTable(areas);
    area_ = static_cast<float>(total);
    is_stretched_ = shape_.kind() == ShapeKind::Sphere && !shape_.is_round();
    if (is_flat(shape_.kind()) && !two_sided_) cone_ = {shape_.point({}).normal, std::cos(beam_.half_angle())};
}

LightTriangleFront<float> ShapeLight::any_front(float pdf_area) const {
    LightTriangleFront<float> any{};
    any.area = 1.0f / pdf_area;
    any.back = two_sided_ ? 1.0f : 0.0f;
    return any;
}

float ShapeLight::clearance_along(const Vec3f& normal) const {
    return clearance(normal, position_error_);
}

float ShapeLight::Cone::pdf() const {
    return static_cast<float>(0.5 * std::numbers::inv_pi / one_minus_cos);
}

std::optional<ShapeLight::Cone> ShapeLight::cone_from(const Vec3f& point) const {
    if (shape_.kind() != ShapeKind::Sphere) return std::nullopt;
    const Vec3d unit = shape_.to_unit(point);
    const double distance = unit.length();
    // So near the surface, what rounding says of the side is not certain.
    constexpr double kNearest = 1.0 + 1e-5;
    if (!(distance > kNearest)) return std::nullopt;
    const double sine_squared = 1.0 / (distance * distance);
    return Cone{unit * (1.0 / distance), distance, sine_squared / (1.0 + std::sqrt(1.0 - sine_squared))};
}

ShapePlace ShapeLight::sample_cone(const Cone& cone, Vec2f u) {
    // From the angle at the point to that at the centre (Pharr, Jakob and Humphreys, Physically Based Rendering, 4th
    // edition, section 6.2.4).
    const double one_minus_cos = static_cast<double>(u.y) * cone.one_minus_cos;
    const double cosine = 1.0 - one_minus_cos;
    const double sine_squared = one_minus_cos * (2.0 - one_minus_cos);
    const double to_surface =
        std::sqrt(std::max(0.0, 1.0 - sine_squared * cone.distance * cone.distance));  // from the chord's middle
    const double along = std::clamp(sine_squared * cone.distance + cosine * to_surface, -1.0, 1.0);
    const double across = std::sqrt(1.0 - along * along);
    const SinCos turn = sin_cos_turns(u.x);
    const Frame frame = Frame::from_normal(Vec3f(cone.axis));
    return ExactShape::sphere_place(Vec3d(frame.tangent * turn.cos + frame.bitangent * turn.sin) * across +
                                    cone.axis * along);
}

LightSample ShapeLight::sample(const Vec3f& point, Vec2f u_face, Vec2f u) const {
    const std::optional<Cone> cone = cone_from(point);
    const ShapePlace place = cone ? sample_cone(*cone, u) : shape_.sample(by_area_.sample(u_face).index, u);
    const ShapePoint on_light = shape_.point(place);
    const Vec3f to_light = on_light.position - point;
    LightSample sample;
    sample.distance = length(to_light);
    if (!(sample.distance > 0.0f)) return {};
    sample.wi = to_light * (1.0f / sample.distance);
    sample.cos_light = -dot(sample.wi, on_light.normal);
    sample.triangle = triangle_of_place(place);
    sample.barycentric = place.at;
    sample.pdf_solid_angle = pdf_solid_angle(point, on_light.position, sample.cos_light);
    if (!(sample.pdf_solid_angle > 0.0f)) return sample;
    sample.end = offset_origin(on_light.position, on_light.normal, clearance_along(on_light.normal), -sample.wi);
    sample.radiance = radiance_;
    return sample;
}

float ShapeLight::pdf_solid_angle(const Vec3f& point, const Vec3f& on_light, float cos_light) const {
    const float distance = length(on_light - point);
    const std::optional<Cone> cone = cone_from(point);
    if (!cone) return any_front(pdf_area(on_light)).pdf_solid_angle(distance, cos_light);
    if (!(cos_light > 0.0f)) return 0.0f;
    return is_stretched_ ? cone->pdf() * static_cast<float>(shape_.direction_stretch((Vec3d(on_light) - Vec3d(point)) /
                                                                                     static_cast<double>(distance)))
                         : cone->pdf();
}

float ShapeLight::pdf_area(const Vec3f& on_light) const {
    if (!is_stretched_) return 1.0f / area_;
    return static_cast<float>(0.25 * std::numbers::inv_pi / shape_.stretch(shape_.to_unit(on_light).normalized()));
}

float ShapeLight::gain(const Vec3f& on_light, const Vec3f& point) const {
    const std::optional<Cone> cone = cone_from(point);
    if (!cone) return 1.0f;
    const Vec3d normal = shape_.to_unit(on_light);
    const Vec3d to_point = cone->axis * cone->distance - normal;
    const double squared = to_point.length2();
    const double cosine = normal.dot(to_point) / (normal.length() * std::sqrt(squared));
    // Over the area of the unit sphere: both are of the same solid angles.
    constexpr double kArea = 4.0 * std::numbers::pi;
    return static_cast<float>(std::max(0.0, static_cast<double>(cone->pdf()) * cosine / squared * kArea));
}

EmissionSample ShapeLight::sample_emission(const EmissionNumbers& u, const SceneSphere&) const {
    const ShapePlace place = shape_.sample(by_area_.sample(u.triangle).index, u.position);
    const ShapePoint point = shape_.point(place);
    EmissionSample sample;
    leave_surface(point.normal, clearance_along(point.normal), u.direction, two_sided_, beam_, sample);
    sample.position = point.position;
    sample.pdf_position_area = pdf_area(point.position);
    if (sample.pdf_direction_solid_angle > 0.0f) sample.radiance = radiance_;
    sample.triangle = triangle_of_place(place);
    sample.barycentric = place.at;
    return sample;
}

void ShapeLight::turn(EmissionSample& sample, const Vec3f& direction) const {
    const Vec3f normal = shape_.point(shape_place(sample.triangle, sample.barycentric)).normal;
    turn_on_surface(normal, clearance_along(normal), two_sided_, direction, sample);
    sample.pdf_direction_solid_angle = emission_pdf(direction, dot(normal, direction), {});
    sample.radiance = sample.pdf_direction_solid_angle > 0.0f ? radiance_ : Rgb();
}

float ShapeLight::emission_pdf(const Vec3f&, float cos_light, const SceneSphere&) const {
    return any_front(1.0f / area_).emission_pdf_solid_angle(cos_light) * beam_.density_factor(cos_light);
}

float ShapeLight::power(float) const {
    return kPi * area_ * average(mean_radiance_) * beam_.mean_factor() * (two_sided_ ? 2.0f : 1.0f);
}

LightBounds ShapeLight::bounds() const {
    LightBounds bounds;
    bounds.power = static_cast<double>(power(0.0f));
    bounds.box = shape_.bounds();
    bounds.cone = {.axis = shape_.point({}).normal,
                   .theta_o = is_flat(shape_.kind()) ? 0.0 : std::numbers::pi,
                   .theta_e = static_cast<double>(beam_.half_angle()),
                   .two_sided = two_sided_};
    return bounds;
}

}  // namespace etendue
