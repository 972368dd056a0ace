#include "bsdf/fresnel.h"

#include "bsdf/interface_fresnel.h"

#include <cmath>

#include <gtest/gtest.h>

namespace etendue {

namespace {

float cosine_of_degrees(float degrees) {
    return std::cos(degrees * kPi / 180.0f);
}

TEST(FresnelDielectric, MatchesTabulatedGlassAndWater) {
    // Hecht, "Optics", 5th edition, section 4.6: 4% at normal incidence on glass, and its figure 4.49's curves.
    EXPECT_NEAR(fresnel_dielectric(1.0f, 1.5f), 0.04f, 1e-6f);
    EXPECT_NEAR(fresnel_dielectric(1.0f, 1.0f / 1.5f), 0.04f, 1e-6f);
    EXPECT_NEAR(fresnel_dielectric(1.0f, 1.333f), 0.0204f, 1e-4f);
    // r_s² = 0.0920, r_p² = 0.0085 at 45 degrees.
    EXPECT_NEAR(fresnel_dielectric(cosine_of_degrees(45.0f), 1.5f), 0.5f * (0.0920f + 0.0085f), 1e-4f);
    // r_s² = 0.1766, r_p² = 0.0018 at 60 degrees.
    EXPECT_NEAR(fresnel_dielectric(cosine_of_degrees(60.0f), 1.5f), 0.5f * (0.1766f + 0.0018f), 1e-4f);
    EXPECT_NEAR(fresnel_dielectric(0.0f, 1.5f), 1.0f, 1e-6f);
}

TEST(FresnelDielectric, AtBrewstersAngleOnlyThePerpendicularPartReflects) {
    for (const float n : {1.1f, 1.5f, 2.4f}) {
        const float perpendicular = (1.0f - n * n) / (1.0f + n * n);
        EXPECT_NEAR(fresnel_dielectric(std::cos(std::atan(n)), n), 0.5f * perpendicular * perpendicular, 1e-6f);
    }
}

TEST(FresnelDielectric, ReflectsTotallyBeyondTheCriticalAngle) {
    const float critical = std::asin(1.0f / 1.5f);
    EXPECT_EQ(fresnel_dielectric(std::cos(critical + 1e-3f), 1.0f / 1.5f), 1.0f);
    EXPECT_LT(fresnel_dielectric(std::cos(critical - 1e-3f), 1.0f / 1.5f), 0.9f);
}

TEST(FresnelDielectric, IsTheSameFromBothSidesOfARefractedRay) {
    for (const float cos_o : {0.05f, 0.3f, 0.7f, 0.99f}) {
        const Vec3f wo{std::sqrt(1.0f - cos_o * cos_o), 0.0f, cos_o};
        Vec3f wi;
        ASSERT_TRUE(refract(wo, {0.0f, 0.0f, 1.0f}, 1.5f, wi));
        EXPECT_NEAR(fresnel_dielectric(cos_o, 1.5f), fresnel_dielectric(-wi.z, 1.0f / 1.5f), 1e-4f);
    }
}

TEST(FresnelDielectricAverage, MatchesTheClosedForm) {
    // Walsh's formula for diffuse light (Duntley, JOSA 32(2), 1942): 0.0918 for n = 1.5.
    EXPECT_NEAR(fresnel_dielectric_average(1.1f), 0.025157f, 0.002f * 0.025157f);
    EXPECT_NEAR(fresnel_dielectric_average(1.5f), 0.091778f, 0.002f * 0.091778f);
    EXPECT_NEAR(fresnel_dielectric_average(3.0f), 0.276203f, 0.002f * 0.276203f);
    // From inside: 1 - F(1/n) = (1 - F(n)) / n².
    for (const float n : {1.1f, 1.5f, 3.0f})
        EXPECT_NEAR(fresnel_dielectric_average(1.0f / n), 1.0f - (1.0f - fresnel_dielectric_average(n)) / (n * n),
                    2e-3f);
    EXPECT_NEAR(fresnel_dielectric_average(1.0f / 1.5f), 0.596346f, 0.002f * 0.596346f);
    EXPECT_NEAR(fresnel_dielectric_average(1.0f), 0.0f, 1e-6f);
}

TEST(Refract, FollowsSnellsLaw) {
    const Vec3f n = normalize({0.2f, -0.1f, 1.0f});
    const Vec3f wo = normalize({0.6f, 0.3f, 0.7f});
    for (const float eta : {0.7f, 1.0f, 1.5f, 2.4f}) {
        Vec3f wi;
        ASSERT_TRUE(refract(wo, n, eta, wi));
        EXPECT_NEAR(length(wi), 1.0f, 1e-6f);
        EXPECT_NEAR(length(cross(wo, n)), eta * length(cross(wi, n)), 1e-6f);
        EXPECT_LT(dot(wi, n), 0.0f);
        EXPECT_NEAR(dot(cross(wo, n), wi), 0.0f, 1e-6f) << "all three lie in a plane";
        EXPECT_LT(dot(wo - n * dot(wo, n), wi - n * dot(wi, n)), 0.0f) << "light goes on sideways as it came";
    }
    Vec3f wi;
    EXPECT_FALSE(refract(normalize({0.9f, 0.0f, 0.3f}), {0.0f, 0.0f, 1.0f}, 1.0f / 1.5f, wi));
}

TEST(InterfaceFresnel, IsThatOfTheIndicesUnlessItIsChanged) {
    for (const float eta : {1.5f, 1.0f / 1.5f}) {
        for (const float degrees : {0.0f, 30.0f, 41.0f, 60.0f, 89.0f}) {
            const float bare = fresnel_dielectric(cosine_of_degrees(degrees), eta);
            // A weight this close to 1 takes the general way.
            const InterfaceFresnel general{.weight = 1.0f - 1e-6f};
            EXPECT_NEAR(general(cosine_of_degrees(degrees), eta, eta > 1.0f).reflected.g, bare, 1e-5f);
        }
    }
}

TEST(InterfaceFresnel, TheTintFadesTowardsGrazingAnglesAndTheWeightDoesNot) {
    const InterfaceFresnel black{.tint = Rgb(0.0f)};
    EXPECT_EQ(black(1.0f, 1.5f, true).reflected, Rgb(0.0f));
    EXPECT_GT(black(cosine_of_degrees(88.0f), 1.5f, true).reflected.r, 0.8f);
    const InterfaceFresnel tinted{.tint = {0.5f, 1.0f, 100.0f}, .weight = 0.5f};
    const Rgb normal = tinted(1.0f, 1.5f, true).reflected;
    EXPECT_NEAR(normal.r, 0.5f * 0.02f, 1e-6f);
    EXPECT_NEAR(normal.g, 0.5f * 0.04f, 1e-6f);
    EXPECT_NEAR(normal.b, 0.5f, 1e-6f);
    EXPECT_NEAR(tinted(cosine_of_degrees(89.99f), 1.5f, true).reflected.r, 0.5f, 1e-3f);
    EXPECT_EQ(tinted(cosine_of_degrees(60.0f), 1.0f / 1.5f, false).reflected, Rgb(1.0f)) << "reflected totally";
}

TEST(FresnelSchlick, PassesThroughItsEnds) {
    const Rgb f0{0.04f, 0.5f, 1.0f};
    EXPECT_EQ(fresnel_schlick(f0, 1.0f), f0);
    EXPECT_EQ(fresnel_schlick(f0, 0.0f), Rgb(1.0f));
    // Schlick 1994: within a per cent of the exact curve for glass up to 60 degrees.
    EXPECT_NEAR(fresnel_schlick(Rgb(0.04f), 0.5f).r, fresnel_dielectric(0.5f, 1.5f), 0.025f);
}

TEST(FresnelMetal, PassesThroughBothGivenReflectances) {
    const Rgb f0{0.9f, 0.6f, 0.3f};
    const Rgb f82{0.85f, 0.8f, 0.4f};
    const FresnelMetal metal = FresnelMetal::from_f0_f82(f0, f82);
    const Rgb at_82 = metal(1.0f / 7.0f);
    EXPECT_NEAR(at_82.r, f82.r, 1e-5f);
    EXPECT_NEAR(at_82.g, f82.g, 1e-5f);
    EXPECT_NEAR(at_82.b, f82.b, 1e-5f);
    EXPECT_EQ(metal(1.0f), f0);
    EXPECT_EQ(metal(0.0f), Rgb(1.0f));
}

TEST(FresnelMetal, AverageIsTheCosineWeightedMean) {
    const FresnelMetal metal = FresnelMetal::from_f0_f82({0.9f, 0.6f, 0.3f}, {0.85f, 0.8f, 0.4f});
    constexpr int kSteps = 10'000;
    Rgb sum;
    for (int i = 0; i < kSteps; ++i) sum += metal(std::sqrt((static_cast<float>(i) + 0.5f) / kSteps));
    const Rgb average = metal.average();
    EXPECT_NEAR(average.r, sum.r / kSteps, 1e-4f);
    EXPECT_NEAR(average.g, sum.g / kSteps, 1e-4f);
    EXPECT_NEAR(average.b, sum.b / kSteps, 1e-4f);
}

}  // namespace

}  // namespace etendue
