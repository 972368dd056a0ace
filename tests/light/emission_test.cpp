// Rays that leave lights: they carry the light's power, and what they carry is what light samples say arrives.
#include "light/light.h"
#include "support/chi2.h"
#include "support/random.h"
#include "support/t_test.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

struct NamedLight {
    std::string name;
    Light light;
};

MeshLight mesh(bool two_sided, bool mirrored) {
    return {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{2, 1, 0}, {0, 0, 3}, {0, 2, 0}}},
            Rgb(3.0f, 1.0f, 2.0f),
            Rgb(3.0f, 1.0f, 2.0f),
            two_sided,
            mirrored,
            true,
            Vec3f(1e-6f)};
}

ShapeLight shape(ShapeKind kind, bool two_sided) {
    Mat4f to_world;
    to_world.setScale(Vec3f(0.6f));
    to_world[3][0] = 0.4f;
    return {ExactShape(kind, to_world), Rgb(3.0f, 1.0f, 2.0f), Rgb(3.0f, 1.0f, 2.0f), two_sided, true, Vec3f(1e-6f)};
}

std::vector<NamedLight> lights() {
    const Vec3f axis = normalize({0.3f, -1.0f, 0.5f});
    ImageF sky(16, 8, 3);
    for (std::size_t i = 0; i < sky.pixels.size(); ++i) sky.pixels[i] = static_cast<float>(i % 7) * 0.3f;
    return {{"point", PointLight{{1, 2, 3}, Rgb(2.0f)}},
            {"spot", SpotLight{{1, 2, 3}, axis, Rgb(2.0f), 0.9f, 0.6f}},
            {"hard spot", SpotLight{{1, 2, 3}, axis, Rgb(2.0f), 0.999f, 0.999f}},
            {"directional", DirectionalLight{axis, Rgb(0.5f)}},
            {"sun", SunLight(axis, Rgb(0.5f), 0.4f)},
            {"mesh", mesh(false, false)},
            {"mirrored mesh", mesh(false, true)},
            {"two-sided mesh", mesh(true, false)},
            {"constant environment", ConstantEnvironment{Rgb(0.4f)}},
            {"image environment", ImageEnvironment(sky, 0.7f)},
            {"sphere", shape(ShapeKind::Sphere, false)},
            {"two-sided disk", shape(ShapeKind::Disk, true)},
            {"cylinder", shape(ShapeKind::Cylinder, false)}};
}

EmissionNumbers numbers(Random& random) {
    return {random.next_2d(), random.next_2d(), random.next_2d()};
}

const SceneSphere kScene{{1, 0, -2}, 4.0f};

TEST(Emission, RaysCarryThePowerOfTheLight) {
    const std::vector<NamedLight> all = lights();
    for (const auto& [name, light] : all) {
        Random random(4);
        std::vector<double> carried(40'000);
        for (double& value : carried)
            value = static_cast<double>(average(sample_emission(light, numbers(random), kScene).weight()));
        const double power = static_cast<double>(light_power(light, kScene.radius));
        const TTestResult result = t_test(carried, power, 2e-5 * power);
        EXPECT_GE(result.p_value, sidak_level(kFamilyLevel, all.size())) << name << ": " << result.str();
    }
}

// What falls on a small sphere around a point, estimated by rays from the light and by light samples at the point.
TEST(Emission, BringsToAPointWhatLightSamplesSayArrives) {
    constexpr int kRays = 400'000;
    constexpr float kRadius = 0.25f;
    const Vec3f point{1.3f, 0.9f, 0.8f};
    const std::vector<NamedLight> all = lights();
    for (const auto& [name, light] : all) {
        Random random(6);
        std::vector<double> by_rays;
        std::vector<double> by_samples;
        for (int i = 0; i < kRays; ++i) {
            const EmissionSample s = sample_emission(light, numbers(random), kScene);
            EXPECT_NEAR(length(s.direction), 1.0f, 1e-5f) << name;
            // Distance of the ray's line from the point, ahead of where it starts.
            const Vec3f to_point = point - s.position;
            const float along = dot(to_point, s.direction);
            const bool meets = along > 0.0f && length(to_point - s.direction * along) < kRadius;
            by_rays.push_back(meets ? static_cast<double>(average(s.weight())) : 0.0);
            const LightSample towards = sample_light(light, point, random.next_2d(), random.next_2d());
            const double irradiance = towards.is_delta ? static_cast<double>(average(towards.radiance))
                                      : towards.pdf_solid_angle > 0.0f
                                          ? static_cast<double>(average(towards.radiance) / towards.pdf_solid_angle)
                                          : 0.0;
            by_samples.push_back(irradiance * kPi * kRadius * kRadius);
        }
        double mean_of_samples = 0.0;
        for (const double v : by_samples) mean_of_samples += v / kRays;
        // The sphere is not a point: what comes from near by differs over it by some percent.
        const TTestResult result = t_test(by_rays, mean_of_samples, 0.06 * mean_of_samples);
        EXPECT_GE(result.p_value, sidak_level(kFamilyLevel, all.size())) << name << ": " << result.str();
    }
}

TEST(Emission, LightsAtInfinityStartOutsideOfTheSceneAndCoverIt) {
    for (const Light& light :
         {Light(DirectionalLight{normalize({1, -2, 0.5f}), Rgb(1.0f)}),
          Light(SunLight(normalize({1, -2, 0.5f}), Rgb(1.0f), 0.3f)), Light(ConstantEnvironment{Rgb(1.0f)})}) {
        Random random(8);
        float farthest = 0.0f;
        for (int i = 0; i < 2000; ++i) {
            const EmissionSample s = sample_emission(light, numbers(random), kScene);
            const Vec3f from_center = s.position - kScene.center;
            EXPECT_LT(dot(from_center, s.direction), -kScene.radius);
            const float across = length(from_center - s.direction * dot(from_center, s.direction));
            EXPECT_LE(across, kScene.radius * 1.0001f);
            farthest = std::max(farthest, across);
        }
        EXPECT_GT(farthest, 0.99f * kScene.radius);
    }
}

}  // namespace

}  // namespace etendue::test
