#include "bsdf/layered_surface.h"

#include "bsdf/charlie.h"
#include "bsdf_settings.h"
#include "support/random.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

const MetallicRoughness kPaint{.base = {0.5f, 0.2f, 0.1f}, .metallic = 0.0f, .alpha_x = 0.4f, .alpha_y = 0.4f};

TEST(LayeredSurface, WithoutLayersIsItsBase) {
    const LayeredSurface bare = LayeredSurface::make(kPaint, {}, {});
    const Vec3f wo = direction_at(0.6f);
    for (const float cos_i : {0.1f, 0.5f, 0.9f}) {
        const BsdfValue expected = kPaint.evaluate(wo, direction_at(cos_i), TransportMode::Radiance);
        const BsdfValue value = bare.evaluate(wo, direction_at(cos_i), TransportMode::Radiance);
        EXPECT_NEAR(value.f_cos.r, expected.f_cos.r, 1e-5f);
        EXPECT_NEAR(value.pdf_solid_angle, expected.pdf_solid_angle, 1e-5f);
    }
}

TEST(LayeredSurface, ACoatAddsAHighlightAndDimsTheRest) {
    const LayeredSurface coated = LayeredSurface::make(kPaint, {}, ClearCoat{1.0f, 0.01f});
    const Vec3f wo = direction_at(0.7f);
    const Vec3f mirror = mirror_direction(wo);
    const Vec3f aside = normalize({0.1f, 0.6f, 0.5f});
    EXPECT_GT(coated.evaluate(wo, mirror, TransportMode::Radiance).f_cos.g,
              2.0f * kPaint.evaluate(wo, mirror, TransportMode::Radiance).f_cos.g);
    EXPECT_LT(coated.evaluate(wo, aside, TransportMode::Radiance).f_cos.r,
              kPaint.evaluate(wo, aside, TransportMode::Radiance).f_cos.r);
}

// The base's samples are the only ones near the coat's highlight that are many; they must count for the coat.
TEST(LayeredSurface, ABlackBaseLosesNothingOfItsCoat) {
    const MetallicRoughness black{
        .base = Rgb(0.0f), .metallic = 0.0f, .alpha_x = 0.2f, .alpha_y = 0.2f, .f0 = Rgb(0.0f), .f90 = 0.0f};
    const ClearCoat coat{1.0f, 0.2f};
    const LayeredSurface surface = LayeredSurface::make(black, {}, coat);
    for (const float cos_o : {0.2f, 0.9f}) {
        const Vec3f wo = direction_at(cos_o);
        Random random(5);
        double sum = 0.0;
        constexpr int kSamples = 40'000;
        for (int i = 0; i < kSamples; ++i) {
            const float u_lobe = random.next();
            sum +=
                static_cast<double>(surface.sample(wo, u_lobe, random.next_2d(), TransportMode::Importance).weight.g);
        }
        EXPECT_NEAR(sum / kSamples, 1.0 - static_cast<double>(coat.passed(cos_o)), 0.01) << "cos " << cos_o;
    }
}

// Beneath the layers nothing is absorbed: what they keep of what leaves stays inside.
TEST(LayeredSurface, InsideABodyLightIsNeitherMadeNorLost) {
    for (const float diffuse_transmission : {0.0f, 0.6f}) {
        DielectricBody body{.interface = SmoothDielectric{1.5f}, .interface_share = 0.0f};
        body.opaque = {.base = Rgb(1.0f),
                       .metallic = 0.0f,
                       .alpha_x = 1.0f,
                       .alpha_y = 1.0f,
                       .f0 = Rgb(0.0f),
                       .f90 = 0.0f,
                       .diffuse_transmission = diffuse_transmission,
                       .diffuse_transmission_color = Rgb(1.0f)};
        for (const LayeredSurface& surface : {LayeredSurface::make(body, Sheen{Rgb(1.0f), 1.0f}, {}),
                                              LayeredSurface::make(body, {}, ClearCoat{1.0f, 0.3f})})
            for (const float cos_o : {-0.9f, -0.3f}) {
                const Vec3f wo = direction_at(cos_o);
                Random random(5);
                double sum = 0.0;
                constexpr int kSamples = 40'000;
                for (int i = 0; i < kSamples; ++i) {
                    const float u_lobe = random.next();
                    const BsdfSample sample = surface.sample(wo, u_lobe, random.next_2d(), TransportMode::Importance);
                    sum += static_cast<double>(sample.weight.g);
                }
                EXPECT_NEAR(sum / kSamples, 1.0, 0.01) << "cos " << cos_o << ", " << diffuse_transmission;
            }
    }
}

TEST(Sheen, IsFiniteWhereRoundingTakesTheCosineAboveOne) {
    const float above_one = 1.0f + 3e-7f;
    const BsdfValue value = Sheen{Rgb(1.0f), 0.3f}.evaluate({0.0f, 0.0f, above_one}, {0.1f, 0.0f, 0.99f});
    EXPECT_TRUE(is_finite(value.f_cos));
}

