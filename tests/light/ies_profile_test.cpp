#include "light/ies_profile.h"

#include "light/light_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

Vec3f towards(float theta, float phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), -std::cos(theta)};
}

/// Value 100 h + v at the vertical angle v and the horizontal angle h of the table, of which the last is the first.
IesProfile numbered() {
    return {{0.5f, 1.0f, 2.0f}, {0.0f, 1.0f, 3.0f, 2.0f * kPi}, {0, 1, 2, 100, 101, 102, 200, 201, 202, 0, 1, 2}};
}

TEST(IesProfile, HasTheValuesOfTheTable) {
    const IesProfile profile = numbered();
    constexpr std::array kVertical{0.5f, 1.0f, 2.0f};
    constexpr std::array kHorizontal{0.0f, 1.0f, 3.0f};
    for (std::size_t h = 0; h < 3; ++h)
        for (std::size_t v = 0; v < 3; ++v) {
            // Rounding must not push the outermost beyond the table.
            const float theta = kVertical[v] + (v == 0 ? 1e-6f : v == 2 ? -1e-6f : 0.0f);
            EXPECT_NEAR(profile.candela(towards(theta, kHorizontal[h])),
                        100.0f * static_cast<float>(h) + static_cast<float>(v), 1e-3f);
        }
}

TEST(IesProfile, IsBilinearBetweenThemAndAroundTheCircle) {
    const IesProfile profile = numbered();
    EXPECT_NEAR(profile.candela(towards(0.75f, 0.0f)), 0.5f, 1e-3f);
    EXPECT_NEAR(profile.candela(towards(1.25f, 0.5f)), 51.25f, 1e-3f);
    EXPECT_NEAR(profile.candela(towards(1.0f, 2.0f)), 151.0f, 1e-3f);
    const float beyond = 3.0f + 0.25f * (2.0f * kPi - 3.0f);
    EXPECT_NEAR(profile.candela(towards(1.0f, beyond)), 151.0f, 1e-2f);
}

TEST(IesProfile, IsDarkBeyondItsVerticalAngles) {
    const IesProfile profile({0.5f, 1.0f}, {0.0f, 2.0f * kPi}, {5, 5, 5, 5});
    for (const float theta : {0.0f, 0.49f, 1.01f, kPi}) EXPECT_EQ(profile.candela(towards(theta, 1.0f)), 0.0f) << theta;
    EXPECT_EQ(profile.candela(towards(0.75f, -3.0f)), 5.0f);
}

TEST(IesProfile, IsDefinedAtThePoles) {
    const IesProfile profile({0.0f, kPi}, {0.0f, kPi, 2.0f * kPi}, {1, 9, 1, 9, 1, 9});
    EXPECT_EQ(profile.candela({0, 0, -1}), 1.0f);
    EXPECT_NEAR(profile.candela({0, 0, 1}), 9.0f, 1e-5f);
    EXPECT_EQ(profile.candela({-0.0f, -0.0f, -1}), 1.0f);
}

TEST(IesProfile, MeanIsOverTheHorizontalAngles) {
    const IesProfile profile = numbered();
    for (const float theta : {0.6f, 1.0f, 1.7f}) {
        double sum = 0.0;
        constexpr int kSteps = 20'000;
        for (int i = 0; i < kSteps; ++i)
            sum += static_cast<double>(
                profile.candela(towards(theta, 2.0f * kPi * (static_cast<float>(i) + 0.5f) / kSteps)));
        EXPECT_NEAR(profile.mean_candela(static_cast<double>(theta)), sum / kSteps, 1e-2);
    }
    EXPECT_EQ(profile.mean_candela(0.4), 0.0);
    EXPECT_EQ(profile.mean_candela(2.1), 0.0);
}

// For angles that are even, crowded at one end, or random: the place found must be that of the angle.
TEST(AngleTable, FindsTheIntervalOfEveryAngle) {
    Random random(5);
    std::vector<std::vector<float>> tables = {{0.0f, kPi}, {0.25f, 0.26f}};
    for (const float power : {1.0f, 4.0f, 0.25f}) {
        tables.emplace_back();
        for (int i = 0; i <= 90; ++i)
            tables.back().push_back(2.0f * kPi * std::pow(static_cast<float>(i) / 90.0f, power));
    }
    tables.emplace_back(200);
    std::ranges::generate(tables.back(), [&] { return random.next(); });
    std::ranges::sort(tables.back());
    for (const std::vector<float>& angles : tables) {
        const AngleTable table(angles);
        const auto check = [&](float angle) {
            const AngleTable::Place place = table.find(angle);
            ASSERT_LT(place.index + 1, angles.size());
            EXPECT_TRUE(place.fraction >= 0.0f && place.fraction <= 1.0f) << angle;
            EXPECT_NEAR(std::lerp(angles[place.index], angles[place.index + 1], place.fraction), angle, 2e-6f);
        };
        for (const float angle : angles) check(angle);
        for (int i = 0; i < 2000; ++i) check(std::lerp(angles.front(), angles.back(), random.next()));
        EXPECT_EQ(table.find(angles.front() - 1.0f).index, 0u);
        EXPECT_EQ(table.find(angles.back() + 1.0f).fraction, 1.0f);
    }
}

}  // namespace

}  // namespace etendue::test
