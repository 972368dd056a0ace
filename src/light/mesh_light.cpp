#include "light/mesh_light.h"

#include "sampling/warp.h"

#include <utility>

namespace etendue {

MeshLight::MeshLight(std::vector<LightTriangle> triangles, Rgb radiance, Rgb mean_radiance, bool two_sided,
                     bool mirrored, bool is_uniform)
    : triangles_(std::move(triangles)),
      radiance_(radiance),
      mean_radiance_(mean_radiance),
      two_sided_(two_sided),
      front_sign_(mirrored ? -1.0f : 1.0f),
      is_uniform_(is_uniform) {
    std::vector<double> areas;
    areas.reserve(triangles_.size());
    double total = 0.0;
    for (const LightTriangle& t : triangles_) {
        areas.push_back(0.5 * static_cast<double>(length(cross(t.edge1, t.edge2))));
        total += areas.back();
    }
    area_ = static_cast<float>(total);
    by_area_ = AliasTable(areas);
}

LightSample MeshLight::sample(const Vec3f& point, Vec2f u) const {
    const AliasTable::Choice choice = by_area_.sample(u.x);
    const LightTriangle& t = triangles_[choice.index];
    const Vec2f b = square_to_triangle({choice.u_remapped, u.y});
    const Vec3f to_light = t.p0 + t.edge1 * b.x + t.edge2 * b.y - point;
    const float squared = length_squared(to_light);
    if (!(squared > 0.0f)) return {};
    LightSample sample;
    sample.distance = std::sqrt(squared);
    sample.wi = to_light * (1.0f / sample.distance);
    const Vec3f normal = normalize(cross(t.edge1, t.edge2)) * front_sign_;
    sample.pdf_solid_angle = pdf_solid_angle(sample.distance, -dot(sample.wi, normal));
    if (sample.pdf_solid_angle > 0.0f) sample.radiance = radiance_;
    sample.triangle = choice.index;
    sample.barycentric = b;
    return sample;
}

float MeshLight::pdf_solid_angle(float distance, float cos_light) const {
    const float cosine = two_sided_ ? std::abs(cos_light) : cos_light;
    return cosine > 0.0f ? distance * distance / (area_ * cosine) : 0.0f;
}

float MeshLight::power(float) const {
    return kPi * area_ * average(mean_radiance_) * (two_sided_ ? 2.0f : 1.0f);
}

}  // namespace etendue
