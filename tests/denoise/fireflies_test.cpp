// What is taken for a firefly, and what is not.
#include "denoise/fireflies.h"

#include "denoise/test_planes.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(Fireflies, AreBrightInOneHalfOnly) {
    const Planes truth = same_planes(40, 40, 3, [](int, int) { return 0.5f; });
    for (const float share : {0.5f, 0.3f}) {
        Halves light = noisy_halves(truth, 0.01f, 1, share);
        const double whole = 40.0 * 40.0 * 1.5;
        light.a.row(1, 20)[10] += 1000.0f;
        light.b.row(2, 0)[39] += 2000.0f;
        const Fireflies found = remove_fireflies(light);
        EXPECT_EQ(found.count, 2u);
        const double light_of_them = double(share) * 1000.0 + double(1.0f - share) * 2000.0;
        EXPECT_NEAR(found.light_share, light_of_them / (whole + light_of_them), 1e-3);
        EXPECT_NEAR(light.a.row(1, 20)[10], 0.5f, 0.05f);
        EXPECT_NEAR(light.b.row(2, 0)[39], 0.5f, 0.05f);
        EXPECT_LT(light.variance.row(1, 20)[10], 0.01f);
    }
}

TEST(Fireflies, LampsAndCausticsAreNone) {
    const Planes lamp = same_planes(40, 40, 3, [](int x, int y) { return x == 20 && y == 20 ? 5000.0f : 0.1f; });
    Halves light = noisy_halves(lamp, 0.01f, 2);
    light.a.row(0, 21)[20] += 1000.0f;  // its edge, which one sample has hit
    EXPECT_EQ(remove_fireflies(light).count, 0u);
    EXPECT_NEAR(light.a.row(0, 20)[20], 5000.0f, 1.0f);
}

TEST(Fireflies, SparseLightIsNone) {
    // One pixel in twenty of a half is hit, as with few samples of a small lamp.
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> uniform;
    const auto sparse = [&] {
        return same_planes(80, 80, 3, [&](int, int) { return uniform(generator) < 0.05f ? 10.0f : 0.0f; });
    };
    const Planes a = sparse();
    const Planes b = sparse();
    Halves light = make_halves(mean_of_all(a, b, 0.5f), a, 0.5f);
    EXPECT_EQ(remove_fireflies(light).count, 0u);
}

TEST(Fireflies, BlackImagesHaveNone) {
    const Planes black = same_planes(10, 10, 3, [](int, int) { return 0.0f; });
    Halves light = make_halves(black, black, 0.5f);
    EXPECT_EQ(remove_fireflies(light).count, 0u);
    EXPECT_EQ(remove_fireflies(light).light_share, 0.0);
}

}  // namespace

}  // namespace etendue::test
