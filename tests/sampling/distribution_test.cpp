#include "sampling/distribution.h"

#include "core/wide.h"
#include "support/chi2.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

std::vector<std::vector<float>> function_lists() {
    std::vector<float> many(2048);
    Random random(1);
    for (float& weight : many) weight = random.next() < 0.3f ? 0.0f : std::pow(random.next(), 4.0f);
    // Nearly all intervals share an entry of the guide.
    std::vector<float> concentrated(300, 1e-5f);
    concentrated[150] = 1.0f;
    return {{2.0f},
            {1.0f, 1.0f},
            {0.0f, 1.0f, 0.0f, 0.0f, 3.0f, 0.0f},
            {0.0f, 0.0f, 1.0f},
            {1.0f, 0.0f, 0.0f},
            {1e-6f, 1.0f, 1e6f},
            many,
            concentrated};
}

constexpr float kLargest = 0x1.fffffep-1f;

TEST(Distribution1D, DensityIsTheNormalisedWeight) {
    for (const std::vector<float>& weights : function_lists()) {
        const Distribution1D distribution(weights);
        const auto count = static_cast<double>(weights.size());
        const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
        EXPECT_NEAR(distribution.integral(), total / count, 1e-9 * total);
        for (std::size_t i = 0; i < weights.size(); ++i) {
            const float x = (static_cast<float>(i) + 0.5f) / static_cast<float>(weights.size());
            const double expected = static_cast<double>(weights[i]) / total * count;
            EXPECT_NEAR(static_cast<double>(distribution.pdf(x)), expected, 1e-3 * expected + 2e-7 * count);
            EXPECT_TRUE(weights[i] > 0.0f || distribution.pdf(x) == 0.0f);
        }
    }
}

/// Returns the number that a distribution of some weights maps to a point: the share of the weights below it.
class ShareBelow {
  public:
    explicit ShareBelow(std::span<const float> weights) : sums_{0.0} {
        for (const float weight : weights) sums_.push_back(sums_.back() + static_cast<double>(weight));
    }
    [[nodiscard]] double operator()(float x) const {
        const std::size_t count = sums_.size() - 1;
        const double place = static_cast<double>(x) * static_cast<double>(count);
        const std::size_t index = std::min(static_cast<std::size_t>(place), count - 1);
        if (sums_.back() == 0.0) return static_cast<double>(x);
        return std::lerp(sums_[index], sums_[index + 1], place - static_cast<double>(index)) / sums_.back();
    }
    [[nodiscard]] double total() const { return sums_.back(); }

  private:
    std::vector<double> sums_;
};

TEST(Distribution1D, SamplesInvertAndHaveTheirDensity) {
    Random random(2);
    for (const std::vector<float>& weights : function_lists()) {
        const Distribution1D distribution(weights);
        const ShareBelow share_below(weights);
        for (int i = 0; i < 100'000; ++i) {
            const float u = i == 0 ? 0.0f : i == 1 ? kLargest : random.next();
            const Distribution1D::Sample sample = distribution.sample(u);
            ASSERT_GE(sample.x, 0.0f);
            ASSERT_LT(sample.x, 1.0f);
            ASSERT_LT(sample.index, weights.size());
            ASSERT_GT(weights[sample.index], 0.0f) << "an interval of zero weight was chosen for u = " << u;
            ASSERT_EQ(distribution.pdf(sample.x), sample.pdf) << "u = " << u << ", x = " << sample.x;
            // x has 24 bits, of which an interval among n keeps 24 - log2(n) for its inside.
            ASSERT_NEAR(share_below(sample.x), static_cast<double>(u), 1e-6 * (1.0 + static_cast<double>(sample.pdf)));
        }
    }
}

/// The interval by a search through the whole distribution function.
std::size_t searched_interval(const std::vector<float>& cdf, float u) {
    const auto above = std::upper_bound(cdf.begin() + 1, cdf.end() - 1, u);
    return static_cast<std::size_t>(above - cdf.begin()) - 1;
}

