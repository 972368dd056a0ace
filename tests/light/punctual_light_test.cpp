#include "light/punctual_light.h"

#include "light/light_checks.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(PointLight, IrradianceFallsWithTheSquareOfTheDistanceAndTheCosine) {
    const PointLight light{{1, 2, 3}, {12.0f, 6.0f, 3.0f}};
    for (const float distance : {0.5f, 1.0f, 4.0f})
        for (const float angle : {0.0f, 0.7f, 1.5f}) {
            const Vec3f point = light.position - Vec3f(0, distance, 0);
            const Vec3f normal(std::sin(angle), std::cos(angle), 0.0f);
            const double expected = 7.0 * std::cos(static_cast<double>(angle)) /
                                    (static_cast<double>(distance) * static_cast<double>(distance));
            EXPECT_NEAR(irradiance_samples(light, point, normal, 1, 1)[0], expected, 1e-4 * expected);
            const LightSample sample = light.sample(point, {0.5f, 0.5f});
            EXPECT_TRUE(sample.is_delta);
            EXPECT_NEAR(sample.distance, distance, 1e-6f);
            EXPECT_NEAR(sample.wi.y, 1.0f, 1e-6f);
            EXPECT_NEAR(sample.radiance.r / sample.radiance.b, 4.0f, 1e-5f);
        }
}

TEST(PointLight, AtTheLightItselfThereIsNoDirection) {
    const PointLight light{{1, 2, 3}, Rgb(5.0f)};
    EXPECT_TRUE(is_black(light.sample({1, 2, 3}, {0.5f, 0.5f}).radiance));
}

TEST(PointLight, PowerIsIntensityOverTheSphere) {
    const PointLight light{{0, 0, 0}, {1, 2, 3}};
    EXPECT_NEAR(light.power(10.0f), 2.0f * 4.0f * kPi, 1e-4f);
}

// KHR_lights_punctual: saturate((cos - cos(outer)) / (cos(inner) - cos(outer)))².
TEST(SpotLight, FallsOffBetweenTheConesAsTheExtensionRecommends) {
    const float inner = 0.3f;
    const float outer = 0.8f;
    const SpotLight light{{0, 5, 0}, {0, -1, 0}, Rgb(9.0f), std::cos(inner), std::cos(outer)};
    for (const float angle : {0.0f, 0.29f, 0.4f, 0.6f, 0.79f, 0.81f, 2.0f, 3.1f}) {
        const Vec3f out(std::sin(angle), -std::cos(angle), 0.0f);
        const LightSample sample = light.sample(light.position + out * 2.0f, {0.5f, 0.5f});
        const float ramp =
            std::clamp((std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), 0.0f, 1.0f);
        EXPECT_NEAR(sample.radiance.g, 9.0f / 4.0f * ramp * ramp, 1e-4f) << "angle " << angle;
    }
}

TEST(SpotLight, PowerIsTheIntegralOverTheCones) {
    for (const auto& [inner, outer] : {std::array{0.0f, 0.785f}, std::array{0.5f, 0.6f}, std::array{0.2f, 1.57f}}) {
        const SpotLight light{
            {0, 0, 0}, normalize(Vec3f(1, 2, -2)), {2.0f, 4.0f, 6.0f}, std::cos(inner), std::cos(outer)};
        const double numerical = integrate_directions(400, [&](const Vec3f& w) {
            return average(light.sample(light.position + w, {0.5f, 0.5f}).radiance);
        });
        EXPECT_NEAR(light.power(10.0f) / numerical, 1.0, 5e-3);
    }
}

TEST(DirectionalLight, IrradianceFollowsTheCosineOnly) {
    const DirectionalLight light{normalize(Vec3f(0, -1, -1)), Rgb(3.0f)};
    for (const Vec3f& point : {Vec3f(0.0f), Vec3f(100, -5, 3)}) {
        EXPECT_NEAR(irradiance_samples(light, point, {0, 1, 0}, 1, 1)[0], 3.0 / std::sqrt(2.0), 1e-5);
        EXPECT_NEAR(irradiance_samples(light, point, {0, -1, 0}, 1, 1)[0], 0.0, 1e-6);
        EXPECT_TRUE(std::isinf(light.sample(point, {0.5f, 0.5f}).distance));
    }
    EXPECT_NEAR(light.power(2.0f), 3.0f * kPi * 4.0f, 1e-4f);
}

}  // namespace

}  // namespace etendue::test
