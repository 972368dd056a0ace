#include "color/primaries.h"

#include <gtest/gtest.h>

namespace etendue {

namespace {

void expect_elements_near(const Matrix3d& a, const Matrix3d& b, double tolerance) {
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "element " << i;
}

Chromaticities find(std::string_view name) {
    for (const PublishedPrimaries& published : published_primaries()) {
        if (published.name == name) return published.chromaticities;
    }
    ADD_FAILURE() << "no primaries " << name;
    return {};
}

TEST(Primaries, InverseUndoes) {
    const Matrix3d m{2, -1, 0.5, 0.25, 3, 1, -0.75, 0.125, 1.5};
    expect_elements_near(m * inverse(m), {1, 0, 0, 0, 1, 0, 0, 0, 1}, 1e-14);
}

// IEC 61966-2-1:1999, equation 7 (four digits).
TEST(Primaries, Rec709ToXyzIsThePublishedMatrix) {
    expect_elements_near(rgb_to_xyz(find("Rec.709")),
                         {0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505}, 6e-5);
}

// AMPAS S-2014-004, appendix A: ACEScg to CIE XYZ.
TEST(Primaries, AcescgToXyzIsThePublishedMatrix) {
    expect_elements_near(rgb_to_xyz(find("AP1")),
                         {0.6624541811, 0.1340042065, 0.1561876870, 0.2722287168, 0.6740817658, 0.0536895174,
                          -0.0055746495, 0.0040607335, 1.0103391003},
                         1e-9);
}

// Bruce Lindbloom's published Bradford matrix from D65 to D50, for (0.31271, 0.32902) and (0.34567, 0.35850).
TEST(Primaries, BradfordFromD65ToD50IsThePublishedMatrix) {
    expect_elements_near(
        bradford_adaptation({0.31271f, 0.32902f}, {0.34567f, 0.35850f}),
        {1.0478112, 0.0228866, -0.0501270, 0.0295424, 0.9904844, -0.0170491, -0.0092345, 0.0150436, 0.7521316}, 2e-4);
}

TEST(Primaries, WhiteStaysWhite) {
    for (const PublishedPrimaries& from : published_primaries()) {
        for (const PublishedPrimaries& to : published_primaries()) {
            const auto white = rgb_to_rgb(from.chromaticities, to.chromaticities) * std::array<double, 3>{1, 1, 1};
            for (const double channel : white) EXPECT_NEAR(channel, 1.0, 1e-9) << from.name << " to " << to.name;
        }
    }
}

TEST(Primaries, ChromaticitiesOfTheMatrixAreThoseItWasMadeOf) {
    for (const PublishedPrimaries& published : published_primaries()) {
        const Chromaticities found = chromaticities_of(rgb_to_xyz(published.chromaticities));
        const Chromaticities& expected = published.chromaticities;
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_NEAR(found.red[i], expected.red[i], 1e-6f) << published.name;
            EXPECT_NEAR(found.green[i], expected.green[i], 1e-6f) << published.name;
            EXPECT_NEAR(found.blue[i], expected.blue[i], 1e-6f) << published.name;
            EXPECT_NEAR(found.white[i], expected.white[i], 1e-6f) << published.name;
        }
    }
}

TEST(Primaries, EachIsRecognisedAndNothingElse) {
    for (const PublishedPrimaries& published : published_primaries()) {
        const auto found = recognise_primaries(rgb_to_rgb(published.chromaticities, kAp0));
        ASSERT_TRUE(found) << published.name;
        EXPECT_EQ(found->red, published.chromaticities.red) << published.name;
        EXPECT_EQ(found->white, published.chromaticities.white) << published.name;
    }
    Chromaticities other = find("Rec.709");
    other.green[0] += 0.002f;
    EXPECT_FALSE(recognise_primaries(rgb_to_rgb(other, kAp0)));
}

}  // namespace

}  // namespace etendue
