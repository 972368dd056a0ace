#include "bsdf/widening.h"

#include "bsdf/ggx.h"

#include <cmath>
#include <variant>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(Widening, AddsTwiceTheVarianceToTheSquare) {
    EXPECT_FLOAT_EQ(widened_alpha(0.3f, 0.08f), 0.5f);
    EXPECT_FLOAT_EQ(widened_alpha(0.0f, 0.02f), 0.2f);
    EXPECT_EQ(widened_alpha(0.25f, 0.0f), 0.25f);
    EXPECT_EQ(widened_alpha(0.9f, 3.0f), 1.0f);
}

TEST(Widening, MakesMirrorsAndGlassRough) {
    const Vec2f variance(0.02f, 0.005f);
    const Bsdf metal = widened(SmoothConductor{}, variance);
    EXPECT_FLOAT_EQ(std::get<RoughConductor>(metal).alpha, std::sqrt(0.025f));
    const Bsdf glass = widened(SmoothDielectric{.ior = 1.4f, .tint = Rgb(0.3f)}, variance);
    EXPECT_FLOAT_EQ(std::get<RoughDielectric>(glass).alpha_x, 0.2f);
    EXPECT_FLOAT_EQ(std::get<RoughDielectric>(glass).alpha_y, 0.1f);
    EXPECT_EQ(std::get<RoughDielectric>(glass).ior, 1.4f);
    EXPECT_EQ(std::get<RoughDielectric>(glass).tint, Rgb(0.3f));
    EXPECT_FLOAT_EQ(std::get<RoughConductor>(widened(RoughConductor{{}, 0.3f}, {0.08f, 0.08f})).alpha, 0.5f);
    EXPECT_FLOAT_EQ(std::get<RoughDielectric>(widened(RoughDielectric::make(1.5f, 0.3f), {0.08f, 0.0f})).alpha_x, 0.5f);
}

TEST(Widening, LeavesWhatItDoesNotChange) {
    constexpr float kTiny = 1e-8f;
    EXPECT_TRUE(std::holds_alternative<SmoothConductor>(widened(SmoothConductor{}, {kTiny, kTiny})));
    EXPECT_TRUE(std::holds_alternative<SmoothDielectric>(widened(SmoothDielectric{}, {kTiny, kTiny})));
    EXPECT_EQ(std::get<Diffuse>(widened(Diffuse{Rgb(0.4f)}, {0.1f, 0.1f})).albedo, Rgb(0.4f));
}

}  // namespace

}  // namespace etendue::test
