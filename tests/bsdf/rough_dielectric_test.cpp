#include "bsdf/rough_dielectric.h"

#include "bsdf/fresnel.h"
#include "bsdf/ggx_albedo.h"
#include "bsdf/smooth_dielectric.h"
#include "bsdf_settings.h"
#include "support/random.h"

#include <cmath>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Mean weight of the samples that are transmitted.
double transmitted_share(const RoughDielectric& lobe, const Vec3f& wo, TransportMode mode) {
    constexpr int kSamples = 50'000;
    Random random(1);
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        const float u_lobe = random.next();
        const BsdfSample s = lobe.sample(wo, u_lobe, random.next_2d(), mode);
        if (s.is_transmission) sum += static_cast<double>(s.weight.g);
    }
    return sum / kSamples;
}

// The specification's derivation (the header's comment) gives R_A + T_A = 1 and the ratio of both sides' T.
TEST(RoughDielectric, SharesOfMultipleScatteringAreReciprocal) {
    for (const float ior : {1.1f, 1.5f, 2.5f})
        for (const float alpha : {0.05f, 0.3f, 1.0f}) {
            const RoughDielectric lobe = RoughDielectric::make(ior, alpha);
            const float missing_outside = 1.0f - ggx_dielectric_albedo_average(alpha, ior);
            const float missing_inside = 1.0f - ggx_dielectric_albedo_average(alpha, 1.0f / ior);
            EXPECT_NEAR(lobe.multiple_transmitted_outside / (missing_inside * ior * ior),
                        lobe.multiple_transmitted_inside / missing_outside,
                        1e-4f * lobe.multiple_transmitted_inside / missing_outside);
            EXPECT_GE(lobe.multiple_transmitted_outside, 0.0f);
            EXPECT_LE(lobe.multiple_transmitted_outside, 1.0f);
            EXPECT_GE(lobe.multiple_transmitted_inside, 0.0f);
            EXPECT_LE(lobe.multiple_transmitted_inside, 1.0f);
        }
}

TEST(RoughDielectric, NearlySmoothItSplitsLightLikeASmoothOne) {
    const RoughDielectric lobe = RoughDielectric::make(1.5f, 0.002f);
    for (const float cos_theta : {0.2f, 0.7f, 1.0f, -0.8f, -0.95f}) {
        const float eta = cos_theta > 0.0f ? 1.5f : 1.0f / 1.5f;
        const double transmitted = 1.0 - static_cast<double>(fresnel_dielectric(std::abs(cos_theta), eta));
        const Vec3f wo = direction_at(cos_theta);
        EXPECT_NEAR(transmitted_share(lobe, wo, TransportMode::Importance), transmitted, 0.01);
        // Radiance is scaled by the squared ratio of the indices.
        EXPECT_NEAR(transmitted_share(lobe, wo, TransportMode::Radiance) * static_cast<double>(eta * eta), transmitted,
                    0.01);
    }
}

TEST(RoughDielectric, ReportsTheIndexRatioOfTransmittedSamplesOnly) {
    Random random(2);
    const RoughDielectric lobe = RoughDielectric::make(1.5f, 0.3f);
    for (const float cos_theta : {0.5f, -0.9f})
        for (int i = 0; i < 1000; ++i) {
            const float u_lobe = random.next();
            const BsdfSample s =
                lobe.sample(direction_at(cos_theta), u_lobe, random.next_2d(), TransportMode::Radiance);
            if (is_black(s.weight)) continue;
            const float ratio = cos_theta > 0.0f ? 1.5f : 1.0f / 1.5f;
            ASSERT_FLOAT_EQ(s.eta, s.is_transmission ? ratio : 1.0f);
        }
}

// Light walks and eye walks through a slab of rough glass carry the same: in, and out again on the other side, in a
// straight line, where the squared indices of both interfaces cancel.
TEST(RoughDielectric, IndicesCancelOverEntryAndExit) {
    const RoughDielectric lobe = RoughDielectric::make(1.5f, 0.2f);
    const Vec3f outside = direction_at(0.8f);
    const Vec3f inside = normalize({-0.4f, 0.05f, -0.9f});
    const auto f = [&](const Vec3f& o, const Vec3f& i, TransportMode mode) {
        return lobe.evaluate(o, i, mode).f_cos.g;
    };
    const float radiance = f(outside, inside, TransportMode::Radiance) * f(inside, outside, TransportMode::Radiance);
    const float importance =
        f(outside, inside, TransportMode::Importance) * f(inside, outside, TransportMode::Importance);
    EXPECT_GT(importance, 0.0f);
    EXPECT_NEAR(radiance / importance, 1.0f, 1e-5f);
}

TEST(SmoothDielectric, FollowsSnellAndFresnel) {
    const SmoothDielectric lobe{1.5f};
    const Vec3f wo = direction_at(0.6f);
    const float reflectance = fresnel_dielectric(0.6f, 1.5f);
    const BsdfSample reflected = lobe.sample(wo, 0.5f * reflectance, {}, TransportMode::Radiance);
    EXPECT_TRUE(reflected.is_delta);
    EXPECT_FALSE(reflected.is_transmission);
    EXPECT_EQ(reflected.wi, Vec3f(-wo.x, -wo.y, wo.z));
    EXPECT_EQ(reflected.weight, Rgb(1.0f)) << "chosen with its own reflectance";
    const BsdfSample refracted = lobe.sample(wo, 0.5f * (1.0f + reflectance), {}, TransportMode::Radiance);
    EXPECT_TRUE(refracted.is_delta);
    EXPECT_TRUE(refracted.is_transmission);
    EXPECT_NEAR(refracted.wi.x, -0.8f / 1.5f, 1e-6f);
    EXPECT_LT(refracted.wi.z, 0.0f);
    EXPECT_FLOAT_EQ(refracted.eta, 1.5f);
    EXPECT_FLOAT_EQ(refracted.weight.r, 1.0f / 2.25f);
    // Back out again, the squared index comes back.
    const BsdfSample back = lobe.sample(refracted.wi, 0.5f * (1.0f + reflectance), {}, TransportMode::Radiance);
    EXPECT_NEAR(length(back.wi - wo), 0.0f, 1e-5f);
    EXPECT_FLOAT_EQ(back.weight.r * refracted.weight.r, 1.0f);
    EXPECT_FLOAT_EQ(lobe.sample(wo, 0.99f, {}, TransportMode::Importance).weight.r, 1.0f);
}

TEST(SmoothDielectric, ReflectsEverythingBeyondTheCriticalAngle) {
    const SmoothDielectric lobe{1.5f};
    for (const float u_lobe : {0.0f, 0.5f, 0.999f}) {
        const BsdfSample s = lobe.sample(direction_at(-0.3f), u_lobe, {}, TransportMode::Radiance);
        EXPECT_FALSE(s.is_transmission);
        EXPECT_EQ(s.weight, Rgb(1.0f));
        EXPECT_LT(s.wi.z, 0.0f);
    }
}

}  // namespace

}  // namespace etendue::test
