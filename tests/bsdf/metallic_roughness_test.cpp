#include "bsdf/metallic_roughness.h"

#include "bsdf/bsdf.h"
#include "bsdf/fresnel.h"
#include "bsdf_settings.h"
#include "support/random.h"

#include <cmath>
#include <variant>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

Vec3f below(const Vec3f& w) {
    return {w.x, w.y, -w.z};
}

Rgb value(const MetallicRoughness& lobe, const Vec3f& wo, const Vec3f& wi) {
    return lobe.evaluate(wo, wi, TransportMode::Radiance).f_cos / std::abs(wi.z);
}

TEST(MetallicRoughness, IsAMixOfDielectricAndMetal) {
    // glTF 2.0, appendix B: material = mix(dielectric, metal, metallic).
    Random random(1);
    for (const float alpha : {0.1f, 0.5f, 1.0f}) {
        const Rgb base{0.9f, 0.5f, 0.1f};
        const MetallicRoughness dielectric{.base = base, .metallic = 0.0f, .alpha_x = alpha, .alpha_y = alpha};
        const MetallicRoughness metal{.base = base, .metallic = 1.0f, .alpha_x = alpha, .alpha_y = alpha};
        const MetallicRoughness mixed{.base = base, .metallic = 0.3f, .alpha_x = alpha, .alpha_y = alpha};
        for (int i = 0; i < 200; ++i) {
            const Vec3f wo = direction_at(0.05f + 0.95f * random.next());
            const Vec3f wi = normalize({random.next() - 0.5f, random.next() - 0.5f, 0.01f + random.next()});
            const Rgb expected = lerp(value(dielectric, wo, wi), value(metal, wo, wi), 0.3f);
            const Rgb got = value(mixed, wo, wi);
            ASSERT_NEAR(got.r, expected.r, 1e-4f * expected.r + 1e-6f);
            ASSERT_NEAR(got.b, expected.b, 1e-4f * expected.b + 1e-6f);
        }
    }
}

TEST(MetallicRoughness, TheDensityAloneIsThatOfTheValue) {
    Random random(17);
    int checked = 0;
    for (const BsdfSetting& setting : all_bsdf_settings()) {
        const auto* lobe = std::get_if<MetallicRoughness>(&setting.bsdf);
        if (lobe == nullptr) continue;
        for (const Vec3f& wo : outgoing_directions(setting.bsdf))
            for (int i = 0; i < 50; ++i) {
                const Vec3f wi = normalize({random.next() - 0.5f, random.next() - 0.5f, random.next() - 0.5f});
                const float expected = lobe->evaluate(wo, wi, setting.mode).pdf_solid_angle;
                ASSERT_NEAR(lobe->pdf_solid_angle(wo, wi), expected, 1e-6f * expected) << setting.name;
                ++checked;
            }
    }
    EXPECT_GT(checked, 0);
    EXPECT_EQ(MetallicRoughness{}.pdf_solid_angle({0, 0, -1}, {0, 0, 1}), 0.0f);
}

TEST(MetallicRoughness, AMetalIsARoughConductorWithSchlicksFresnel) {
    const Rgb base{0.9f, 0.5f, 0.1f};
    const MetallicRoughness metal{.base = base, .metallic = 1.0f, .alpha_x = 0.3f, .alpha_y = 0.3f};
    const RoughConductor conductor{.fresnel = {.f0 = base, .dip = Rgb(0.0f)}, .alpha = 0.3f};
    const Vec3f wo = direction_at(0.4f);
    const Vec3f wi = normalize({-0.5f, 0.2f, 0.5f});
    const Rgb expected = conductor.evaluate(wo, wi, TransportMode::Radiance).f_cos;
    const Rgb got = metal.evaluate(wo, wi, TransportMode::Radiance).f_cos;
    EXPECT_NEAR(got.r, expected.r, 1e-5f * expected.r);
    EXPECT_NEAR(got.g, expected.g, 1e-5f * expected.g);
    EXPECT_NEAR(got.b, expected.b, 1e-5f * expected.b);
}

