#include "bsdf/thin_film.h"

#include "bsdf/color_matching.h"
#include "bsdf/fresnel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr XyzToWorking kToRec709{{{3.2404542f, -1.5371385f, -0.4985314f},
                                  {-0.9692660f, 1.8760108f, 0.0415560f},
                                  {0.0556434f, -0.2040259f, 1.0572252f}}};

ThinFilm film(float ior, float thickness_nm) {
    return {.strength = 1.0f, .ior = ior, .thickness_nm = thickness_nm, .xyz_to_working = &kToRec709};
}

/// What a film over a dielectric reflects: Airy's formula for both polarisations, summed over the wavelengths of a flat
/// spectrum, in linear Rec.709.
std::array<double, 3> exact_rgb(double film_ior, double thickness_nm, double base_ior, double cos_above) {
    const double sin2 = 1.0 - cos_above * cos_above;
    const double cos_film = std::sqrt(1.0 - sin2 / (film_ior * film_ior));
    const double cos_base = std::sqrt(1.0 - sin2 / (base_ior * base_ior));
    const auto across = [](double n1, double c1, double n2, double c2) {
        return (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
    };
    const auto along = [](double n1, double c1, double n2, double c2) {
        return (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
    };
    std::array<double, 3> xyz{};
    double total = 0.0;
    for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
        const double phase = 4.0 * std::numbers::pi * film_ior * thickness_nm * cos_film / nm;
        const std::complex<double> turn = std::polar(1.0, phase);
        double reflected = 0.0;
        for (const auto& r :
             {std::pair{across(1.0, cos_above, film_ior, cos_film), across(film_ior, cos_film, base_ior, cos_base)},
              std::pair{along(1.0, cos_above, film_ior, cos_film), along(film_ior, cos_film, base_ior, cos_base)}})
            reflected += 0.5 * std::norm((r.first + r.second * turn) / (1.0 + r.first * r.second * turn));
        const auto matching = color_matching_xyz(nm);
        for (std::size_t c = 0; c < 3; ++c) xyz[c] += matching[c] * reflected;
        total += matching[1];
    }
    std::array<double, 3> rgb{};
    for (std::size_t row = 0; row < 3; ++row) {
        const Rgb& m = kToRec709[row];
        rgb[row] = (static_cast<double>(m.r) * xyz[0] + static_cast<double>(m.g) * xyz[1] +
                    static_cast<double>(m.b) * xyz[2]) /
                   total;
    }
    return rgb;
}

/// White is that of the flat spectrum, as in the film, whose channels are 1 where everything is reflected.
std::array<double, 3> exact_color(double film_ior, double thickness_nm, double base_ior, double cos_above) {
    std::array<double, 3> color = exact_rgb(film_ior, thickness_nm, base_ior, cos_above);
    const std::array<double, 3> white = exact_rgb(1.0, 0.0, 1e9, 1.0);
    for (std::size_t c = 0; c < 3; ++c) color[c] /= white[c];
    return color;
}

TEST(ThinFilm, IsCloseToTheExactSumOverWavelengths) {
    for (const float base_ior : {1.2f, 1.5f, 2.0f})
        for (const float film_ior : {1.3f, 1.8f})
            for (const float thickness : {100.0f, 250.0f, 400.0f, 800.0f})
                for (const float cos_above : {1.0f, 0.8f, 0.5f}) {
                    const float root = (base_ior - 1.0f) / (base_ior + 1.0f);
                    const Rgb color = film(film_ior, thickness).reflectance(Rgb(root * root), cos_above);
                    const std::array<double, 3> exact = exact_color(film_ior, thickness, base_ior, cos_above);
                    // The fit of the matching functions, two orders of interference, and Schlick's curve.
                    SCOPED_TRACE(testing::Message() << "film " << film_ior << ", " << thickness << " nm, over "
                                                    << base_ior << ", cosine " << cos_above);
                    EXPECT_NEAR(color.r, exact[0], 0.05);
                    EXPECT_NEAR(color.g, exact[1], 0.05);
                    EXPECT_NEAR(color.b, exact[2], 0.05);
                }
}

struct KnownFilm {
    float film_ior;
    float thickness_nm;
    float base_ior;
    float cos_above;
    Rgb color;
};

// The same fit in double precision, by a program of its own from the formulas of KHR_materials_iridescence.
TEST(ThinFilm, IsTheFitOfTheExtension) {
    for (const KnownFilm& known : {KnownFilm{1.3f, 100.0f, 1.5f, 1.0f, {0.00313f, 0.00443f, 0.00755f}},
                                   KnownFilm{1.8f, 250.0f, 1.5f, 1.0f, {0.15755f, 0.10913f, 0.04390f}},
                                   KnownFilm{1.8f, 800.0f, 2.0f, 0.5f, {0.11801f, 0.10733f, 0.10756f}},
                                   KnownFilm{1.33f, 350.0f, 1.2f, 0.8f, {0.03253f, 0.03618f, 0.01466f}}}) {
        const float root = (known.base_ior - 1.0f) / (known.base_ior + 1.0f);
        const Rgb color = film(known.film_ior, known.thickness_nm).reflectance(Rgb(root * root), known.cos_above);
        EXPECT_NEAR(color.r, known.color.r, 1e-4f) << known.thickness_nm << " nm";
        EXPECT_NEAR(color.g, known.color.g, 1e-4f) << known.thickness_nm << " nm";
        EXPECT_NEAR(color.b, known.color.b, 1e-4f) << known.thickness_nm << " nm";
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
