#include "light/light.h"

#include "support/chi2.h"

#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

std::vector<Light> mixed_lights() {
    std::vector<Light> lights;
    lights.emplace_back(PointLight{{0, 0, 0}, Rgb(1.0f)});
    lights.emplace_back(DirectionalLight{{0, -1, 0}, Rgb(0.5f)});
    lights.emplace_back(PointLight{{0, 0, 0}, Rgb(0.0f)});
    lights.emplace_back(ConstantEnvironment{Rgb(0.1f)});
    lights.emplace_back(
        MeshLight({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, Rgb(3.0f), Rgb(3.0f), true, false, true, Vec3f(0.0f)));
    return lights;
}

TEST(ChoiceByPower, ChoosesByPower) {
    const std::vector<Light> lights = mixed_lights();
    const float radius = 2.0f;
    const AliasTable selector = choice_by_power(lights, radius);
    double total = 0.0;
    for (const Light& light : lights) total += static_cast<double>(light_power(light, radius));
    constexpr int kSamples = 40'000;
    std::vector<double> expected;
    double sum = 0.0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto power = static_cast<double>(light_power(lights[i], radius));
        // One light of the list is dark.
        const double share = power > 0.0 ? 0.9 * power / total + 0.1 / static_cast<double>(lights.size() - 1) : 0.0;
        EXPECT_NEAR(selector.probability(i), share, 1e-6);
        sum += static_cast<double>(selector.probability(i));
        expected.push_back(share * kSamples);
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
    std::vector<double> observed(lights.size());
    Random random(8);
    for (int i = 0; i < kSamples; ++i) {
        const AliasTable::Choice choice = selector.sample(random.next_2d());
        EXPECT_EQ(choice.probability, selector.probability(choice.index));
        ++observed[choice.index];
    }
    const Chi2Result result = chi2_counts(observed, expected);
    EXPECT_GT(result.p_value, kFamilyLevel) << result.str();
    EXPECT_EQ(observed[2], 0.0) << "a light without power was chosen";
}

// The light of a lamp that is never chosen beside the sun would be missing, or come as fireflies.
TEST(ChoiceByPower, NoLightIsStarved) {
    const std::vector<Light> lights = {PointLight{{0, 0, 0}, Rgb(1e-6f)}, DirectionalLight{{0, -1, 0}, Rgb(1e5f)}};
    EXPECT_NEAR(choice_by_power(lights, 1000.0f).probability(0), 0.05f, 1e-4f);
}

TEST(ChoiceByPower, WithoutPowerAllAreEquallyLikely) {
    const std::vector<Light> lights = {PointLight{{0, 0, 0}, Rgb(0.0f)}, ConstantEnvironment{Rgb(0.0f)}};
    const AliasTable selector = choice_by_power(lights, 1.0f);
    EXPECT_FLOAT_EQ(selector.probability(0), 0.5f);
    EXPECT_FLOAT_EQ(selector.probability(1), 0.5f);
}

TEST(ChoiceByPower, IsEmptyWithoutLights) {
    EXPECT_TRUE(choice_by_power({}, 1.0f).empty());
}

TEST(Light, OnlyEnvironmentsShineFromInfinity) {
    for (const Light& light : mixed_lights()) {
        const bool environment = std::holds_alternative<ConstantEnvironment>(light);
        EXPECT_EQ(is_black(radiance_from_afar(light, {0, 1, 0})), !environment);
        EXPECT_EQ(pdf_solid_angle_from_afar(light, {0, 1, 0}) > 0.0f, environment);
    }
}

}  // namespace

}  // namespace etendue::test
