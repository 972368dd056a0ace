// Directional albedo of single scattering on anisotropic GGX surfaces (ggx_albedo.h has the isotropic ones).
//
// The wider of the two alphas is parametrised as KHR_materials_anisotropy does: mix(narrow, 1, strength²). Tables are
// computed while the project is built, by tools/make_ggx_anisotropic_albedo.cpp.
#pragma once

#include "bsdf/ggx_albedo.h"
#include "core/vec.h"

namespace etendue {

/// `w` unit with w.z >= 0; alphas along x and y in [0, 1].
[[nodiscard]] GgxAlbedo ggx_anisotropic_albedo(const Vec3f& w, float alpha_x, float alpha_y);

/// The same averaged over a cosine-weighted hemisphere.
[[nodiscard]] GgxAlbedo ggx_anisotropic_albedo_average(float alpha_x, float alpha_y);

/// Reflected plus transmitted share of a rough dielectric interface, as `ggx_dielectric_albedo`.
[[nodiscard]] float ggx_anisotropic_dielectric_albedo(const Vec3f& w, float alpha_x, float alpha_y, float eta);
[[nodiscard]] float ggx_anisotropic_dielectric_albedo_average(float alpha_x, float alpha_y, float eta);

}  // namespace etendue
