// No bias: adaptive renders with many seeds against uniform ones. The means of blocks of pixels are compared by their
// spread from seed to seed, with about 45 degrees of freedom: |z| > 5 comes once in 100,000 blocks by chance, of the 12
// blocks and the whole image once in 8,000 tests with other seeds. The seeds are fixed; ETENDUE_ADAPTIVE_SEEDS in the
// environment takes more of them, to see how small a bias could be.
#include "film/error_estimate.h"
#include "render/render.h"
#include "render/render_test_scene.h"
#include "support/z_test.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kAdaptiveWidth = 32;
constexpr int kAdaptiveHeight = 24;
constexpr int kBlock = 8;
constexpr double kLargestZ = 5.0;

/// Of every block, and of the whole image at the end, over red, green and blue.
std::vector<double> block_means(const std::vector<float>& image) {
    constexpr std::size_t kColumns = kAdaptiveWidth / kBlock;
    constexpr std::size_t kBlocks = kColumns * kAdaptiveHeight / kBlock;
    std::vector<double> means(kBlocks + 1, 0.0);
    for (std::size_t p = 0; p < std::size_t{kAdaptiveWidth} * kAdaptiveHeight; ++p) {
        const std::size_t block = p / kAdaptiveWidth / kBlock * kColumns + p % kAdaptiveWidth / kBlock;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto value = static_cast<double>(image[4 * p + c]) / 3.0;
            means[block] += value / (kBlock * kBlock);
            means.back() += value / (kAdaptiveWidth * kAdaptiveHeight);
        }
    }
    return means;
}

using OneRender = std::function<std::vector<float>(std::uint32_t seed)>;

/// Means of blocks over renders with `seeds` seeds from `first` on, and their variances.
std::vector<Estimate> estimate_blocks(const OneRender& one, std::uint32_t first, std::uint32_t seeds) {
    std::vector<std::vector<double>> renders;
    for (std::uint32_t seed = first; seed < first + seeds; ++seed) renders.push_back(block_means(one(seed)));
    std::vector<Estimate> blocks(renders.front().size());
    const auto count = static_cast<double>(seeds);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        for (const auto& means : renders) blocks[b].mean += means[b] / count;
        for (const auto& means : renders)
            blocks[b].variance += std::pow(means[b] - blocks[b].mean, 2.0) / (count * (count - 1.0));
    }
    return blocks;
}

struct WorstBlock {
    double z = 0.0;
    double difference = 0.0;      ///< of the whole image's mean, relative
    double relative_error = 0.0;  ///< standard error of that
};

WorstBlock compare(const std::vector<Estimate>& a, const std::vector<Estimate>& b) {
    WorstBlock worst;
    for (std::size_t i = 0; i < a.size(); ++i) worst.z = std::max(worst.z, std::abs(z_test(a[i], b[i]).z));
    worst.difference = a.back().mean / b.back().mean - 1.0;
    worst.relative_error = std::sqrt(a.back().variance + b.back().variance) / b.back().mean;
    return worst;
}

class AdaptiveAgreement : public testing::TestWithParam<std::string> {
  protected:
    /// Of adaptive renders; uniform ones, of more samples, are half as many.
    [[nodiscard]] static std::uint32_t seed_count() {
        const char* const wanted = std::getenv("ETENDUE_ADAPTIVE_SEEDS");
        return wanted == nullptr ? 32 : static_cast<std::uint32_t>(std::clamp(std::atoi(wanted), 8, 100'000));
    }

    [[nodiscard]] std::vector<Estimate> reference() const {
        return estimate_blocks(
            [&](std::uint32_t seed) {
                RenderOptions options = options_for(kAdaptiveWidth, kAdaptiveHeight, 256);
                options.seed = seed;
                return render_now(world_, GetParam().c_str(), options, 2).film.resolve();
            },
            100'000, seed_count() / 2);
    }

    /// As `render` does it.
    [[nodiscard]] std::vector<float> adaptive(std::uint32_t seed) {
        RenderOptions options = options_for(kAdaptiveWidth, kAdaptiveHeight, 2048);
        options.relative_error = 0.06;
        options.adaptive = true;
        options.seed = seed;
        RenderState state{.film = make_film(options)};
        state.every_other_pass = make_film(options);
        const std::atomic<bool> never{false};
        const RenderResult result = render(world_, *integrator_, options, pool_, never, {}, {}, std::move(state));
        samples_ += result.counters.samples;
        if (!result.adaptive.is_uniform()) most_ = std::max(most_, std::ranges::max(result.adaptive.samples));
        return result.film.resolve();
    }

    /// Two samples, then more only for those pixels whose own samples have shown an error.
    [[nodiscard]] std::vector<float> naive(std::uint32_t seed) const {
        const StopPredicate never = [] { return false; };
        RenderOptions options = options_for(kAdaptiveWidth, kAdaptiveHeight, 1);
        options.seed = seed;
        RenderState state{.film = make_film(options)};
        state.every_other_pass = make_film(options);
        ProgressiveRender rendering(world_, *integrator_, options, pool_, std::move(state));
        for (int pass = 0; pass < 2; ++pass) rendering.add_samples(1, never);
        for (int pass = 0; pass < 30; ++pass) {
            const ErrorEstimate errors =
                estimate_errors(rendering.state().film, *rendering.state().every_other_pass, ThreadPool(2));
            std::vector<std::uint8_t> is_active;
            for (const float error : errors.eye) is_active.push_back(error > 0.01f);
            if (std::ranges::find(is_active, 1) == is_active.end()) break;
            rendering.add_samples_to(std::move(is_active), 2, never);
        }
        return rendering.state().film.resolve();
    }

    const World world_ = compile(busy_scene(kAdaptiveWidth, kAdaptiveHeight));
    const ThreadPool pool_{2};
    const std::unique_ptr<const Integrator> integrator_ = make_integrator(GetParam(), {});
    std::uint64_t samples_ = 0;  ///< of all adaptive renders
    std::uint32_t most_ = 0;     ///< of a pixel
};

TEST_P(AdaptiveAgreement, OfManySeedsWithAUniformReference) {
    const std::uint32_t seeds = seed_count();
    const std::vector<Estimate> right = reference();
    const WorstBlock worst =
        compare(estimate_blocks([&](std::uint32_t seed) { return adaptive(seed); }, 1, seeds), right);
    EXPECT_LT(worst.z, kLargestZ);
    EXPECT_LT(worst.relative_error, 0.002) << "what it can see";
    EXPECT_GE(most_, 2 * samples_ / (seeds * kAdaptiveWidth * kAdaptiveHeight)) << "there was something to choose";
    RecordProperty("z", std::to_string(worst.z));
    RecordProperty("difference", std::to_string(worst.difference));
    RecordProperty("relative_error", std::to_string(worst.relative_error));
    std::printf("largest |z| %.2f; whole image %+.4f%%, standard error %.4f%%\n", worst.z, 100.0 * worst.difference,
                100.0 * worst.relative_error);
    const WorstBlock found = compare(
        estimate_blocks([&](std::uint32_t seed) { return naive(seed); }, 1, std::min(seeds + seeds / 2, 48u)), right);
    EXPECT_GT(found.z, 1.5 * kLargestZ) << "the bias of a naive rule";
    RecordProperty("naive_z", std::to_string(found.z));
}

INSTANTIATE_TEST_SUITE_P(Integrators, AdaptiveAgreement, testing::Values("path", "bdpt"),
                         [](const auto& test) { return test.param; });

}  // namespace

}  // namespace etendue::test
