// Weights from patches, against the formula evaluated the slow way.
#include "denoise/nl_means.h"

#include "denoise/test_planes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

const ThreadPool kOneThread(1);

/// The formula of WindowWeights, pixel by pixel.
double weight_of(const NlMeansGuide& guide, const NlMeansSettings& settings, int px, int py, int qx, int qy) {
    if (qx < 0 || qy < 0 || qx >= guide.image.width() || qy >= guide.image.height()) return 0.0;
    double sum = 0.0;
    for (int plane = 0; plane < guide.image.count(); ++plane)
        for (int dy = -settings.patch; dy <= settings.patch; ++dy)
            for (int dx = -settings.patch; dx <= settings.patch; ++dx) {
                const auto scale = double(guide.variance_scale);
                const double a = scale * double(guide.variance.row(plane, py + dy)[px + dx]);
                const double b = scale * double(guide.variance.row(plane, qy + dy)[qx + dx]);
                const double difference =
                    double(guide.image.row(plane, py + dy)[px + dx]) - double(guide.image.row(plane, qy + dy)[qx + dx]);
                const double k2 = double(settings.k) * double(settings.k);
                sum += (difference * difference - (a + std::min(a, b))) / (k2 * (a + b));
            }
    const int side = 2 * settings.patch + 1;
    return std::exp(-std::max(0.0, sum / (side * side * guide.image.count())));
}

TEST(NlMeans, WeightsAreThoseOfTheFormula) {
    const Planes truth = same_planes(45, 37, 3, [](int x, int y) { return 0.02f * float(x) + (y > 20 ? 0.3f : 0.0f); });
    const Halves halves = noisy_halves(truth, 0.1f, 3, 0.4f);
    const NlMeansGuide guide{halves.a, halves.variance, halves.variance_scale_a()};
    for (const NlMeansSettings settings : {NlMeansSettings{9, 3, 0.5f}, NlMeansSettings{4, 1, 1.0f}}) {
        WindowWeights weights(settings);
        weights.compute(guide, {32, 32, 45, 37});
        for (const auto& [x, y] : {std::pair{32, 32}, std::pair{44, 36}, std::pair{38, 33}})
            for (int dy = -settings.radius; dy <= settings.radius; ++dy)
                for (int dx = -settings.radius; dx <= settings.radius; ++dx) {
                    const int place = (dy + settings.radius) * weights.row_stride() + dx + settings.radius;
                    const float weight = weights.window(x, y)[static_cast<std::size_t>(place)];
                    EXPECT_NEAR(double(weight), weight_of(guide, settings, x, y, x + dx, y + dy), 1e-4)
                        << x << " " << y << " " << dx << " " << dy;
                }
    }
}

TEST(NlMeans, EqualPixelsWithoutVarianceAreAveraged) {
    const Planes zero = same_planes(20, 20, 1, [](int, int) { return 0.0f; });
    const Planes target = same_planes(20, 20, 1, [](int x, int) { return x % 2 == 0 ? 1.0f : 3.0f; });
    const Planes filtered = nl_means(target, {zero, zero}, {1, 3, 1.0f}, kOneThread);
    EXPECT_NEAR(filtered.row(0, 10)[10], (1.0f + 2.0f * 3.0f) / 3.0f, 1e-5f);
    EXPECT_NEAR(filtered.row(0, 0)[0], 2.0f, 1e-5f) << "only what lies in the image";
}

TEST(NlMeans, EdgesWithoutVarianceAreKeptExactly) {
    const Planes none = same_planes(40, 20, 1, [](int, int) { return 0.0f; });
    const Planes edge = same_planes(40, 20, 1, [](int x, int) { return x < 17 ? 0.25f : 0.5f; });
    EXPECT_EQ(largest_difference(nl_means(edge, {edge, none}, {5, 0, 1.0f}, kOneThread), edge), 0.0);
}

TEST(NlMeans, IsTheSameForEveryNumberOfThreads) {
    const Planes truth = same_planes(70, 50, 3, [](int x, int y) { return float((x / 8 + y / 8) % 2); });
    const Halves halves = noisy_halves(truth, 0.2f, 5);
    const NlMeansGuide guide{halves.b, halves.variance, halves.variance_scale_b()};
    const Planes one = nl_means(halves.a, guide, {5, 3, 0.5f}, kOneThread);
    const Planes four = nl_means(halves.a, guide, {5, 3, 0.5f}, ThreadPool(4));
    EXPECT_EQ(largest_difference(one, four), 0.0);
}

}  // namespace

}  // namespace etendue::test
