// Colour of a spectral reflectance: how measured spectra become the RGB reflectances that the lobes work with.
#pragma once

#include "core/rgb.h"

#include <functional>

namespace etendue {

/// Linear Rec.709 colour under CIE illuminant D65 of a surface that reflects `reflectance(nanometres)`, in [0, 1], at
/// wavelengths from 380 to 780 nm (called every 5 nm). Reflectance 1 everywhere gives exactly (1, 1, 1). Saturated
/// spectra lie outside the Rec.709 triangle and give channels below 0 or above 1.
///
/// CIE 1931 2° colour matching functions by the multi-lobe fit of Wyman, Sloan, Shirley, "Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013; D65 as tabulated by the CIE. Meant for
/// preparing a scene, not for use per ray.
[[nodiscard]] Rgb reflectance_color(const std::function<double(double nanometres)>& reflectance);

}  // namespace etendue
