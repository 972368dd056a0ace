// Reflectance of pure metals from measured optical constants.
//
// Model: a clean, smooth, opaque surface in vacuum. The exact Fresnel reflectance of the complex refractive index
// n + ik, for unpolarised light, is computed at every wavelength and integrated to a colour (bsdf/reflectance_color.h);
// n and k are interpolated linearly between the published wavelengths. Oxide layers and alloys are not modelled.
//
// Sources of n and k, also named beside each table in the source file:
//   Ag, Au, Cu  Johnson and Christy, "Optical Constants of the Noble Metals", Phys. Rev. B 6, 4370, 1972
//   Cr, Fe, Ti  Johnson and Christy, "Optical constants of transition metals", Phys. Rev. B 9, 5056, 1974
//   Al          Rakić, "Algorithm for the determination of intrinsic optical constants of metal films: application to
//               aluminum", Appl. Opt. 34, 4755, 1995
//   W           Lynch and Hunter in Palik (ed.), "Handbook of Optical Constants of Solids", 1985, after Weaver, Olson,
//               Lynch, "Optical properties of crystalline tungsten", Phys. Rev. B 12, 1293, 1975
#pragma once

#include "core/rgb.h"

#include <optional>
#include <span>
#include <string_view>

namespace etendue {

/// Reflectances of a metal in linear Rec.709 under D65-balanced light: what FresnelMetal::from_f0_f82 (bsdf/fresnel.h)
/// takes. Channels lie in [0, 1]: gold at normal incidence, just outside Rec.709 with red 1.04, is clamped.
struct MetalReflectance {
    Rgb f0;   ///< at normal incidence
    Rgb f82;  ///< at cos theta = 1/7, about 82 degrees
};

/// The metal with chemical symbol `symbol`, one of `measured_metal_names()`, or nothing for any other. Computed at each
/// call: meant for preparing a scene, not for use per ray.
[[nodiscard]] std::optional<MetalReflectance> measured_metal(std::string_view symbol);

/// Exact reflectance of the same metal at any angle, `cos_i` in [0, 1] the cosine of incidence; the two reflectances of
/// `measured_metal` are values of it. Linear Rec.709 in [0, 1], or nothing for an unknown symbol.
[[nodiscard]] std::optional<Rgb> measured_metal_reflectance(std::string_view symbol, double cos_i);

/// The known symbols in alphabetical order.
[[nodiscard]] std::span<const std::string_view> measured_metal_names();

}  // namespace etendue
