// The median of means of whole renders: buckets that add up to the image, and an error that shrinks.
#include "film/median_of_means.h"

#include "integrator/contributions/spelled_render.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

class MedianOfMeansRender : public testing::TestWithParam<std::string> {
  protected:
    AgreementCase room_ = agreement_case("CausticCrop");
    World world_ = agreement_world(room_);

    [[nodiscard]] RenderResult render(std::uint32_t spp, std::size_t buckets, std::uint32_t seed, int threads = 2) {
        AovSet aovs;
        aovs.buckets = {buckets, 0, 0};
        aovs.layout.light = buckets;
        aovs.layout.values = aovs.buckets.value_count();
        RenderOptions options = render_options(room_);
        options.spp = spp;
        options.seed = seed;
        if (buckets > 0) options.aovs = std::make_shared<AovSet>(aovs);
        const std::atomic<bool> stop{false};
        return etendue::render(world_, *make_integrator(GetParam(), {.lengths = room_.lengths}), options,
                               ThreadPool(threads), stop, {});
    }
};

TEST_P(MedianOfMeansRender, BucketsAddUpToTheImageWhichStaysAsItIs) {
    constexpr std::size_t kBuckets = 5;
    const Film film = render(13, kBuckets, 1).film;
    const std::vector<float> image = film.resolve();
    EXPECT_EQ(image, render(13, 0, 1).film.resolve());
    std::vector<double> sum(image.size() / 4 * 3, 0.0);
    for (std::size_t b = 0; b < kBuckets; ++b) {
        const std::vector<float> part = film.resolve_light(b);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(part[i]);
    }
    for (std::size_t i = 0; i < sum.size(); ++i)
        EXPECT_NEAR(sum[i], static_cast<double>(image[i / 3 * 4 + i % 3]), 1e-4 * (1.0 + sum[i]));
    // 13 samples: three in each of the first three buckets, two in the others.
    const std::vector<float> counts = film.resolve_values(kBuckets, kBuckets);
    for (std::size_t b = 0; b < kBuckets; ++b) EXPECT_FLOAT_EQ(counts[b] * 13.0f, b < 3 ? 3.0f : 2.0f);
}

TEST_P(MedianOfMeansRender, IsTheSameForEveryNumberOfThreads) {
    const BucketLayers buckets{5, 0, 0};
    EXPECT_EQ(median_of_means(render(10, 5, 1, 1).film, buckets), median_of_means(render(10, 5, 1, 3).film, buckets));
}

TEST_P(MedianOfMeansRender, ComesToTheTruthWithMoreSamples) {
    constexpr std::size_t kBuckets = 3;
    const std::vector<float> truth = render(2048, 0, 99).film.resolve();
    const auto error = [&](std::uint32_t spp) {
        double sum = 0.0;
        const std::vector<float> image = median_of_means(render(spp, kBuckets, 7).film, {kBuckets, 0, 0});
        for (std::size_t i = 0; i < truth.size(); ++i) sum += std::abs(static_cast<double>(image[i] - truth[i]));
        return sum;
    };
    const double few = error(6);
    const double more = error(48);
    EXPECT_LT(more, 0.6 * few);
    EXPECT_LT(error(384), 0.6 * more);
}

INSTANTIATE_TEST_SUITE_P(Integrators, MedianOfMeansRender, testing::Values("path", "light", "bdpt", "vcm"),
                         [](const auto& each) { return each.param; });

}  // namespace

}  // namespace etendue::test
