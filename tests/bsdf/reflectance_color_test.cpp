#include "bsdf/reflectance_color.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>

#include <gtest/gtest.h>

namespace etendue {

namespace {

struct CieRow {
    double nm, x, y, z, d65;
};

// CIE 1931 2° observer and illuminant D65 as the CIE tabulates them, every 20 nm.
constexpr std::array<CieRow, 21> kCie{
    {{380, 0.001368, 0.000039, 0.006450, 49.9755}, {400, 0.014310, 0.000396, 0.067850, 82.7549},
     {420, 0.134380, 0.004000, 0.645600, 93.4318}, {440, 0.348280, 0.023000, 1.747060, 104.865},
     {460, 0.290800, 0.060000, 1.669200, 117.812}, {480, 0.095640, 0.139020, 0.812950, 115.923},
     {500, 0.004900, 0.323000, 0.272000, 109.354}, {520, 0.063270, 0.710000, 0.078250, 104.790},
     {540, 0.290400, 0.954000, 0.020300, 104.405}, {560, 0.594500, 0.995000, 0.003900, 100.000},
     {580, 0.916300, 0.870000, 0.001650, 95.7880}, {600, 1.062200, 0.631000, 0.000800, 90.0062},
     {620, 0.854450, 0.381000, 0.000190, 87.6987}, {640, 0.447900, 0.175000, 0.000020, 83.6992},
     {660, 0.164900, 0.061000, 0.000000, 80.2146}, {680, 0.046770, 0.017000, 0.000000, 78.2842},
     {700, 0.011359, 0.004102, 0.000000, 71.6091}, {720, 0.002899, 0.001047, 0.000000, 61.6040},
     {740, 0.000690, 0.000249, 0.000000, 75.0870}, {760, 0.000166, 0.000060, 0.000000, 46.4182},
     {780, 0.000042, 0.000015, 0.000000, 63.3828}}};

Rgb rec709_by_table(const std::function<double(double)>& reflectance) {
    double x = 0.0, y = 0.0, z = 0.0;
    for (const CieRow& row : kCie) {
        const double light = row.d65 * reflectance(row.nm);
        x += light * row.x;
        y += light * row.y;
        z += light * row.z;
    }
    // IEC 61966-2-1, to four digits as the standard gives them.
    return {static_cast<float>(3.2406 * x - 1.5372 * y - 0.4986 * z),
            static_cast<float>(-0.9689 * x + 1.8758 * y + 0.0415 * z),
            static_cast<float>(0.0557 * x - 0.2040 * y + 1.0570 * z)};
}

TEST(ReflectanceColor, PerfectReflectorIsExactlyWhite) {
    EXPECT_EQ(reflectance_color([](double) { return 1.0; }), Rgb(1.0f));
    EXPECT_EQ(reflectance_color([](double) { return 0.25; }), Rgb(0.25f));
}

TEST(ReflectanceColor, AgreesWithTheTabulatedObserver) {
    const std::array<std::function<double(double)>, 4> spectra{
        [](double nm) { return (nm - 380.0) / 400.0; }, [](double nm) { return (780.0 - nm) / 400.0; },
        [](double nm) { return 1.0 / (1.0 + std::exp((540.0 - nm) / 25.0)); },
        [](double nm) { return std::exp(-0.5 * std::pow((nm - 530.0) / 50.0, 2)); }};
    const Rgb white = rec709_by_table([](double) { return 1.0; });
    for (std::size_t i = 0; i < spectra.size(); ++i) {
        SCOPED_TRACE(i);
        const Rgb color = reflectance_color(spectra[i]);
        const Rgb expected = rec709_by_table(spectra[i]) / white;
        EXPECT_NEAR(color.r, expected.r, 0.01f);
        EXPECT_NEAR(color.g, expected.g, 0.01f);
        EXPECT_NEAR(color.b, expected.b, 0.01f);
    }
}

TEST(ReflectanceColor, NarrowBandsGiveTheirPrimary) {
    const auto band = [](double center) {
        return reflectance_color([center](double nm) { return std::abs(nm - center) <= 20.0 ? 1.0 : 0.0; });
    };
    const Rgb red = band(630.0), green = band(535.0), blue = band(450.0);
    EXPECT_GT(red.r, 0.2f);
    EXPECT_LT(red.b, 0.02f);
    EXPECT_GT(green.g, 0.2f);
    EXPECT_LT(green.r, 0.0f);  // outside the Rec.709 triangle, and not clamped here
    EXPECT_GT(blue.b, 0.2f);
    EXPECT_LT(blue.g, 0.02f);
}

}  // namespace

}  // namespace etendue
