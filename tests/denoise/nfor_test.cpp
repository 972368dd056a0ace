// The whole filter on images whose noise is known.
#include "denoise/nfor.h"

#include "denoise/test_planes.h"
#include "denoise/unusable_pixels.h"

#include <atomic>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

const ThreadPool kThreads(2);
const NforSettings kNforSettings;

Planes denoised(const Halves& light, const std::vector<Halves>& features, const ThreadPool& threads = kThreads) {
    const PreparedFeatures prepared =
        prepare_features(features, light.a.width(), light.a.height(), kNforSettings, threads);
    return denoise_nfor(light, prepared, kNforSettings, threads);
}

/// How many times less the mean squared error is than that of the mean of both halves.
double gain(const Halves& light, const Planes& result, const Planes& truth) {
    return mean_squared_difference(mean_of_all(light.a, light.b, light.share), truth) /
           mean_squared_difference(result, truth);
}

TEST(Nfor, ConstantPlusNoiseBecomesConstant) {
    const Planes truth = same_planes(64, 64, 3, [](int, int) { return 0.5f; });
    for (const float share : {0.5f, 0.3f}) {
        const Halves light = noisy_halves(truth, 0.1f, 1, share);
        EXPECT_GT(gain(light, denoised(light, {}), truth), 50.0) << share;
    }
}

TEST(Nfor, DoesTheSameToBrightAndToDimImages) {
    const Planes truth = same_planes(48, 48, 3, [](int x, int) { return x < 24 ? 0.5f : 0.1f; });
    const Halves light = noisy_halves(truth, 0.05f, 2);
    const Planes result = denoised(light, {});
    for (const float scale : {0x1p-12f, 0x1p12f}) {
        const auto scaled = [scale](const Planes& planes, float factor) {
            return make_planes(planes.width(), planes.height(), planes.count(),
                               [&](int plane, int x, int y) { return factor * scale * planes.row(plane, y)[x]; });
        };
        const Halves other{light.share, scaled(light.a, 1.0f), scaled(light.b, 1.0f), scaled(light.variance, scale)};
        EXPECT_LT(largest_difference(denoised(other, {}), scaled(result, 1.0f)), 1e-4 * double(scale)) << scale;
    }
}

TEST(Nfor, EdgesOfFeaturesAreKept) {
    // Stripes of 3 pixels, whose contrast is a third of the noise: only the feature shows where they are.
    const Planes stripes = same_planes(64, 64, 3, [](int x, int) { return x / 3 % 2 == 0 ? 0.4f : 0.45f; });
    const Halves light = noisy_halves(stripes, 0.15f, 3);
    const Halves feature = noisy_halves(stripes, 0.0f, 4);
    const double with = gain(light, denoised(light, {feature}), stripes);
    const double without = gain(light, denoised(light, {}), stripes);
    EXPECT_GT(with, 40.0);
    EXPECT_LT(without, 0.9 * with) << "the test would not tell";
}

TEST(Nfor, EdgesOfLightAreKeptWithoutFeatures) {
    const Planes shadow = same_planes(64, 64, 3, [](int x, int y) { return x + y / 2 < 48 ? 1.0f : 0.1f; });
    const Halves light = noisy_halves(shadow, 0.05f, 5);
    EXPECT_GT(gain(light, denoised(light, {}), shadow), 8.0);
}

TEST(Nfor, IsTheSameForEveryNumberOfThreads) {
    const Planes truth = same_planes(70, 40, 3, [](int x, int y) { return float((x / 9 + y / 9) % 2); });
    const Halves light = noisy_halves(truth, 0.2f, 6);
    const Halves feature = noisy_halves(truth, 0.05f, 7);
    const Planes one = denoised(light, {feature}, ThreadPool(1));
    EXPECT_EQ(largest_difference(one, denoised(light, {feature}, ThreadPool(4))), 0.0);
}

TEST(Nfor, FilledPixelsBecomeLikeTheirNeighbours) {
    const Planes truth = same_planes(48, 48, 3, [](int, int) { return 0.5f; });
    const Halves light = noisy_halves(truth, 0.05f, 8);
    Planes whole = mean_of_all(light.a, light.b, light.share);
    Planes half = light.a;
    for (int i = 0; i < 5; ++i) whole.row(i % 3, 10 + 5 * i)[20] = std::numeric_limits<float>::quiet_NaN();
    ASSERT_EQ(fill_unusable(whole, half), 5u);
    const Planes result = denoised(make_halves(whole, half, light.share), {});
    EXPECT_LT(largest_difference(result, truth), 0.05);
}