TEST(MetallicRoughness, WithoutReflectanceAtNormalIncidenceItIsNearlyLambertian) {
    const MetallicRoughness lobe{
        .base = {0.5f, 0.5f, 0.5f}, .metallic = 0.0f, .alpha_x = 1.0f, .alpha_y = 1.0f, .f0 = Rgb(0.0f)};
    const Rgb f = value(lobe, {0.0f, 0.0f, 1.0f}, direction_at(0.9f));
    EXPECT_NEAR(f.g, 0.5f * kInvPi, 0.1f * 0.5f * kInvPi);
}

// A thin sheet: seen in a mirror, transmission is the reflection of the same surface, so swapping the directions (and
// with them the sides) changes nothing.
TEST(MetallicRoughness, ThinTransmissionIsReciprocal) {
    const MetallicRoughness lobe{
        .base = {0.9f, 0.5f, 0.1f}, .metallic = 0.2f, .alpha_x = 0.3f, .alpha_y = 0.3f, .transmission = 0.7f};
    Random random(2);
    for (int i = 0; i < 200; ++i) {
        const Vec3f wo = direction_at(0.05f + 0.95f * random.next());
        const Vec3f wi = normalize({random.next() - 0.5f, random.next() - 0.5f, -0.01f - random.next()});
        const Rgb forward = value(lobe, wo, wi);
        const Rgb backward = value(lobe, below(wi), below(wo));
        ASSERT_GT(forward.g, 0.0f);
        ASSERT_NEAR(forward.g, backward.g, 1e-3f * forward.g);
    }
}

TEST(MetallicRoughness, SmoothTransmissionGoesStraightOnTintedOnce) {
    const Rgb base{0.9f, 0.5f, 0.1f};
    const MetallicRoughness lobe{
        .base = base, .metallic = 0.0f, .alpha_x = 0.0f, .alpha_y = 0.0f, .transmission = 1.0f};
    const Vec3f wo = direction_at(0.6f);
    constexpr int kSamples = 20'000;
    Random random(3);
    Rgb transmitted;
    Rgb reflected;
    for (int i = 0; i < kSamples; ++i) {
        const float u_lobe = random.next();
        const BsdfSample s = lobe.sample(wo, u_lobe, random.next_2d(), TransportMode::Radiance);
        ASSERT_TRUE(s.is_delta);
        if (s.is_transmission) {
            ASSERT_EQ(s.wi, -wo);
            ASSERT_EQ(s.eta, 1.0f) << "thin: no refraction, no change of radiance";
            transmitted += s.weight / kSamples;
        } else {
            reflected += s.weight / kSamples;
        }
    }
    const float f = fresnel_schlick(Rgb(0.04f), 0.6f).r;
    EXPECT_NEAR(reflected.g, f, 0.01f);
    EXPECT_NEAR(transmitted.r, base.r * (1.0f - f), 0.01f);
    EXPECT_NEAR(transmitted.b, base.b * (1.0f - f), 0.01f);
}

TEST(SmoothConductor, MirrorsWithItsReflectance) {
    const FresnelMetal gold = FresnelMetal::from_f0_f82({1.0f, 0.78f, 0.34f}, {0.96f, 0.92f, 0.7f});
    const BsdfSample s = SmoothConductor{gold}.sample(direction_at(0.6f), 0.5f, {}, TransportMode::Radiance);
    EXPECT_TRUE(s.is_delta);
    EXPECT_EQ(s.wi, direction_at(0.6f) * Vec3f(-1.0f, -1.0f, 1.0f));
    const Rgb reflectance = gold(direction_at(0.6f).z);
    EXPECT_FLOAT_EQ(s.weight.r, reflectance.r);
    EXPECT_FLOAT_EQ(s.weight.g, reflectance.g);
    EXPECT_FLOAT_EQ(s.weight.b, reflectance.b);
    EXPECT_TRUE(is_black(SmoothConductor{gold}.sample(direction_at(-0.6f), 0.5f, {}, TransportMode::Radiance).weight));
}

}  // namespace

}  // namespace etendue::test
