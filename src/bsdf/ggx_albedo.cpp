#include "bsdf/ggx_albedo.h"

#include "bsdf/albedo_tables.h"
#include "core/wide.h"

#include <array>

namespace etendue {

namespace {

using namespace ggx_albedo_layout;

constexpr const Tables& kTables = etendue_ggx_albedo;

}  // namespace

template <typename T>
BasicGgxAlbedo<T> ggx_albedo(T cos_theta, T alpha) {
    const auto a = place(alpha_coordinate(alpha, kAlphas), kAlphas);
    const T single = interpolate(kTables.single, a, place(cosine_coordinate(cos_theta, alpha), kCosines));
    const auto share_a = place(alpha_coordinate(alpha, kShareAlphas), kShareAlphas);
    const T share = interpolate(kTables.schlick_share, share_a, place(share_cosine_coordinate(cos_theta), kCosines));
    return {single, single * share};
}
template GgxAlbedo ggx_albedo(float, float);
template BasicGgxAlbedo<Wide> ggx_albedo(Wide, Wide);

template <typename T>
BasicGgxAlbedo<T> ggx_albedo_average(T alpha) {
    const auto a = place(alpha_coordinate(alpha, kAverageAlphas), kAverageAlphas);
    return {interpolate(kTables.single_average, a), interpolate(kTables.schlick_average, a)};
}
template GgxAlbedo ggx_albedo_average(float);
template BasicGgxAlbedo<Wide> ggx_albedo_average(Wide);

float ggx_dielectric_albedo(float cos_theta, float alpha, float eta) {
    const auto a = place(alpha_coordinate(alpha, kAlphas), kAlphas);
    const auto c = place(cosine_coordinate(cos_theta, alpha), kCosines);
    return eta >= 1.0f
               ? interpolate(kTables.outside, place(outside_coordinate(eta, cos_theta, alpha), kEtasOutside), a, c)
               : interpolate(kTables.inside, place(inside_coordinate(1.0f / eta, cos_theta, alpha), kEtasInside), a, c);
}

float ggx_dielectric_albedo_average(float alpha, float eta) {
    const auto a = place(alpha_coordinate(alpha, kAverageAlphas), kAverageAlphas);
    const bool outside = eta >= 1.0f;
    const auto e = place(average_eta_coordinate(outside ? eta : 1.0f / eta), kAverageEtas);
    const auto& averages = kTables.dielectric_average[outside ? 0 : 1];
    const auto low = static_cast<std::size_t>(e.index);
    return mix(interpolate(averages[low], a), interpolate(averages[low + 1], a), e.t);
}

}  // namespace etendue
