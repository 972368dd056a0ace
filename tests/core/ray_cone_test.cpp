#include "core/ray_cone.h"

#include "core/vec.h"

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(RayCone, GrowsByItsSpread) {
    const RayCone cone{0.1f, 0.02f};
    EXPECT_FLOAT_EQ(cone.width_at(0.0f), 0.1f);
    EXPECT_FLOAT_EQ(cone.width_at(5.0f), 0.2f);
}

TEST(RayCone, FlatMirrorsAndSheetsLeaveItAlone) {
    const RayCone cone{0.1f, 0.02f};
    EXPECT_EQ(reflect_cone(cone, 0.0f).spread, cone.spread);
    EXPECT_EQ(refract_cone(cone, 0.0f, 1.0f).spread, cone.spread);
    EXPECT_NEAR(refract_cone(cone, 3.0f, 1.0f).spread, cone.spread, 1e-6f);
    EXPECT_FLOAT_EQ(refract_cone(cone, 0.0f, 1.5f).spread, cone.spread / 1.5f);
}

// A concave mirror of radius R focuses parallel light at R/2, a convex one spreads it from as far behind.
TEST(RayCone, MirrorsFocusAtHalfTheirRadius) {
    constexpr float kRadius = 4.0f;
    const RayCone parallel{0.01f, 0.0f};
    EXPECT_NEAR(reflect_cone(parallel, -1.0f / kRadius).width_at(0.5f * kRadius), 0.0f, 1e-6f);
    EXPECT_NEAR(reflect_cone(parallel, 1.0f / kRadius).width_at(-0.5f * kRadius), 0.0f, 1e-6f);
}

// A surface of glass focuses parallel light in it at n R / (n - 1), and a ball of n = 2 on its far side.
TEST(RayCone, RefractionFocusesLikeALens) {
    constexpr float kRadius = 4.0f;
    const RayCone parallel{0.01f, 0.0f};
    for (const float n : {1.33f, 1.5f, 2.0f})
        EXPECT_NEAR(refract_cone(parallel, 1.0f / kRadius, n).width_at(n * kRadius / (n - 1.0f)), 0.0f, 1e-6f) << n;
}

// The share of a solid angle: a cone of that spread covers it.
TEST(RayCone, LobesSpreadByTheRootOfTheirSolidAngle) {
    const float pdf = 1e4f;
    const float spread = lobe_spread(pdf);
    EXPECT_NEAR(spread * spread, kConeLobeShare / pdf, 1e-9f);
    EXPECT_LT(lobe_spread(2.0f * pdf), spread);
}

TEST(RayCone, WideLobesAreClampedAndDiffuseOnesAlwaysAre) {
    EXPECT_EQ(lobe_spread(0.0f), kMaxConeSpread);
    EXPECT_EQ(lobe_spread(kInvPi), kMaxConeSpread);
    EXPECT_EQ(scatter_cone({0.1f, 0.15f}, 0.15f).spread, kMaxConeSpread);
    EXPECT_EQ(reflect_cone({0.1f, 0.0f}, 1e9f).spread, kMaxConeSpread);
    EXPECT_EQ(refract_cone({0.1f, 0.0f}, -1e9f, 1.5f).spread, kMaxConeSpread);
}

TEST(RayCone, ScatteringForgetsTheSign) {
    const RayCone cone = scatter_cone({-0.1f, -0.05f}, 0.01f);
    EXPECT_FLOAT_EQ(cone.width, 0.1f);
    EXPECT_FLOAT_EQ(cone.spread, 0.06f);
}

}  // namespace

}  // namespace etendue