TEST(Nfor, LightDoesNotBecomeNegative) {
    // Steps that sparse light hides, so that lines are fitted across them; no value is negative.
    std::mt19937 generator(9);
    std::uniform_real_distribution<float> uniform;
    const auto half = [&] {
        return same_planes(64, 64, 3, [&](int x, int y) {
            const float truth = x < 32 || y < 32 ? 0.02f : 1.0f;
            return uniform(generator) < 0.1f ? 10.0f * truth : 0.0f;
        });
    };
    const Planes a = half();
    const Planes b = half();
    const Halves ramp = noisy_halves(same_planes(64, 64, 1, [](int x, int y) { return float(x * y); }), 0.0f, 1);
    const Planes result = denoised(make_halves(mean_of_all(a, b, 0.5f), a, 0.5f), {ramp});
    for (int plane = 0; plane < 3; ++plane)
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) EXPECT_GE(result.row(plane, y)[x], 0.0f);
}

TEST(Nfor, ALampDoesNotShineIntoItsWall) {
    // A lamp a thousand times brighter than its wall, with edges in which samples fall on either side.
    const Planes truth = same_planes(64, 64, 3, [](int x, int y) {
        const int distance = std::max(std::abs(x - 32), std::abs(y - 32));
        return distance < 3 ? 500.0f : distance == 3 ? 250.0f : 0.5f;
    });
    Halves light = noisy_halves(truth, 0.05f, 13);
    for (int plane = 0; plane < 3; ++plane)
        for (int i = 29; i <= 35; ++i) light.a.row(plane, 29)[i] += i % 2 == 0 ? 150.0f : -150.0f;
    light = make_halves(mean_of_all(light.a, light.b, light.share), light.a, light.share);
    const Planes result = denoised(light, {});
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            if (std::max(std::abs(x - 32), std::abs(y - 32)) <= 4) continue;
            EXPECT_NEAR(result.row(0, y)[x], 0.5f, 0.2f) << x << " " << y;
        }
}

/// The mean of ((value - truth) / (truth + 0.1))² over the pixels that are not in the lamp of the tests below.
double relative_error_of_walls(const Planes& planes, const Planes& truth) {
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < planes.height(); ++y)
        for (int x = 0; x < planes.width(); ++x) {
            const auto r = double(truth.row(0, y)[x]);
            if (r > 100.0) continue;
            const double relative = (double(planes.row(0, y)[x]) - r) / (r + 0.1);
            sum += relative * relative;
            ++count;
        }
    return sum / count;
}

TEST(Nfor, ALampThatOneHalfHasMissedIsNotSpread) {
    // A little lamp, far brighter than all else. Samples of one half alone fall into the pixels of its edge, so that
    // patches of the other half do not tell them from the wall.
    const Planes truth =
        same_planes(64, 64, 3, [](int x, int y) { return x >= 31 && x <= 33 && y >= 31 && y <= 33 ? 5000.0f : 0.5f; });
    Halves light = noisy_halves(truth, 0.2f, 14);
    for (int plane = 0; plane < 3; ++plane)
        for (int y = 31; y <= 33; ++y)
            for (int x = 31; x <= 33; ++x)
                if (x != 32 || y != 32) (((x + y) % 2 == 0) ? light.a : light.b).row(plane, y)[x] = 0.5f;
    light = make_halves(mean_of_all(light.a, light.b, light.share), light.a, light.share);
    const Planes input = mean_of_all(light.a, light.b, light.share);
    EXPECT_LT(relative_error_of_walls(denoised(light, {}), truth), relative_error_of_walls(input, truth));
}

TEST(Nfor, EmptyFeaturesAndNothingToDo) {
    const Planes black = same_planes(20, 20, 3, [](int, int) { return 0.0f; });
    const Halves light = noisy_halves(black, 0.0f, 11);
    EXPECT_EQ(largest_difference(denoised(light, {light}), black), 0.0);
}

TEST(Nfor, StopsWhenItIsAskedTo) {
    const std::atomic<bool> stop = true;
    const Planes truth = same_planes(20, 20, 3, [](int, int) { return 0.5f; });
    const Halves light = noisy_halves(truth, 0.1f, 12);
    const NforSettings settings{9, &stop};
    const PreparedFeatures prepared = prepare_features({light}, 20, 20, settings, kThreads);
    EXPECT_EQ(denoise_nfor(light, prepared, settings, kThreads).count(), 0);
}

}  // namespace

}  // namespace etendue::test
