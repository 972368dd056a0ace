// Fresnel reflectance: exact for dielectrics, fitted to measured spectra for metals.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace etendue {

/// Reflectance of a smooth dielectric interface for unpolarised light. `cos_i` >= 0 is the cosine of the incident
/// direction, `eta` the index on the transmitted side over the index on the incident side. 1 under total internal
/// reflection. (pbrt, 4th edition, equations 9.5 to 9.7.)
[[nodiscard]] inline float fresnel_dielectric(float cos_i, float eta) {
    const float sin2_t = std::max(0.0f, 1.0f - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1.0f) return 1.0f;
    const float cos_t = std::sqrt(1.0f - sin2_t);
    const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// Mean of `fresnel_dielectric` over a cosine-weighted hemisphere, for eta > 0; 0 at eta = 1. (Duvenhage, Bouatouch and
/// Kourie, "Numerical Verification of Bidirectional Reflectance Distribution Functions for Physical Plausibility",
/// SAICSIT 2013, after Walsh 1926.)
[[nodiscard]] inline float fresnel_dielectric_average(float eta) {
    // What leaves the denser side in diffuse light is what enters it, by reciprocity.
    if (eta < 1.0f) return 1.0f - (1.0f - fresnel_dielectric_average(1.0f / eta)) * eta * eta;
    const auto n = static_cast<double>(eta);
    // Below, the terms cancel to nothing, and the mean is proportional to n - 1.
    constexpr double kCloseToOne = 1.0001;
    if (n < kCloseToOne)
        return static_cast<float>((n - 1.0) / (kCloseToOne - 1.0)) * fresnel_dielectric_average(1.0001f);
    const double n2 = n * n;
    const double n4 = n2 * n2;
    const double sum = n2 + 1.0;
    const double difference = n4 - 1.0;
    const double a = (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0));
    const double b = n2 * (n2 - 1.0) * (n2 - 1.0) / (sum * sum * sum) * std::log((n - 1.0) / (n + 1.0));
    const double c = 2.0 * n2 * n * (n2 + 2.0 * n - 1.0) / (sum * difference);
    const double d = 8.0 * n4 * (n4 + 1.0) / (sum * difference * difference) * std::log(n);
    return static_cast<float>(0.5 + a + b - c + d);
}

/// Direction refracted through the interface with normal `n` (on wo's side, dot(wo, n) > 0); false under total internal
/// reflection. `eta` is the index on the transmitted side over the index on wo's side.
[[nodiscard]] inline bool refract(const Vec3f& wo, const Vec3f& n, float eta, Vec3f& wi) {
    const float cos_o = dot(wo, n);
    const float sin2_t = std::max(0.0f, 1.0f - cos_o * cos_o) / (eta * eta);
    if (sin2_t >= 1.0f) return false;
    wi = n * (cos_o / eta - std::sqrt(1.0f - sin2_t)) - wo * (1.0f / eta);
    return true;
}

// Templates of their lane type, see core/lane.h.

template <typename T>
[[nodiscard]] inline T pow5(T x) {
    const T x2 = x * x;
    return x2 * x2 * x;
}

/// Schlick's approximation with reflectance `f0` at normal and `f90` at grazing incidence.
template <typename T>
[[nodiscard]] inline BasicRgb<T> fresnel_schlick(const BasicRgb<T>& f0, std::type_identity_t<T> cos_i,
                                                 std::type_identity_t<T> f90 = T(1.0f)) {
    return lerp(f0, BasicRgb<T>(f90), pow5(clamp(1.0f - cos_i, T(0.0f), T(1.0f))));
}

/// Returns the mean of `fresnel_schlick` over the hemisphere, weighted by the cosine.
template <typename T>
[[nodiscard]] inline BasicRgb<T> fresnel_schlick_average(const BasicRgb<T>& f0, std::type_identity_t<T> f90 = T(1.0f)) {
    return lerp(f0, BasicRgb<T>(f90), T(1.0f / 21.0f));
}

/// Schlick's curve bent to pass through a measured reflectance near 82 degrees, where metals dip (Kutz, Hasan,
/// Edmondson, "Novel Aspects of the Adobe Standard Material", 2023, section 2.1).
struct FresnelMetal {
    Rgb f0{1.0f};  ///< reflectance at normal incidence
    Rgb dip;       ///< coefficient of mu (1 - mu)^6; zero gives Schlick's curve

    /// `f82` is the reflectance at cos theta = 1/7.
    [[nodiscard]] static FresnelMetal from_f0_f82(const Rgb& f0, const Rgb& f82) {
        constexpr float kMu = 1.0f / 7.0f;
        constexpr float kOneMinus = 1.0f - kMu;
        constexpr float kPeak = kMu * kOneMinus * kOneMinus * kOneMinus * kOneMinus * kOneMinus * kOneMinus;
        return {f0, (fresnel_schlick(f0, kMu) - f82) / kPeak};
    }

    [[nodiscard]] Rgb operator()(float cos_i) const {
        const float one_minus = std::clamp(1.0f - cos_i, 0.0f, 1.0f);
        const float p5 = pow5(one_minus);
        const Rgb f = lerp(f0, Rgb(1.0f), p5) - dip * (cos_i * p5 * one_minus);
        return {std::clamp(f.r, 0.0f, 1.0f), std::clamp(f.g, 0.0f, 1.0f), std::clamp(f.b, 0.0f, 1.0f)};
    }

    /// Mean over a cosine-weighted hemisphere: 2 ∫ F(mu) mu dmu.
    [[nodiscard]] Rgb average() const { return lerp(f0, Rgb(1.0f), 1.0f / 21.0f) - dip * (1.0f / 126.0f); }
};

}  // namespace etendue
