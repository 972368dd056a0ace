#include "bsdf/gloss.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(Gloss, IsTheMirrorsShareOfWhatIsReflected) {
    MetallicRoughness plastic;
    plastic.base = Rgb(0.5f);
    plastic.metallic = 0.0f;
    plastic.alpha_x = plastic.alpha_y = 0.2f;
    plastic.f0 = Rgb(0.04f);
    // Straight on Schlick's term is f0, and the diffuse part gets what that leaves.
    EXPECT_NEAR(gloss_of(plastic, 1.0f).share, 0.8f * 0.04f / (0.04f + 0.5f * 0.96f), 1e-5f);
    EXPECT_EQ(gloss_of(plastic, 1.0f).alpha, 0.2f);
    EXPECT_NEAR(gloss_of(plastic, 0.0f).share, 0.8f, 1e-5f);

    MetallicRoughness metal = plastic;
    metal.metallic = 1.0f;
    EXPECT_NEAR(gloss_of(metal, 0.7f).share, 0.8f, 1e-5f);
    metal.alpha_y = 0.6f;
    EXPECT_NEAR(gloss_of(metal, 0.7f).share, 0.4f, 1e-5f);
    EXPECT_EQ(gloss_of(Bsdf(metal), 0.7f).alpha, 0.6f);
}

TEST(Gloss, OfConductorsIsAllButTheirRoughness) {
    RoughConductor metal;
    metal.alpha = 0.3f;
    EXPECT_NEAR(gloss_of(Bsdf(metal), 0.5f).share, 0.7f, 1e-6f);
    EXPECT_EQ(gloss_of(Bsdf(metal), 0.5f).alpha, 0.3f);
}

TEST(Gloss, NothingDiffuseOrBlackOrADeltaHasAny) {
    EXPECT_EQ(gloss_of(Bsdf(Diffuse{Rgb(0.5f)}), 0.5f).share, 0.0f);
    MetallicRoughness black;
    black.base = black.f0 = Rgb(0.0f);
    black.metallic = 0.0f;
    black.f90 = 0.0f;
    EXPECT_EQ(gloss_of(black, 0.1f).share, 0.0f);
    MetallicRoughness mirror;
    mirror.alpha_x = mirror.alpha_y = 0.0f;
    EXPECT_EQ(gloss_of(mirror, 0.5f).share, 0.0f);
}

}  // namespace

}  // namespace etendue::test