// Also where u lies on a border or next to one: of an interval, and of what shares an entry of the guide.
TEST(Distribution1D, TheGuideLeadsToTheIntervalOfASearch) {
    for (const std::vector<float>& weights : function_lists()) {
        const Distribution1D distribution(weights);
        std::vector<float> cdf{0.0f};
        double running = 0.0;
        const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
        for (const float weight : weights) {
            running += static_cast<double>(weight) / total;
            cdf.push_back(static_cast<float>(std::min(running, 1.0)));
        }
        std::vector<float> numbers = cdf;
        for (int i = 0; i < 4096; ++i) numbers.push_back(static_cast<float>(i) / 4096.0f);
        for (const float u : numbers)
            for (const float near : {std::nextafter(u, 0.0f), u, std::nextafter(u, 1.0f)})
                if (near < 1.0f) {
                    ASSERT_EQ(distribution.sample(near).index, searched_interval(cdf, near)) << "u = " << near;
                }
    }
}

TEST(Distribution1D, SamplesFollowTheDensity) {
    const auto lists = function_lists();
    for (const std::vector<float>& weights : lists) {
        if (weights.size() > 100) continue;
        const Distribution1D distribution(weights);
        // Four parts of each interval, so that the inside is tested too.
        std::vector<double> observed(4 * weights.size());
        std::vector<double> expected(4 * weights.size());
        constexpr int kSamples = 40'000;
        Random random(3);
        for (int i = 0; i < kSamples; ++i)
            observed[static_cast<std::size_t>(distribution.sample(random.next()).x *
                                              static_cast<float>(observed.size()))] += 1.0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const auto size = static_cast<float>(expected.size());
            expected[i] =
                static_cast<double>(distribution.pdf((static_cast<float>(i) + 0.5f) / size) / size) * kSamples;
        }
        const Chi2Result result = chi2_counts(observed, expected);
        EXPECT_GE(result.p_value, sidak_level(kFamilyLevel, lists.size())) << result.str();
    }
}

TEST(Distribution1D, AllZeroWeightsAreUniform) {
    const Distribution1D distribution(std::vector<float>(5, 0.0f));
    EXPECT_EQ(distribution.integral(), 0.0);
    EXPECT_NEAR(distribution.sample(0.37f).x, 0.37f, 1e-6f);
    EXPECT_NEAR(distribution.pdf(0.9f), 1.0f, 1e-6f);
}

struct Image {
    std::string name;
    std::vector<float> weights;
    int width;
    int height;
};

std::vector<Image> images() {
    Image sun{"one bright cell", std::vector<float>(24 * 12, 0.01f), 24, 12};
    sun.weights[5 * 24 + 7] = 100.0f;
    Image zeros{"empty rows and columns", std::vector<float>(16 * 8, 0.0f), 16, 8};
    for (int y = 2; y < 5; ++y)
        for (int x = 3; x < 14; x += 2)
            zeros.weights[static_cast<std::size_t>(y) * 16 + static_cast<std::size_t>(x)] = static_cast<float>(x + y);
    return {{"one cell", {3.0f}, 1, 1},
            {"one row", {1.0f, 0.0f, 2.0f}, 3, 1},
            {"one column", {1.0f, 0.0f, 2.0f}, 1, 3},
            sun,
            zeros};
}

TEST(Distribution2D, SamplesInvertAndHaveTheirDensity) {
    for (const Image& image : images()) {
        SCOPED_TRACE(image.name);
        const Distribution2D distribution(image.weights, image.width, image.height);
        std::vector<ShareBelow> rows;
        std::vector<float> totals;
        for (int y = 0; y < image.height; ++y) {
            const auto width = static_cast<std::size_t>(image.width);
            rows.emplace_back(std::span(image.weights).subspan(static_cast<std::size_t>(y) * width, width));
            totals.push_back(static_cast<float>(rows.back().total()));
        }
        const ShareBelow marginal(totals);
        Random random(4);
        for (int i = 0; i < 20'000; ++i) {
            const Vec2f u = random.next_2d();
            const Distribution2D::Sample sample = distribution.sample(u);
            ASSERT_GT(sample.pdf, 0.0f);
            ASSERT_EQ(distribution.pdf(sample.position), sample.pdf);
            const auto row = static_cast<std::size_t>(sample.position.y * static_cast<float>(image.height));
            const double tolerance = 1e-5 * (1.0 + static_cast<double>(sample.pdf));
            ASSERT_NEAR(rows[std::min(row, rows.size() - 1)](sample.position.x), static_cast<double>(u.x), tolerance);
            ASSERT_NEAR(marginal(sample.position.y), static_cast<double>(u.y), tolerance);
        }
    }
}

