// Directional albedo of single scattering on anisotropic GGX surfaces (ggx_albedo.h has the isotropic ones).
//
// Tables are computed while the project is built, by tools/gen/make_ggx_anisotropic_albedo.cpp.
#pragma once

#include "bsdf/ggx_albedo.h"
#include "core/vec.h"

namespace etendue {

/// Returns the albedo of a GGX surface for light seen along the unit vector `w`, w.z >= 0; alphas along x and y in
/// [kSmoothAlpha, 1].
[[nodiscard]] GgxAlbedo ggx_anisotropic_albedo(const Vec3f& w, float alpha_x, float alpha_y);

/// Returns the albedo averaged over a cosine-weighted hemisphere; alphas in [kSmoothAlpha, 1].
[[nodiscard]] GgxAlbedo ggx_anisotropic_albedo_average(float alpha_x, float alpha_y);

/// One less the reflected plus transmitted share of a rough dielectric interface, seen from the side on which the
/// relative index of the other side is `eta` in [1/9, 9].
[[nodiscard]] float ggx_anisotropic_dielectric_missing(const Vec3f& w, float alpha_x, float alpha_y, float eta);
[[nodiscard]] float ggx_anisotropic_dielectric_missing_average(float alpha_x, float alpha_y, float eta);

}  // namespace etendue
