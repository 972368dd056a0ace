#include "bsdf/ggx_albedo.h"

#include "bsdf/ggx_albedo_layout.h"

#include <array>

namespace etendue {

namespace {

using namespace ggx_albedo_layout;

// kSingle: Slice; kSchlickShare: ShareSlice; kSingleAverage, kSchlickAverage: Averages;
// kOutside, kInside: [eta] of Slice; kDielectricAverage: [side][eta] of Averages, side 0 outside (eta >= 1).
#include "bsdf/ggx_albedo_tables.inc"

}  // namespace

GgxAlbedo ggx_albedo(float cos_theta, float alpha) {
    const Place a = place(alpha_coordinate(alpha, kAlphas), kAlphas);
    const float single = interpolate(kSingle, a, place(cosine_coordinate(cos_theta, alpha), kCosines));
    const Place share_a = place(alpha_coordinate(alpha, kShareAlphas), kShareAlphas);
    const float share = interpolate(kSchlickShare, share_a, place(share_cosine_coordinate(cos_theta), kCosines));
    return {single, single * share};
}

GgxAlbedo ggx_albedo_average(float alpha) {
    const Place a = place(alpha_coordinate(alpha, kAverageAlphas), kAverageAlphas);
    return {interpolate(kSingleAverage, a), interpolate(kSchlickAverage, a)};
}

float ggx_dielectric_albedo(float cos_theta, float alpha, float eta) {
    const Place a = place(alpha_coordinate(alpha, kAlphas), kAlphas);
    const Place c = place(cosine_coordinate(cos_theta, alpha), kCosines);
    return eta >= 1.0f
               ? interpolate(kOutside, place(outside_coordinate(eta, cos_theta, alpha), kEtasOutside), a, c)
               : interpolate(kInside, place(inside_coordinate(1.0f / eta, cos_theta, alpha), kEtasInside), a, c);
}

float ggx_dielectric_albedo_average(float alpha, float eta) {
    const Place a = place(alpha_coordinate(alpha, kAverageAlphas), kAverageAlphas);
    const bool outside = eta >= 1.0f;
    const Place e = place(average_eta_coordinate(outside ? eta : 1.0f / eta), kAverageEtas);
    const auto& averages = kDielectricAverage[outside ? 0 : 1];
    return mix(interpolate(averages[e.index], a), interpolate(averages[e.index + 1], a), e.t);
}

}  // namespace etendue