// The base gets the light that the sheen does not reflect, also where the sheen's albedo begins to be held below one:
// at 87 degrees if the sheen is smooth.
TEST(Sheen, PassesWhatItDoesNotReflect) {
    for (const float alpha : {0.01f, 0.04f, 0.3f})
        for (float degrees = 84.0f; degrees < 89.6f; degrees += 0.125f) {
            const Sheen sheen{Rgb(1.0f), alpha};
            const float cos_o = std::cos(degrees * kPi / 180.0f);
            const Vec3f wo = direction_at(cos_o);
            constexpr int kSteps = 100;
            double reflected = 0.0;
            for (int i = 0; i < kSteps; ++i)
                for (int j = 0; j < kSteps; ++j) {
                    const float t = (static_cast<float>(i) + 0.5f) / kSteps;
                    const float z = t * t * t;
                    const float phi = kPi * (static_cast<float>(j) + 0.5f) / kSteps;
                    const float sine = std::sqrt(1.0f - z * z);
                    const BsdfValue value = sheen.evaluate(wo, {sine * std::cos(phi), sine * std::sin(phi), z});
                    reflected += static_cast<double>(value.f_cos.g * 3.0f * t * t) / kSteps * 2.0 *
                                 static_cast<double>(kPi) / kSteps;
                }
            EXPECT_NEAR(reflected, 1.0 - static_cast<double>(sheen.passed(cos_o)), 0.01) << degrees << ", " << alpha;
        }
}

// Every distribution of normals does: seen from above, the facets cover the surface once.
TEST(Sheen, FibresCoverTheSurfaceOnce) {
    for (const float alpha : {0.05f, 0.3f, 1.0f}) {
        const Charlie charlie{alpha};
        constexpr int kSteps = 100'000;
        double covered = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const double cos_half = (i + 0.5) / kSteps;
            covered += 2.0 * std::numbers::pi * static_cast<double>(charlie.d(static_cast<float>(cos_half))) * cos_half;
        }
        EXPECT_NEAR(covered / kSteps, 1.0, 1e-4) << alpha;
    }
}

TEST(LayeredSurface, ACoatReflectsAboutItsOwnNormal) {
    const Vec3f tilted = normalize({0.3f, -0.1f, 1.0f});
    const LayeredSurface coated = LayeredSurface::make(kPaint, {}, ClearCoat{1.0f, 0.0f, tilted});
    const Vec3f wo = direction_at(0.9f);
    Random random(1);
    int mirrored = 0;
    for (int i = 0; i < 500; ++i) {
        const float u_lobe = random.next();
        const BsdfSample s = coated.sample(wo, u_lobe, random.next_2d(), TransportMode::Radiance);
        if (!s.is_delta) continue;
        ++mirrored;
        const Vec3f half = normalize(wo + s.wi);
        EXPECT_NEAR(dot(half, tilted), 1.0f, 1e-5f);
    }
    EXPECT_GT(mirrored, 5);
}

// With the coat's normal beside the surface's, light walks weigh what eye walks do in the other direction.
TEST(LayeredSurface, ModesAreAdjointUnderATiltedCoat) {
    const Vec3f tilted = normalize({0.3f, 0.2f, 1.0f});
    const LayeredSurface coated = LayeredSurface::make(kPaint, Sheen{Rgb(0.3f), 0.3f}, ClearCoat{0.9f, 0.1f, tilted});
    Random random(2);
    for (int i = 0; i < 500; ++i) {
        Vec3f wo = direction_at(0.05f + 0.9f * random.next());
        wo = normalize({wo.x * 0.8f, wo.x * 0.6f, wo.z});
        const Vec3f wi = Sheen::sample(random.next_2d());
        if (wi.z < 0.01f) continue;
        const float eye = coated.evaluate(wo, wi, TransportMode::Radiance).f_cos.r / wi.z;
        const float light = coated.evaluate(wi, wo, TransportMode::Importance).f_cos.r / wo.z;
        EXPECT_NEAR(eye, light, 1e-3f * (eye + light) + 1e-6f);
    }
}

TEST(Sheen, WhatItPassesIsWhatItDoesNotReflect) {
    for (const float alpha : {0.05f, 0.3f, 1.0f}) {
        const Sheen sheen{Rgb(1.0f), alpha};
        for (const float cos_o : {0.1f, 0.4f, 0.9f}) {
            const Vec3f wo = direction_at(cos_o);
            double sum = 0.0;
            constexpr int kSamples = 65'536;
            Random random(3);
            for (int i = 0; i < kSamples; ++i) {
                const BsdfValue value = sheen.evaluate(wo, Sheen::sample(random.next_2d()));
                sum += static_cast<double>(value.f_cos.r / value.pdf_solid_angle);
            }
            EXPECT_NEAR(sum / kSamples, 1.0 - static_cast<double>(sheen.passed(cos_o)), 0.012)
                << "alpha " << alpha << ", cos " << cos_o;
        }
    }
}

}  // namespace

}  // namespace etendue::test
