// Directional albedo of single scattering on GGX surfaces: what is missing to one is the light that scatters several
// times between the microfacets, which the lobes put back (Kulla and Conty, "Revisiting Physically Based Shading at
// Imageworks", SIGGRAPH 2017 course).
//
// Tables are computed while the project is built, by tools/gen/make_ggx_albedo.cpp.
#pragma once

namespace etendue {

/// Holds the albedo of a reflecting GGX surface in two parts: with Schlick's Fresnel term it is f0 · single + (1 - f0)
/// · schlick.
template <typename T>
struct BasicGgxAlbedo {
    T single;   ///< with reflectance 1
    T schlick;  ///< with reflectance (1 - cos)^5
};
using GgxAlbedo = BasicGgxAlbedo<float>;

// Of float and Wide.

/// Returns the albedo for light seen at an angle with `cos_theta` in [0, 1]; `alpha` in [0, 1].
template <typename T>
[[nodiscard]] BasicGgxAlbedo<T> ggx_albedo(T cos_theta, T alpha);

/// Returns the albedo averaged over a cosine-weighted hemisphere; `alpha` in [0, 1].
template <typename T>
[[nodiscard]] BasicGgxAlbedo<T> ggx_albedo_average(T alpha);

/// Largest index of refraction, and inverse of the smallest, that the dielectric tables cover.
inline constexpr float kMaxTabulatedEta = 9.0f;

/// Reflected plus transmitted share of a rough dielectric interface, seen from the side on which the relative index of
/// the other side is `eta` in [1/9, 9].
[[nodiscard]] float ggx_dielectric_albedo(float cos_theta, float alpha, float eta);
[[nodiscard]] float ggx_dielectric_albedo_average(float alpha, float eta);

/// Returns the share of light that leaves a rough interface whose facets reflect only where reflection is total, seen
/// from the side on which the relative index of the other side is `eta` in [1/9, 9].
[[nodiscard]] float ggx_total_only_albedo(float cos_theta, float alpha, float eta);
[[nodiscard]] float ggx_total_only_albedo_average(float alpha, float eta);

}  // namespace etendue
