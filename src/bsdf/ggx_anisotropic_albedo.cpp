#include "bsdf/ggx_anisotropic_albedo.h"

#include "bsdf/albedo_tables.h"

namespace etendue {

namespace {

using namespace ggx_anisotropic_layout;

constexpr const Tables& kTables = etendue_ggx_anisotropic_albedo;

}  // namespace

GgxAlbedo ggx_anisotropic_albedo(const Vec3f& w, float alpha_x, float alpha_y) {
    const Position p = position(seen(w, alpha_x, alpha_y), w.z);
    const float single = 1.0f - missing_from_root(interpolate(kTables.reflection, p));
    return {single, single * std::clamp(interpolate(kTables.schlick_share, p), 0.0f, 1.0f)};
}

GgxAlbedo ggx_anisotropic_albedo_average(float alpha_x, float alpha_y) {
    const Cubic x = average_place(alpha_x);
    const Cubic y = average_place(alpha_y);
    return {1.0f - std::exp(interpolate(kTables.reflection_average, x, y)), interpolate(kTables.schlick_average, x, y)};
}

float ggx_anisotropic_dielectric_missing(const Vec3f& w, float alpha_x, float alpha_y, float eta) {
    const Seen slopes = seen(w, alpha_x, alpha_y);
    const Position p = position(slopes, w.z);
    return eta >= 1.0f ? missing(kTables.outside, p, outside_place(eta, w.z, slopes))
                       : missing(kTables.inside, p, inside_place(1.0f / eta, w.z, slopes));
}

float ggx_anisotropic_dielectric_missing_average(float alpha_x, float alpha_y, float eta) {
    const bool outside = eta >= 1.0f;
    const auto& averages = kTables.interface_average[outside ? 0 : 1];
    const Cubic x = average_place(alpha_x);
    const Cubic y = average_place(alpha_y);
    const Cubic e = average_eta_place(outside ? eta : 1.0f / eta);
    float sum = 0.0f;
    for (std::size_t i = 0; i < 4; ++i) sum += e.weights[i] * interpolate(averages[e.first + i], x, y);
    return std::exp(sum);
}

}  // namespace etendue
