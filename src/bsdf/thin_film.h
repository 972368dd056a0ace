// Reflectance of a surface under a thin transparent film, whose two faces reflect light that interferes: soap, oil,
// anodised metal.
//
// KHR_materials_iridescence: Belcour and Barla, "A Practical Extension to Microfacet Theory for the Modeling of Varying
// Iridescence" (SIGGRAPH 2017), with the extension's simplifications: Schlick's curve at both faces, no polarisation,
// and a base whose index follows from its reflectance at normal incidence.
#pragma once

#include "core/rgb.h"

#include <array>

namespace etendue {

/// Rows of a 3 × 3 matrix from CIE XYZ to the working space.
using XyzToWorking = std::array<Rgb, 3>;

struct ThinFilm {
    float strength = 0.0f;                         ///< share of the surface that is covered, [0, 1]; 0 is no film
    float ior = 1.3f;                              ///< index of the film, >= 1; the medium above it has 1
    float thickness_nm = 0.0f;                     ///< nanometres, >= 0
    const XyzToWorking* xyz_to_working = nullptr;  ///< not null if there is a film

    [[nodiscard]] bool exists() const { return strength > 0.0f; }
    /// Reflectance where there is film, each channel in [0, 1], over a base with reflectance `f0` at normal incidence
    /// without it. `cos_theta` in [0, 1] is that of the incident direction above the film.
    [[nodiscard]] Rgb reflectance(const Rgb& f0, float cos_theta) const;
};

}  // namespace etendue
