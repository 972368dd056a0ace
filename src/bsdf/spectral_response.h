// How the three channels of the working space respond to single wavelengths, for light that a prism spreads.
//
// A path that meets a dispersive body becomes one of a single wavelength, drawn with the mean of the three responses as
// its density; its throughput then has the response over the density as a factor, whose mean over all wavelengths is
// exactly one in every channel: white stays white, and images without dispersion are what they were. Responses are the
// CIE's, taken to the working space; where that makes them negative, which are colours out of its gamut, they are zero.
#pragma once

#include "bsdf/thin_film.h"
#include "core/rgb.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace etendue {

/// Holds the wavelength that a path has taken.
struct Wavelength {
    float nm = 0.0f;   ///< nanometres; 0 if the path stands for all of them
    Rgb weight{1.0f};  ///< response over density; each channel at most 3
    float u = 0.0f;    ///< the number that it was drawn by, [0, 1)
};

/// Knows the response of each channel to each wavelength, and draws wavelengths by it.
class SpectralResponse {
  public:
    SpectralResponse() : SpectralResponse(kXyzToLinearRec709) {}
    explicit SpectralResponse(const XyzToWorking& xyz_to_working);

    /// Draws a wavelength by `u` in [0, 1).
    [[nodiscard]] Wavelength sample(float u) const;

    /// Returns the colour of a share that depends on the wavelength, `share(nm)` in [0, 1], from 16 wavelengths: the
    /// one that was drawn, and one in each other sixteenth of the chances, as far into it (Wilkie et al. 2014, Hero
    /// Wavelength Spectral Sampling). Its mean over what is drawn is exact.
    template <typename Share>
    [[nodiscard]] Rgb mean(const Wavelength& drawn, const Share& share) const {
        Rgb color;
        for_strata(drawn, [&](const Wavelength& w) { color += w.weight * share(w.nm); });
        return color / static_cast<float>(kStrata);
    }

    /// Returns the mean colour of `share` at the 16 wavelengths of `mean`, over the chance with which `share` is met by
    /// one of them, whichever was drawn. A path weighs by it that met `share` by the wavelength `drawn` and goes on as
    /// one of all wavelengths.
    template <typename Share>
    [[nodiscard]] Rgb mean_over_chance(const Wavelength& drawn, const Share& share) const {
        Rgb color;
        float chance = 0.0f;
        for_strata(drawn, [&](const Wavelength& w) {
            const float s = share(w.nm);
            color += w.weight * s;
            chance += s;
        });
        return chance > 0.0f ? color / chance : Rgb();
    }

  private:
    static constexpr XyzToWorking kXyzToLinearRec709{{{3.2404542f, -1.5371385f, -0.4985314f},
                                                      {-0.9692660f, 1.8760108f, 0.0415560f},
                                                      {0.0556434f, -0.2040259f, 1.0572252f}}};
    static constexpr int kStrata = 16;
    static constexpr float kFirstNm = 380.0f;
    static constexpr float kStepNm = 2.0f;
    static constexpr std::size_t kSteps = 200;

    template <typename Use>
    void for_strata(const Wavelength& drawn, const Use& use) const {
        const float place = drawn.u * kStrata;
        const float offset = place - std::floor(place);
        for (int i = 0; i < kStrata; ++i) use(sample((static_cast<float>(i) + offset) / kStrata));
    }

    // Of each step of the spectrum, within which response and density are constant.
    std::array<Rgb, kSteps> weight_{};
    std::array<float, kSteps + 1> cumulative_{};
};

/// Returns the index of refraction at a wavelength, by Cauchy's equation from the index at 587.6 nm and 20 over the
/// Abbe number (KHR_materials_dispersion). `nm` = 0 is 587.6.
[[nodiscard]] float dispersed_ior(float ior, float dispersion, float nm);

}  // namespace etendue
