#include "bsdf/ggx_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bsdf/ggx_albedo_layout.h"

namespace etendue {

namespace {

using namespace ggx_albedo_layout;

// kSingle, kSchlick: [alpha][cosine]; kDielectric: [side][eta][alpha][cosine], side 0 outside (eta >= 1).
#include "bsdf/ggx_albedo_tables.inc"

struct Lerp {
    int index;
    float t;
};

Lerp position(float coordinate, int nodes) {
    const float clamped = std::clamp(coordinate, 0.0f, static_cast<float>(nodes - 1));
    const int index = std::min(static_cast<int>(clamped), nodes - 2);
    return {index, clamped - static_cast<float>(index)};
}

float mix(float a, float b, float t) { return a + (b - a) * t; }

using Slice = std::array<std::array<float, kCosines>, kAlphas>;

float bilinear(const Slice& table, Lerp a, Lerp c) {
    const auto& low = table[static_cast<std::size_t>(a.index)];
    const auto& high = table[static_cast<std::size_t>(a.index) + 1];
    const auto i = static_cast<std::size_t>(c.index);
    return mix(mix(low[i], low[i + 1], c.t), mix(high[i], high[i + 1], c.t), a.t);
}

/// 2 ∫ table(mu) mu dmu, exactly for the interpolated table: between two nodes it is linear in t with mu = t².
float average_row(const std::array<float, kCosines>& row) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < kCosines; ++i) {
        // ∫ (a + b t) 4 t³ dt over [t0, t1]
        const double t0 = static_cast<double>(i) / (kCosines - 1);
        const double t1 = static_cast<double>(i + 1) / (kCosines - 1);
        const double b = (static_cast<double>(row[i + 1]) - static_cast<double>(row[i])) / (t1 - t0);
        const double a = static_cast<double>(row[i]) - b * t0;
        sum += a * (std::pow(t1, 4) - std::pow(t0, 4)) + b * 0.8 * (std::pow(t1, 5) - std::pow(t0, 5));
    }
    return static_cast<float>(sum);
}

std::array<float, kAlphas> average_slice(const Slice& slice) {
    std::array<float, kAlphas> averages{};
    for (std::size_t i = 0; i < kAlphas; ++i) averages[i] = average_row(slice[i]);
    return averages;
}

float lookup_average(const std::array<float, kAlphas>& averages, Lerp a) {
    const auto i = static_cast<std::size_t>(a.index);
    return mix(averages[i], averages[i + 1], a.t);
}

struct DielectricSlices {
    std::size_t side;
    Lerp eta;
};

DielectricSlices dielectric_slices(float eta) {
    const bool outside = eta >= 1.0f;
    return {outside ? std::size_t{0} : std::size_t{1},
            position(eta_coordinate(outside ? eta : 1.0f / eta), kEtas)};
}

}  // namespace

GgxAlbedo ggx_albedo(float cos_theta, float alpha) {
    const Lerp a = position(alpha_coordinate(alpha), kAlphas);
    const Lerp c = position(cosine_coordinate(cos_theta), kCosines);
    return {bilinear(kSingle, a, c), bilinear(kSchlick, a, c)};
}

GgxAlbedo ggx_albedo_average(float alpha) {
    static const std::array<float, kAlphas> single = average_slice(kSingle);
    static const std::array<float, kAlphas> schlick = average_slice(kSchlick);
    const Lerp a = position(alpha_coordinate(alpha), kAlphas);
    return {lookup_average(single, a), lookup_average(schlick, a)};
}

float ggx_dielectric_albedo(float cos_theta, float alpha, float eta) {
    const Lerp a = position(alpha_coordinate(alpha), kAlphas);
    const Lerp c = position(cosine_coordinate(cos_theta), kCosines);
    const DielectricSlices slices = dielectric_slices(eta);
    const auto i = static_cast<std::size_t>(slices.eta.index);
    const auto& table = kDielectric[slices.side];
    return mix(bilinear(table[i], a, c), bilinear(table[i + 1], a, c), slices.eta.t);
}

float ggx_dielectric_albedo_average(float alpha, float eta) {
    using Averages = std::array<std::array<std::array<float, kAlphas>, kEtas>, 2>;
    static const Averages averages = [] {
        Averages result{};
        for (std::size_t side = 0; side < 2; ++side)
            for (std::size_t i = 0; i < kEtas; ++i) result[side][i] = average_slice(kDielectric[side][i]);
        return result;
    }();
    const Lerp a = position(alpha_coordinate(alpha), kAlphas);
    const DielectricSlices slices = dielectric_slices(eta);
    const auto i = static_cast<std::size_t>(slices.eta.index);
    const auto& side = averages[slices.side];
    return mix(lookup_average(side[i], a), lookup_average(side[i + 1], a), slices.eta.t);
}

}  // namespace etendue
