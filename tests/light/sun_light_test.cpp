#include "light/sun_light.h"

#include "core/frame.h"
#include "light/light_checks.h"
#include "support/chi2.h"
#include "support/t_test.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr float kAngles[] = {1e-5f, 2e-4f, 0.00918f, 0.12f, 1.0f, 3.0f};

// The same as that of parallel light, while no part of the disk is below the horizon.
TEST(SunLight, IrradianceIsThatOfAPointSun) {
    const Vec3f direction = normalize({0.3f, -1.0f, 0.2f});
    for (const float angle : kAngles) {
        const SunLight sun(direction, {3.0f, 6.0f, 9.0f}, angle);
        const auto expect = [&](const Vec3f& normal, double irradiance) {
            const std::vector<double> samples = irradiance_samples(sun, Vec3f(0.0f), normal, 20'000, 3);
            const TTestResult result = t_test(samples, irradiance, 2e-5 * irradiance);
            EXPECT_GE(result.p_value, sidak_level(kFamilyLevel, 2 * std::size(kAngles))) << angle << result.str();
        };
        expect(-direction, 6.0);
        if (angle < 2.0f) expect({0, 1, 0}, 6.0 * static_cast<double>(-direction.y));
    }
}

// Uniformly over the cap, on both ways.
TEST(SunLight, DirectionsFillTheDiskEvenly) {
    const Vec3f direction = normalize({0.3f, -1.0f, 0.2f});
    const float angle = 0.8f;
    const SunLight sun(direction, Rgb(1.0f), angle);
    const double cos_max = std::cos(0.5 * static_cast<double>(angle));
    const auto density = [&](const Vec3f& w) {
        return static_cast<double>(dot(w, direction)) >= cos_max ? 1.0 / (2.0 * 3.14159265358979 * (1.0 - cos_max))
                                                                 : 0.0;
    };
    const auto check = [&](const DirectionSampler& sampler) {
        const SamplerCheck result = check_sphere_sampler(sampler, density, {.tolerance = 1e-5, .least_levels = 4});
        EXPECT_GT(result.chi2.p_value, sidak_level(kFamilyLevel, 2)) << result.chi2.str();
        EXPECT_NEAR(result.pdf_integral, 1.0, 1e-2);
    };
    check([&](Random& random) -> std::optional<Vec3f> {
        const LightSample s = sun.sample({1, 2, 3}, random.next_2d());
        EXPECT_FALSE(s.is_delta);
        EXPECT_NEAR(s.pdf_solid_angle, density(-s.wi), 1e-3 * density(-s.wi));
        EXPECT_TRUE(std::isinf(s.distance));
        return -s.wi;
    });
    check([&](Random& random) -> std::optional<Vec3f> {
        return sun.sample_emission({random.next_2d(), random.next_2d(), random.next_2d()}, {}).direction;
    });
}

// What a ray meets within the disk is what its samples bring, over their density, and there is nothing beside it.
TEST(SunLight, RaysMeetTheRadianceOfItsSamples) {
    const Vec3f direction = normalize({0.3f, -1.0f, 0.2f});
    for (const float angle : kAngles) {
        const SunLight sun(direction, {3.0f, 6.0f, 9.0f}, angle);
        Random random(5);
        int met = 0;
        constexpr int kSamples = 1000;
        for (int i = 0; i < kSamples; ++i) {
            const LightSample s = sun.sample(Vec3f(0.0f), random.next_2d());
            // Rounding takes some from the rim of a small disk.
            met += sun.pdf_solid_angle(s.wi) == s.pdf_solid_angle && sun.radiance(s.wi) == s.radiance ? 1 : 0;
        }
        EXPECT_GT(met, 0.99 * kSamples) << angle;
        EXPECT_EQ(sun.radiance(-direction), sun.sample(Vec3f(0.0f), {0.5f, 0.5f}).radiance);
        const Vec3f beside = Frame::from_normal(-direction)
                                 .to_world({std::sin(0.55f * angle + 1e-3f), 0.0f, std::cos(0.55f * angle + 1e-3f)});
        EXPECT_TRUE(is_black(sun.radiance(beside))) << angle;
        EXPECT_EQ(sun.pdf_solid_angle(beside), 0.0f) << angle;
    }
}

}  // namespace

}  // namespace etendue::test
