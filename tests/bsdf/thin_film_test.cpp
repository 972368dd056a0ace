#include "bsdf/thin_film.h"

#include "bsdf/color_matching.h"
#include "bsdf/fresnel.h"

#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr XyzToWorking kToRec709{{{3.2404542f, -1.5371385f, -0.4985314f},
                                  {-0.9692660f, 1.8760108f, 0.0415560f},
                                  {0.0556434f, -0.2040259f, 1.0572252f}}};

ThinFilm film(float ior, float thickness_nm) {
    return {.strength = 1.0f, .ior = ior, .thickness_nm = thickness_nm, .xyz_to_working = &kToRec709};
}

/// Luminance of what a film over a dielectric reflects at right angles: Airy's formula, summed over the wavelengths of
/// a flat spectrum.
double exact_luminance(double film_ior, double thickness_nm, double base_ior) {
    const double r12 = (1.0 - film_ior) / (1.0 + film_ior);
    const double r23 = (film_ior - base_ior) / (film_ior + base_ior);
    double sum = 0.0;
    double total = 0.0;
    for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
        const double y = color_matching_xyz(nm)[1];
        const std::complex<double> turn = std::polar(1.0, 4.0 * std::numbers::pi * film_ior * thickness_nm / nm);
        sum += y * std::norm((r12 + r23 * turn) / (1.0 + r12 * r23 * turn));
        total += y;
    }
    return sum / total;
}

TEST(ThinFilm, IsCloseToTheExactSumOverWavelengths) {
    for (const float base_ior : {1.2f, 1.5f, 2.0f})
        for (const float film_ior : {1.3f, 1.8f})
            for (const float thickness : {100.0f, 250.0f, 400.0f, 800.0f}) {
                const float root = (base_ior - 1.0f) / (base_ior + 1.0f);
                const Rgb color = film(film_ior, thickness).reflectance(Rgb(root * root), 1.0f);
                const float luminance = 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b;
                // The fit of the matching functions and two orders of interference; what is clamped to [0, 1].
                EXPECT_NEAR(luminance, exact_luminance(film_ior, thickness, base_ior), 0.02)
                    << "film " << film_ior << ", " << thickness << " nm, over " << base_ior;
            }
}

TEST(ThinFilm, AThickOneHasNoColour) {
    const Rgb color = film(1.5f, 20'000.0f).reflectance(Rgb(0.1f), 0.9f);
    EXPECT_NEAR(color.r, color.g, 1e-3f);
    EXPECT_NEAR(color.b, color.g, 1e-3f);
}

TEST(ThinFilm, IsFiniteHoweverThickAFileSaysItIs) {
    EXPECT_TRUE(is_finite(film(3e38f, 3e38f).reflectance(Rgb(0.1f), 0.5f)));
}

TEST(ThinFilm, ReflectsEverythingAtGrazingAngles) {
    EXPECT_NEAR(film(1.4f, 300.0f).reflectance(Rgb(0.04f), 0.0f).g, 1.0f, 1e-3f);
}

TEST(ThinFilm, ColourChangesWithTheAngle) {
    const ThinFilm soap = film(1.33f, 350.0f);
    const Rgb front = soap.reflectance(Rgb(0.04f), 1.0f);
    const Rgb side = soap.reflectance(Rgb(0.04f), 0.5f);
    EXPECT_GT(std::abs(front.r / front.g - side.r / side.g), 0.1f);
}

}  // namespace

}  // namespace etendue::test
