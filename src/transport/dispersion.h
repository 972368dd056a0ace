// Mirrors of dispersive bodies. Where the index of refraction depends on the wavelength, a path of all wavelengths
// draws one to go on with; but all go where a smooth surface mirrors them, each with its own share, and the path need
// not choose.
#pragma once

#include "bsdf/bsdf.h"
#include "world/scattering.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

namespace etendue {

/// Returns true if `sample` of a dispersive surface goes where light of all wavelengths goes, and Fresnel's equations
/// alone say how much of each.
[[nodiscard]] inline bool mirrors_all_wavelengths(const Scattering& scattering, const BsdfSample& sample) {
    const auto* const mirror = std::get_if<SmoothDielectric>(&scattering.bsdf());
    return mirror != nullptr && sample.is_delta && !sample.is_transmission && mirror->fresnel.is_bare();
}

/// Returns the share of light, [0, 1], that a smooth dielectric surface mirrors at a wavelength at which its index
/// inside over that outside is `relative_ior`.
[[nodiscard]] inline float mirrored_share(const Scattering& scattering, float relative_ior) {
    const float cos_o = scattering.wo_local().z;
    const auto& mirror = std::get<SmoothDielectric>(scattering.bsdf());
    return mirror
        .fresnel(std::min(1.0f, std::abs(cos_o)), cos_o > 0.0f ? relative_ior : 1.0f / relative_ior, cos_o > 0.0f)
        .reflection_share;
}

/// Returns the wavelength, with its weight, with which a path goes on along `sample` from a surface at `crossing` where
/// it has, or `chooses`, the wavelength `drawn`: all wavelengths where they are mirrored alike, with the weight that
/// `mean` makes of the share that is mirrored at each.
template <typename Mean>
[[nodiscard]] inline Wavelength wavelength_after(const Scattering& scattering, const std::optional<Crossing>& crossing,
                                                 const BsdfSample& sample, const Wavelength& drawn, bool chooses,
                                                 const Mean& mean) {
    if (!chooses || !mirrors_all_wavelengths(scattering, sample)) return drawn;
    return {.nm = 0.0f,
            .weight = mean([&](float nm) { return mirrored_share(scattering, crossing->relative_ior(nm)); })};
}

}  // namespace etendue
