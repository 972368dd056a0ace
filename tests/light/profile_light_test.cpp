#include "light/profile_light.h"

#include "light/light_checks.h"

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// f(theta) for every degree, the same all around.
std::shared_ptr<const IesProfile> axial(const std::function<float(float)>& f) {
    std::vector<float> vertical;
    std::vector<float> candela;
    for (int degree = 0; degree <= 180; ++degree) vertical.push_back(kPi * static_cast<float>(degree) / 180.0f);
    for (int plane = 0; plane < 2; ++plane)
        for (const float theta : vertical) candela.push_back(f(theta));
    return std::make_shared<const IesProfile>(vertical, std::vector{0.0f, 2.0f * kPi}, candela);
}

/// At (1, 2, 3), pointing down, with the horizontal angles from +X towards +Z... of the world.
ProfileLight hanging(std::shared_ptr<const IesProfile> profile) {
    ProfileLight light;
    light.lamp = PointLight{{1, 2, 3}, {2.0f, 1.0f, 0.5f}};
    light.frame = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    light.profile = std::move(profile);
    return light;
}

TEST(ProfileLight, IrradianceBelowALambertianLamp) {
    // cos(theta) candela, I0 = 1: on a floor at distance h, off by r, E = I0 h^2 / (h^2 + r^2)^2.
    const ProfileLight light = hanging(axial([](float theta) { return std::max(0.0f, std::cos(theta)); }));
    for (const float r : {0.0f, 0.7f, 3.0f}) {
        const double h = 2.0;
        const double expected = h * h / std::pow(h * h + static_cast<double>(r * r), 2.0) * (3.5 / 3.0);
        const Vec3f point = Vec3f(1, 0, 3) + Vec3f(0.6f, 0, 0.8f) * r;
        EXPECT_NEAR(irradiance_samples(light, point, {0, 1, 0}, 1, 1)[0], expected, 2e-4 * expected);
    }
    EXPECT_EQ(irradiance_samples(light, {1, 5, 3}, {0, -1, 0}, 1, 1)[0], 0.0) << "behind it";
}

TEST(ProfileLight, HorizontalAnglesTurnFromTheTangentToTheBitangent) {
    // Bright in the half plane of 90 degrees only.
    auto profile = std::make_shared<const IesProfile>(
        std::vector{0.0f, kPi}, std::vector{0.0f, kPi / 4.0f, kPi / 2.0f, 3.0f * kPi / 4.0f, 2.0f * kPi},
        std::vector<float>{0, 0, 0, 0, 8, 8, 0, 0, 0, 0});
    const ProfileLight light = hanging(std::move(profile));
    const auto seen_from = [&](const Vec3f& offset) {
        return light.sample(Vec3f(1, 2, 3) + offset, {0.5f, 0.5f}).radiance.g;
    };
    EXPECT_NEAR(seen_from({0, -1, -1}), 8.0f / 2.0f, 1e-4f);
    EXPECT_EQ(seen_from({0, -1, 1}), 0.0f);
    EXPECT_EQ(seen_from({-1, -1, 0}), 0.0f);
}

TEST(ProfileLight, PowerIsTheIntegralOverTheSphere) {
    const auto power = [](const std::function<float(float)>& f) { return hanging(axial(f)).power(1.0f); };
    const float mean = 3.5f / 3.0f;
    EXPECT_NEAR(power([](float) { return 3.0f; }), mean * 12.0f * kPi, 1e-3f);
    EXPECT_NEAR(power([](float theta) { return std::max(0.0f, std::cos(theta)); }), mean * kPi, 1e-3f);
    EXPECT_NEAR(power([](float theta) { return 1.0f + std::cos(theta); }), mean * 4.0f * kPi, 1e-3f);
}

TEST(ProfileLight, SpotsCutTheProfileWithTheirCone) {
    ProfileLight light = hanging(axial([](float theta) { return 2.0f + std::cos(theta); }));
    for (const float outer : {1.2f, 0.4f, 0.01f}) {
        const SpotLight spot{{1, 2, 3}, {0, -1, 0}, Rgb(3.0f), std::cos(0.5f * outer), std::cos(outer)};
        light.lamp = spot;
        for (const float angle : {0.0f, 0.3f, 0.7f, 0.99f, 1.01f}) {
            const Vec3f out(std::sin(angle * outer), -std::cos(angle * outer), 0.0f);
            const LightSample with = light.sample(spot.position + out, {0.5f, 0.5f});
            const LightSample without = spot.sample(spot.position + out, {0.5f, 0.5f});
            EXPECT_NEAR(with.radiance.r, without.radiance.r * (2.0f + std::cos(angle * outer)), 1e-3f);
        }
        const auto numerical = [&] {
            double sum = 0.0;
            constexpr int kSteps = 4000;
            for (int i = 0; i < kSteps; ++i) {
                const float theta = (static_cast<float>(i) + 0.5f) / kSteps * outer;
                sum += static_cast<double>((2.0f + std::cos(theta)) * spot.falloff(std::cos(theta)) * std::sin(theta));
            }
            return sum * static_cast<double>(outer) / kSteps * 2.0 * static_cast<double>(kPi) * 3.0;
        };
        EXPECT_NEAR(static_cast<double>(light.power(1.0f)) / numerical(), 1.0, 2e-3) << outer;
    }
}

}  // namespace

}  // namespace etendue::test
