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

namespace {

float interface_albedo(const std::array<Slice, kEtasOutside>& outside, const std::array<Slice, kEtasInside>& inside,
                       float cos_theta, float alpha, float eta) {
    const auto a = place(alpha_coordinate(alpha, kAlphas), kAlphas);
    const auto c = place(cosine_coordinate(cos_theta, alpha), kCosines);
    return eta >= 1.0f ? interpolate(outside, place(outside_coordinate(eta, cos_theta, alpha), kEtasOutside), a, c)
                       : interpolate(inside, place(inside_coordinate(1.0f / eta, cos_theta, alpha), kEtasInside), a, c);
}

float interface_albedo_average(const std::array<std::array<Averages, kAverageEtas>, 2>& sides, float alpha, float eta) {
    const auto a = place(alpha_coordinate(alpha, kAverageAlphas), kAverageAlphas);
    const bool outside = eta >= 1.0f;
    const auto e = place(average_eta_coordinate(outside ? eta : 1.0f / eta), kAverageEtas);
    const auto& averages = sides[outside ? 0 : 1];
    const auto low = static_cast<std::size_t>(e.index);
    return mix(interpolate(averages[low], a), interpolate(averages[low + 1], a), e.t);
}

}  // namespace

float ggx_dielectric_albedo(float cos_theta, float alpha, float eta) {
    return interface_albedo(kTables.outside, kTables.inside, cos_theta, alpha, eta);
}
float ggx_dielectric_albedo_average(float alpha, float eta) {
    return interface_albedo_average(kTables.dielectric_average, alpha, eta);
}

float ggx_total_only_albedo(float cos_theta, float alpha, float eta) {
    return interface_albedo(kTables.total_only_outside, kTables.total_only_inside, cos_theta, alpha, eta);
}
float ggx_total_only_albedo_average(float alpha, float eta) {
    return interface_albedo_average(kTables.total_only_average, alpha, eta);
}

}  // namespace etendue
