#include "bsdf/ggx_albedo.h"

#include "bsdf/ggx_albedo_layout.h"
#include "core/wide.h"

#include <array>

namespace etendue {

namespace {

using namespace ggx_albedo_layout;

// kSingle: Slice; kSchlickShare: ShareSlice; kSingleAverage, kSchlickAverage: Averages;
// kOutside, kInside: [eta] of Slice; kDielectricAverage: [side][eta] of Averages, side 0 outside (eta >= 1).
#include "bsdf/ggx_albedo_tables.inc"

}  // namespace

template <typename T>
BasicGgxAlbedo<T> ggx_albedo(T cos_theta, T alpha) {
    const auto a = place(alpha_coordinate(alpha, kAlphas), kAlphas);
    const T single = interpolate(kSingle, a, place(cosine_coordinate(cos_theta, alpha), kCosines));
    const auto share_a = place(alpha_coordinate(alpha, kShareAlphas), kShareAlphas);
    const T share = interpolate(kSchlickShare, share_a, place(share_cosine_coordinate(cos_theta), kCosines));
    return {single, single * share};
}
template GgxAlbedo ggx_albedo(float, float);
template BasicGgxAlbedo<Wide> ggx_albedo(Wide, Wide);

template <typename T>
BasicGgxAlbedo<T> ggx_albedo_average(T alpha) {
    const auto a = place(alpha_coordinate(alpha, kAverageAlphas), kAverageAlphas);
    return {interpolate(kSingleAverage, a), interpolate(kSchlickAverage, a)};
}
template GgxAlbedo ggx_albedo_average(float);
template BasicGgxAlbedo<Wide> ggx_albedo_average(Wide);

float ggx_dielectric_albedo(float cos_theta, float alpha, float eta) {
    const auto a = place(alpha_coordinate(alpha, kAlphas), kAlphas);
    const auto c = place(cosine_coordinate(cos_theta, alpha), kCosines);
    return eta >= 1.0f
               ? interpolate(kOutside, place(outside_coordinate(eta, cos_theta, alpha), kEtasOutside), a, c)
               : interpolate(kInside, place(inside_coordinate(1.0f / eta, cos_theta, alpha), kEtasInside), a, c);
}

float ggx_dielectric_albedo_average(float alpha, float eta) {
    const auto a = place(alpha_coordinate(alpha, kAverageAlphas), kAverageAlphas);
    const bool outside = eta >= 1.0f;
    const auto e = place(average_eta_coordinate(outside ? eta : 1.0f / eta), kAverageEtas);
    const auto& averages = kDielectricAverage[outside ? 0 : 1];
    const auto low = static_cast<std::size_t>(e.index);
    return mix(interpolate(averages[low], a), interpolate(averages[low + 1], a), e.t);
}

}  // namespace etendue
