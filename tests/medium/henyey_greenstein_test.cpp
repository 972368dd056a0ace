#include "medium/henyey_greenstein.h"

#include "support/chi2.h"
#include "support/random.h"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(HenyeyGreenstein, SamplesFollowTheStatedDensity) {
    const std::vector<float> anisotropies{-0.9f, -0.3f, 0.0f, 5e-4f, 0.5f, 0.95f};
    const Vec3f wo = normalize({0.3f, -0.5f, 0.8f});
    const double level = sidak_level(kFamilyLevel, anisotropies.size());
    std::uint32_t seed = 0;
    for (const float g : anisotropies) {
        const HenyeyGreenstein phase{g};
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> { return phase.sample(wo, random.next_2d()); };
        const auto density = [&](const Vec3f& wi) { return static_cast<double>(phase.pdf_solid_angle(wo, wi)); };
        const SamplerCheck check = check_sphere_sampler(sampler, density, {.samples = 50'000, .seed = ++seed});
        EXPECT_GE(check.chi2.p_value, level) << "g = " << g << ": " << check.chi2.str();
        EXPECT_NEAR(check.pdf_integral, 1.0, 2e-3) << "g = " << g;
    }
}

TEST(HenyeyGreenstein, ItsMeanCosineIsG) {
    Random random(2);
    const Vec3f wo{0.0f, 0.0f, 1.0f};
    for (const float g : {-0.7f, 0.0f, 0.6f}) {
        double sum = 0.0;
        constexpr int kSamples = 40'000;
        for (int i = 0; i < kSamples; ++i)
            sum -= static_cast<double>(dot(wo, HenyeyGreenstein{g}.sample(wo, random.next_2d())));
        // Five standard errors of a number in [-1, 1].
        EXPECT_NEAR(sum / kSamples, static_cast<double>(g), 5.0 / std::sqrt(static_cast<double>(kSamples)));
    }
}

TEST(HenyeyGreenstein, IsReciprocal) {
    Random random(3);
    const HenyeyGreenstein phase{0.4f};
    for (int i = 0; i < 100; ++i) {
        const Vec3f a = phase.sample({1.0f, 0.0f, 0.0f}, random.next_2d());
        const Vec3f b = phase.sample({0.0f, 1.0f, 0.0f}, random.next_2d());
        EXPECT_FLOAT_EQ(phase.pdf_solid_angle(a, b), phase.pdf_solid_angle(b, a));
    }
}

}  // namespace

}  // namespace etendue::test