TEST(Distribution2D, ManySamplesAtOnceAreTheSame) {
    for (const Image& image : images()) {
        SCOPED_TRACE(image.name);
        const Distribution2D distribution(image.weights, image.width, image.height);
        Random random(6);
        for (const std::size_t count : {0u, 1u, 64u, 200u}) {
            std::vector<Vec2f> u(count);
            for (Vec2f& pair : u) pair = random.next_2d();
            std::vector<Distribution2D::Sample> samples(count);
            distribution.sample(u, samples);
            for (std::size_t i = 0; i < count; ++i) {
                const Distribution2D::Sample expected = distribution.sample(u[i]);
                ASSERT_EQ(samples[i].position, expected.position);
                ASSERT_EQ(samples[i].pdf, expected.pdf);
            }
        }
    }
}

TEST(Distribution2D, SamplesFollowTheImage) {
    const std::vector<Image> all = images();
    for (const Image& image : all) {
        SCOPED_TRACE(image.name);
        const Distribution2D distribution(image.weights, image.width, image.height);
        constexpr int kSamples = 100'000;
        std::vector<double> observed(image.weights.size());
        std::vector<double> expected(image.weights.size());
        Random random(5);
        for (int i = 0; i < kSamples; ++i) {
            const Vec2f p = distribution.sample(random.next_2d()).position;
            const auto x = static_cast<std::size_t>(p.x * static_cast<float>(image.width));
            const auto y = static_cast<std::size_t>(p.y * static_cast<float>(image.height));
            observed[y * static_cast<std::size_t>(image.width) + x] += 1.0;
        }
        const double total = std::accumulate(image.weights.begin(), image.weights.end(), 0.0);
        double mass = 0.0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            expected[i] = static_cast<double>(image.weights[i]) / total * kSamples;
            const auto x = static_cast<float>(i % static_cast<std::size_t>(image.width));
            const std::size_t row = i / static_cast<std::size_t>(image.width);
            const auto y = static_cast<float>(row);
            mass += static_cast<double>(distribution.pdf(
                {(x + 0.5f) / static_cast<float>(image.width), (y + 0.5f) / static_cast<float>(image.height)}));
        }
        const Chi2Result result = chi2_counts(observed, expected);
        EXPECT_GE(result.p_value, sidak_level(kFamilyLevel, all.size())) << result.str();
        EXPECT_NEAR(mass / static_cast<double>(image.weights.size()), 1.0, 1e-4) << "the density's integral";
        EXPECT_NEAR(distribution.integral(), total / static_cast<double>(image.weights.size()), 1e-5 * total);
    }
}

// The harness's own adapter on a density with jumps: its cells need not be those of the image.
TEST(Distribution2D, PassesTheAdaptiveHarness) {
    const Image image = images()[3];
    const Distribution2D distribution(image.weights, image.width, image.height);
    const auto sampler = [&](Random& random) -> std::optional<Point> {
        const Vec2f p = distribution.sample(random.next_2d()).position;
        return Point{static_cast<double>(p.x), static_cast<double>(p.y)};
    };
    const auto density = [&](double x, double y) {
        return static_cast<double>(distribution.pdf({static_cast<float>(x), static_cast<float>(y)}));
    };
    const SamplerCheck check = check_rect_sampler({}, sampler, density);
    EXPECT_GE(check.chi2.p_value, kFamilyLevel) << check.chi2.str();
}

TEST(Distribution2D, KeepsStratification) {
    const Image image = images()[3];
    const Distribution2D distribution(image.weights, image.width, image.height);
    // Increasing numbers give increasing positions.
    float previous = -1.0f;
    for (int i = 0; i < 1000; ++i) {
        const float y = distribution.sample({0.5f, (static_cast<float>(i) + 0.5f) / 1000.0f}).position.y;
        EXPECT_GT(y, previous);
        previous = y;
    }
}

TEST(Distribution2D, CountsItsBytes) {
    // 4 bytes a value of a distribution function, which has one more than there are intervals, and the same for the
    // guide's, which begins with one for four intervals. As many values as any processor compares at once stand behind
    // them.
    constexpr std::size_t kBehind = Wide::kMostLanes;
    const Distribution2D distribution(std::vector<float>(12, 1.0f), 4, 3);
    EXPECT_EQ(distribution.bytes(), 3u * (5u + 2u + kBehind) * 4u + (4u + 2u + kBehind) * 4u);
    const Distribution2D wide(std::vector<float>(2048, 1.0f), 1024, 2);
    EXPECT_EQ(wide.bytes(), 2u * (1025u + 257u + kBehind) * 4u + (3u + 2u + kBehind) * 4u);
}

}  // namespace

}  // namespace etendue::test
