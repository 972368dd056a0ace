#include "bsdf/ggx_albedo.h"

#include "bsdf/ggx_albedo_layout.h"

#include <array>

namespace etendue {

namespace {

using namespace ggx_albedo_layout;

// kSingle: Slice; kSchlickShare: ShareSlice; kSingleAverage, kSchlickAverage: Averages;
// kDielectric, kDielectricAverage: [side][eta] of them, side 0 outside (eta >= 1).
#include "bsdf/ggx_albedo_tables.inc"

struct DielectricPlace {
    std::size_t side;
    Place eta;
};

DielectricPlace dielectric_place(float eta) {
    const bool outside = eta >= 1.0f;
    return {outside ? std::size_t{0} : std::size_t{1}, place(eta_coordinate(outside ? eta : 1.0f / eta, kEtas), kEtas)};
}

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
    const DielectricPlace d = dielectric_place(eta);
    const auto& slices = kDielectric[d.side];
    return mix(interpolate(slices[d.eta.index], a, c), interpolate(slices[d.eta.index + 1], a, c), d.eta.t);
}

float ggx_dielectric_albedo_average(float alpha, float eta) {
    const Place a = place(alpha_coordinate(alpha, kAverageAlphas), kAverageAlphas);
    const DielectricPlace d = dielectric_place(eta);
    const auto& averages = kDielectricAverage[d.side];
    return mix(interpolate(averages[d.eta.index], a), interpolate(averages[d.eta.index + 1], a), d.eta.t);
}

}  // namespace etendue
