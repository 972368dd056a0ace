#include "film/splat_film.h"

#include "support/random.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kWidth = 40;
constexpr int kHeight = 30;
constexpr PixelRect kWhole{0, 0, kWidth, kHeight};

std::vector<std::vector<Splat>> random_splats(int lists, int each) {
    Random random(3);
    std::vector<std::vector<Splat>> result(static_cast<std::size_t>(lists));
    for (std::vector<Splat>& list : result)
        for (int i = 0; i < each; ++i)
            list.push_back({{random.next() * (kWidth + 4) - 2, random.next() * (kHeight + 4) - 2},
                            {random.next(), random.next() * 10.0f, 1e-3f * random.next()}});
    return result;
}

std::vector<float> image_of(const std::vector<std::vector<Splat>>& splats, const PixelRect& window,
                            const PixelFilter& filter, int threads) {
    SplatFilm film(kWidth, kHeight, window, filter);
    film.add(splats, 1000, ThreadPool(threads));
    std::vector<float> image(4 * window.area(), 0.0f);
    film.add_to(image, 4, window, SplatFilm::kBeauty);
    return image;
}

bool same_bytes(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(SplatFilm, ASplatIsSpreadByTheFilter) {
    const PixelFilter filter(FilterShape::Mitchell);
    const Vec2f at{20.3f, 14.8f};
    const std::vector<float> image = image_of({{{at, Rgb(2.0f)}}}, kWhole, filter, 1);
    double sum = 0.0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float expected = 2.0f * filter.evaluate(static_cast<float>(x) + 0.5f - at.x) *
                                   filter.evaluate(static_cast<float>(y) + 0.5f - at.y) * kWidth * kHeight / 1000.0f;
            const float value = image[4 * static_cast<std::size_t>(y * kWidth + x)];
            EXPECT_NEAR(value, expected, 1e-5f);
            sum += static_cast<double>(value);
        }
    EXPECT_NEAR(sum, 2.0 * kWidth * kHeight / 1000.0, 0.05);
}

TEST(SplatFilm, ASplatOnTheEdgeOfTwoBoxesFallsIntoOne) {
    const PixelFilter filter(FilterShape::Box);
    for (const Vec2f& at : {Vec2f{20.0f, 14.5f}, Vec2f{20.5f, 14.0f}, Vec2f{20.0f, 14.0f}, Vec2f{0.0f, 0.0f}}) {
        const std::vector<float> image = image_of({{{at, Rgb(1000.0f)}}}, kWhole, filter, 1);
        float sum = 0.0f;
        for (std::size_t i = 0; i < image.size(); i += 4) sum += image[i];
        EXPECT_FLOAT_EQ(sum, float(kWidth * kHeight));
        // Camera samples fill the pixel they fall into in the same way.
        const auto pixel = static_cast<std::size_t>(at.y) * kWidth + static_cast<std::size_t>(at.x);
        EXPECT_FLOAT_EQ(image[4 * pixel], float(kWidth * kHeight));
        EXPECT_TRUE(reaches(kWhole, filter, at));
    }
    EXPECT_FALSE(reaches(kWhole, filter, {float(kWidth), 3.5f}));
}

TEST(SplatFilm, ThreadsDoNotChangeABitAndACropIsThePartOfTheWhole) {
    const auto splats = random_splats(20, 300);
    const PixelFilter filter(FilterShape::BlackmanHarris);
    const std::vector<float> whole = image_of(splats, kWhole, filter, 1);
    for (const int threads : {2, 5}) EXPECT_TRUE(same_bytes(image_of(splats, kWhole, filter, threads), whole));
    const PixelRect crop{7, 11, 33, 28};
    const std::vector<float> part = image_of(splats, crop, filter, 2);
    for (int y = crop.y0; y < crop.y1; ++y)
        EXPECT_EQ(std::memcmp(&part[static_cast<std::size_t>(4 * (y - crop.y0) * crop.width())],
                              &whole[static_cast<std::size_t>(4 * (y * kWidth + crop.x0))],
                              static_cast<std::size_t>(4 * crop.width()) * sizeof(float)),
                  0);
}

TEST(SplatFilm, NothingIsLostOnTheEdgesOfBands) {
    // Filters end at whole and at half pixels, and so do bands.
    std::vector<std::vector<Splat>> splats(3);
    for (int i = -16; i < 4 * kHeight + 16; ++i)
        splats[static_cast<std::size_t>(i + 16) % 3].push_back({{20.25f, 0.25f * static_cast<float>(i)}, Rgb(1.0f)});
    splats[1].push_back({{20.0f, std::numeric_limits<float>::quiet_NaN()}, Rgb(1.0f)});
    splats[1].push_back({{20.0f, -std::numeric_limits<float>::infinity()}, Rgb(1.0f)});
    for (const FilterShape shape : {FilterShape::Box, FilterShape::BlackmanHarris, FilterShape::Mitchell}) {
        const PixelFilter filter(shape);
        const std::vector<float> one = image_of(splats, kWhole, filter, 1);
        for (const int threads : {2, 3, 4, 7, 16})
            EXPECT_TRUE(same_bytes(one, image_of(splats, kWhole, filter, threads))) << threads;
    }
}

TEST(SplatFilm, ReachIsWhatSomePixelSees) {
    const PixelFilter filter(FilterShape::Gaussian, 2.0f);
    const PixelRect window{10, 10, 20, 20};
    EXPECT_TRUE(reaches(window, filter, {15, 15}));
    EXPECT_TRUE(reaches(window, filter, {8.6f, 15}));
    EXPECT_FALSE(reaches(window, filter, {8.4f, 15}));
    EXPECT_TRUE(reaches(window, filter, {15, 21.4f}));
    EXPECT_FALSE(reaches(window, filter, {15, 21.6f}));
}

}  // namespace

}  // namespace etendue::test
