#include "film/median_of_means.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr std::size_t kBuckets = 5;

LayerLayout layout() {
    LayerLayout result;
    result.light = kBuckets;
    result.values = BucketLayers{kBuckets}.value_count();
    return result;
}
constexpr BucketLayers kLayers{kBuckets, 0, 0};

/// A film of one row, with samples put into their buckets as integrators do.
class Row {
  public:
    explicit Row(int width) : width_(width) { tile_.reset({0, 0, width, 1}, layout()); }

    void add(std::size_t pixel, std::uint32_t sample, const Rgb& value, float weight = 1.0f) {
        tile_.pixel(pixel).add(value, 1.0f, weight);
        LayerBuffer& layers = tile_.layers();
        const std::size_t bucket = kLayers.of(sample);
        layers.add_rgb(pixel, 3 * bucket, value, static_cast<double>(weight));
        layers.sums(pixel)[layout().value_sums() + bucket] += static_cast<double>(weight);
        layers.sums(pixel)[layout().value_sums() + kBuckets + bucket] += 1.0;
    }
    [[nodiscard]] Film film() const {
        Film result(width_, 1, {0, 0, width_, 1}, {0, 0, width_, 1}, layout());
        result.add(tile_);
        return result;
    }

  private:
    int width_;
    TileBuffer tile_;
};

TEST(Median, IsTheMiddle) {
    std::array<float, 5> odd{3.0f, 9.0f, 1.0f, 2.0f, 8.0f};
    EXPECT_EQ(median(odd), 3.0f);
    std::array<float, 4> even{3.0f, 9.0f, 1.0f, 2.0f};
    EXPECT_EQ(median(even), 2.5f);
    EXPECT_EQ(median({}), 0.0f);
}

TEST(MedianOfMeans, DoesNotShowAFireflyOfOneBucket) {
    Row row(1);
    for (std::uint32_t sample = 0; sample < 20; ++sample)
        row.add(0, sample, sample == 7 ? Rgb(1e6f) : Rgb(0.5f, 0.25f, 1.0f));
    const std::vector<float> image = median_of_means(row.film(), kLayers);
    EXPECT_EQ(image, (std::vector<float>{0.5f, 0.25f, 1.0f, 1.0f}));
    EXPECT_GT(row.film().resolve()[0], 1e4f);
}

TEST(MedianOfMeans, OfSplatsAndSamplesOfABucketTogether) {
    Row row(1);
    for (std::uint32_t sample = 0; sample < 10; ++sample) row.add(0, sample, Rgb(0.5f));
    Film film = row.film();
    // Two light paths in each bucket, and those of the third have left a firefly.
    std::vector<std::vector<Splat>> splats(1);
    for (std::uint32_t b = 0; b < kBuckets; ++b) {
        const Rgb value(b == 2 ? 1000.0f : 2.0f);
        splats[0].push_back({{0.5f, 0.5f}, value});
        splats[0].push_back({{0.5f, 0.5f}, value, static_cast<std::uint32_t>(SplatFilm::kFirstLayer + b)});
    }
    film.add_splats(splats, 10, PixelFilter(FilterShape::Box), ThreadPool(1));
    const std::vector<float> image = median_of_means(film, kLayers);
    EXPECT_NEAR(image[0], 0.5f + 2.0f / 2.0f, 1e-5f);
    EXPECT_GT(film.resolve()[0], 100.0f);
}

TEST(MedianOfMeans, DividesEachBucketByItsOwnWeight) {
    // Pixels with different numbers of samples, and weights of a filter with negative parts.
    Row row(3);
    for (std::uint32_t sample = 0; sample < 23; ++sample) row.add(0, sample, Rgb(0.7f), sample < 15 ? 1.5f : 0.5f);
    for (std::uint32_t sample = 0; sample < 3; ++sample) row.add(1, sample, Rgb(static_cast<float>(sample)));
    const std::vector<float> image = median_of_means(row.film(), kLayers);
    EXPECT_NEAR(image[0], 0.7f, 1e-6f);
    EXPECT_EQ(image[4], 1.0f);  // of the three buckets that have a sample
    EXPECT_EQ(image[8], 0.0f);
}

TEST(MedianOfMeans, IsBiasedWithFewSamplesAndComesToTheMeanWithMany) {
    // Exponentially distributed values have a mean of 1 and a median of ln 2.
    constexpr int kPixels = 4000;
    const auto mean_of_image = [](std::uint32_t spp) {
        Row row(kPixels);
        std::mt19937 random(1);
        std::exponential_distribution<float> value;
        for (std::uint32_t sample = 0; sample < spp; ++sample)
            for (std::size_t pixel = 0; pixel < kPixels; ++pixel) row.add(pixel, sample, Rgb(value(random)));
        const std::vector<float> image = median_of_means(row.film(), kLayers);
        double sum = 0.0;
        for (std::size_t i = 0; i < image.size(); i += 4) sum += static_cast<double>(image[i]);
        return sum / kPixels;
    };
    // Of five samples, the mean of the third smallest is 1/5 + 1/4 + 1/3.
    EXPECT_NEAR(mean_of_image(5), 1.0 / 5 + 1.0 / 4 + 1.0 / 3, 0.03);
    EXPECT_NEAR(mean_of_image(50), 1.0, 0.04);
    EXPECT_LT(mean_of_image(50), 0.99);
    EXPECT_NEAR(mean_of_image(500), 1.0, 0.005);
}

}  // namespace

}  // namespace etendue::test
