#include "bsdf/ggx_anisotropic_albedo.h"

#include "bsdf/ggx_anisotropic_albedo_layout.h"

namespace etendue {

namespace {

using namespace ggx_anisotropic_layout;

// kReflection, kSchlickShare: Table<1>; kOutside: Table<kEtasOutside>; kInside: Table<kEtasInside>;
// kReflectionAverage, kSchlickAverage: Averages; kInterfaceAverage: [side][eta] of them, side 0 outside (eta >= 1).
#include "bsdf/ggx_anisotropic_albedo_tables.inc"

}  // namespace

GgxAlbedo ggx_anisotropic_albedo(const Vec3f& w, float alpha_x, float alpha_y) {
    const Position p = position(seen(w, alpha_x, alpha_y), w.z);
    const float single = 1.0f - missing_from_root(interpolate(kReflection, p));
    return {single, single * std::clamp(interpolate(kSchlickShare, p), 0.0f, 1.0f)};
}

GgxAlbedo ggx_anisotropic_albedo_average(float alpha_x, float alpha_y) {
    const Cubic x = average_place(alpha_x);
    const Cubic y = average_place(alpha_y);
    return {1.0f - std::exp(interpolate(kReflectionAverage, x, y)), interpolate(kSchlickAverage, x, y)};
}

float ggx_anisotropic_dielectric_missing(const Vec3f& w, float alpha_x, float alpha_y, float eta) {
    const Seen slopes = seen(w, alpha_x, alpha_y);
    const Position p = position(slopes, w.z);
    return eta >= 1.0f ? missing(kOutside, p, outside_place(eta, w.z, slopes))
                       : missing(kInside, p, inside_place(1.0f / eta, w.z, slopes));
}

float ggx_anisotropic_dielectric_missing_average(float alpha_x, float alpha_y, float eta) {
    const bool outside = eta >= 1.0f;
    const auto& averages = kInterfaceAverage[outside ? 0 : 1];
    const Cubic x = average_place(alpha_x);
    const Cubic y = average_place(alpha_y);
    const Cubic e = average_eta_place(outside ? eta : 1.0f / eta);
    float sum = 0.0f;
    for (std::size_t i = 0; i < 4; ++i) sum += e.weights[i] * interpolate(averages[e.first + i], x, y);
    return std::exp(sum);
}

}  // namespace etendue
