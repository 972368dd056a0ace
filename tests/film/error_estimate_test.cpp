#include "film/error_estimate.h"

#include "film/film.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

const ThreadPool kErrorThreads(2);

constexpr int kSide = 100;

/// Adds `count` samples, evenly distributed over [0, 2) times the pixel's brightness, to every pixel of each film.
void add_samples(int count, std::mt19937& random, std::initializer_list<Film*> films) {
    TileBuffer tile;
    tile.reset({0, 0, kSide, kSide});
    std::uniform_real_distribution<float> uniform(0.0f, 2.0f);
    for (std::size_t i = 0; i < tile.rect().area(); ++i) {
        const float brightness = 0.1f + 0.01f * static_cast<float>(i % kSide);
        for (int n = 0; n < count; ++n)
            tile.pixel(i).add(
                {brightness * uniform(random), brightness * uniform(random), brightness * uniform(random)}, 1.0f, 1.0f);
    }
    for (Film* film : films) film->add(tile);
}

/// The square of ε for an image of columns that have these means over the channels: a row of blocks is all rows.
double dark_square(const std::vector<double>& columns) {
    constexpr std::size_t kBlock = 8;
    double roots = 0.0;
    int blocks = 0;
    for (std::size_t x0 = 0; x0 < columns.size(); x0 += kBlock, ++blocks) {
        const auto first = columns.begin() + static_cast<std::ptrdiff_t>(x0);
        const std::size_t count = std::min(kBlock, columns.size() - x0);
        const auto last = first + static_cast<std::ptrdiff_t>(count);
        roots += std::sqrt(std::accumulate(first, last, 0.0) / static_cast<double>(count));
    }
    return std::pow(0.5 * std::pow(roots / blocks, 2.0), 2.0);
}

/// Of the columns that add_samples fills.
double brightness_of(std::size_t column) {
    return static_cast<double>(0.1f + 0.01f * static_cast<float>(column));
}

// Three channels of 10,000 pixels: the estimate's standard deviation is about 1% of it, so that 5% are left once in
// more than a million seeds; the seed is fixed.
TEST(ErrorEstimate, IsTheErrorThatTheImageHas) {
    std::mt19937 random(11);
    Film whole(kSide, kSide, {0, 0, kSide, kSide});
    Film part = whole;
    add_samples(30, random, {&whole, &part});
    add_samples(20, random, {&whole});
    const std::vector<float> image = whole.resolve();
    std::vector<double> columns;
    for (std::size_t x = 0; x < kSide; ++x) columns.push_back(brightness_of(x));
    const double dark = dark_square(columns);
    double sum = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (i % 4 == 3) continue;
        const double truth = columns[i / 4 % kSide];
        sum += std::pow(static_cast<double>(image[i]) - truth, 2.0) / (truth * truth + dark);
    }
    const double error = std::sqrt(sum / (3.0 * kSide * kSide));
    EXPECT_NEAR(estimate_errors(whole, part, kErrorThreads).relative_error(), error, 0.05 * error);
}

/// Adds one light path for each pixel, all of which fall evenly on the whole film, red only.
void add_light(float brightness, std::mt19937& random, std::initializer_list<Film*> films) {
    const PixelFilter filter(FilterShape::Box);
    const ThreadPool pool(1);
    std::uniform_real_distribution<float> uniform(0.0f, static_cast<float>(kSide));
    std::vector<Splat> splats;
    splats.reserve(kSide * kSide);
    for (int i = 0; i < kSide * kSide; ++i)
        splats.push_back({{uniform(random), uniform(random)}, Rgb(brightness, 0.0f, 0.0f)});
    const std::vector<std::vector<Splat>> lists{splats};
    for (Film* film : films) film->add_splats(lists, splats.size(), filter, pool);
}

// Pixels have different shares of their samples in the part, and the light paths another: 10,000 pixels again. Five
// deviations are 5% of three channels and 7% of the red one, which alone has light.
TEST(ErrorEstimate, HasAShareForEveryPixelAndOneForLightPaths) {
    std::mt19937 random(12);
    Film whole(kSide, kSide, {0, 0, kSide, kSide});
    Film part = whole;
    add_samples(20, random, {&whole, &part});
    add_samples(20, random, {&whole});
    // More for the left half, all of them in the part.
    TileBuffer more;
    more.reset({0, 0, kSide, kSide});
    std::uniform_real_distribution<float> uniform(0.0f, 2.0f);
    std::vector<std::uint32_t> left;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        if (i % kSide >= kSide / 2) continue;
        left.push_back(i);
        const float brightness = 0.1f + 0.01f * static_cast<float>(i % kSide);
        for (int n = 0; n < 40; ++n)
            more.pixel(i).add(
                {brightness * uniform(random), brightness * uniform(random), brightness * uniform(random)}, 1.0f, 1.0f);
    }
    whole.add(more, left);
    part.add(more, left);
    EXPECT_EQ(part.sample_count(0, 0), 60u);
    EXPECT_EQ(whole.sample_count(kSide - 1, 0), 40u);
    constexpr float kLight = 0.2f;
    for (int n = 0; n < 15; ++n) add_light(kLight, random, {&whole, &part});
    for (int n = 0; n < 45; ++n) add_light(kLight, random, {&whole});
    EXPECT_EQ(whole.light_paths(), 60u * kSide * kSide);

    std::vector<double> columns;
    for (std::size_t x = 0; x < kSide; ++x) columns.push_back(brightness_of(x) + static_cast<double>(kLight) / 3.0);
    const double dark = dark_square(columns);
    double eye = 0.0;
    double light = 0.0;
    for (int x = 0; x < kSide; ++x) {
        const double own = brightness_of(static_cast<std::size_t>(x));
        const double variance = own * own / 3.0 / (x < kSide / 2 ? 80.0 : 40.0);
        const double red = own + static_cast<double>(kLight);
        eye += variance * (1.0 / (red * red + dark) + 2.0 / (own * own + dark)) / 3.0 / kSide;
        // Poisson: 60 splats fall into a pixel, each of kLight / 60.
        light += static_cast<double>(kLight * kLight) / 60.0 / (red * red + dark) / 3.0 / kSide;
    }
    const ErrorEstimate errors = estimate_errors(whole, part, kErrorThreads);
    EXPECT_NEAR(errors.eye_mean, eye, 0.05 * eye);
    EXPECT_NEAR(errors.light, light, 0.07 * light);
    EXPECT_DOUBLE_EQ(errors.relative_error(), std::sqrt(errors.eye_mean + errors.light));

    // What the part would be with half of everything says the same.
    const Film half = whole.as_half(part);
    const std::vector<float> image = whole.resolve();
    const std::vector<float> off = half.resolve();
    double squares = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (i % 4 == 3) continue;
        const auto value = static_cast<double>(image[i]);
        squares += std::pow(static_cast<double>(off[i]) - value, 2.0) / (value * value + dark);
    }
    EXPECT_NEAR(squares / (3.0 * kSide * kSide), eye + light, 0.05 * (eye + light));
}

/// A film whose pixels have `count` samples of these values each.
Film even_film(int width, int height, const std::vector<Rgb>& values, int count) {
    Film film(width, height, {0, 0, width, height});
    TileBuffer tile;
    tile.reset({0, 0, width, height});
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int n = 0; n < count; ++n) tile.pixel(i).add(values[i], 1.0f, 1.0f);
    film.add(tile);
    return film;
}

// By the rule of three: the scale is 1.5, ε half of that.
TEST(ErrorEstimate, IsNotNothingWhereAllSamplesWereEqual) {
    const std::vector<Rgb> values{Rgb(3.0f), Rgb(0.0f)};
    const ErrorEstimate errors =
        estimate_errors(even_film(2, 1, values, 50), even_film(2, 1, values, 20), kErrorThreads);
    const double missed = 3.0 * std::pow(1.5 / 50.0, 2.0);
    EXPECT_NEAR(errors.eye[0], missed / (9.0 + 0.5625), 1e-8);
    EXPECT_NEAR(errors.eye[1], missed / 0.5625, 1e-8);
    EXPECT_NEAR(errors.relative_error(), std::sqrt(0.5 * (missed / 9.5625 + missed / 0.5625)), 1e-8);
    EXPECT_EQ(estimate_errors(even_film(2, 1, values, 50), even_film(2, 1, values, 50), kErrorThreads).relative_error(),
              0.0)
        << "nothing to compare";
}

TEST(ErrorEstimate, OfABlackImageFallsAsNoiseDoes) {
    const std::vector<Rgb> values(6);
    EXPECT_NEAR(
        estimate_errors(even_film(3, 2, values, 25), even_film(3, 2, values, 12), kErrorThreads).relative_error(), 0.2,
        1e-7);
    EXPECT_NEAR(
        estimate_errors(even_film(3, 2, values, 2500), even_film(3, 2, values, 999), kErrorThreads).relative_error(),
        0.02, 1e-8);
}

// One of 100 samples has found light, one of 64 pixels: the image is likely to be all of that off.
TEST(ErrorEstimate, IsNotMeasuredByASampleThatIsAloneInFindingLight) {
    std::vector<Rgb> values(64);
    const Film part = even_film(8, 8, values, 50);
    Film whole = even_film(8, 8, values, 99);
    values[9] = Rgb(100.0f);
    whole.add(even_film(8, 8, values, 1));
    EXPECT_GE(estimate_errors(whole, part, kErrorThreads).relative_error(), 1.0);
}

TEST(ImageScale, IsThatOfMostOfWhatIsNotBlack) {
    constexpr int kWidth = 64;
    constexpr int kHeight = 32;
    std::vector<Rgb> values(kWidth * kHeight);
    EXPECT_EQ(image_scale(even_film(kWidth, kHeight, values, 1), kErrorThreads), 0.0);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (i % kWidth >= 32) values[i] = Rgb(0.1f, 0.2f, 0.3f);
    EXPECT_NEAR(image_scale(even_film(kWidth, kHeight, values, 3), kErrorThreads), 0.2, 1e-7) << "and a black half";
    values[40] = Rgb(20.0f);  // one of 16 blocks is 2.5 times as bright
    EXPECT_NEAR(image_scale(even_film(kWidth, kHeight, values, 1), kErrorThreads),
                0.2 * std::pow(1.0 + (std::sqrt(2.547) - 1.0) / 16.0, 2.0), 1e-4);
}

TEST(ErrorEstimate, IsTheSameWhateverTheUnitOfLight) {
    const auto estimate = [](float unit) {
        std::mt19937 random(13);
        std::uniform_real_distribution<float> uniform(0.0f, 2.0f);
        const auto values = [&] {
            std::vector<Rgb> drawn(17 * 9);
            for (Rgb& value : drawn) value = Rgb(unit * uniform(random), unit * uniform(random), 0.0f);
            return drawn;
        };
        Film whole = even_film(17, 9, values(), 10);
        const Film part = whole;
        whole.add(even_film(17, 9, values(), 13));
        return estimate_errors(whole, part, kErrorThreads);
    };
    const ErrorEstimate one = estimate(1.0f);
    for (const float unit : {0.5f, 2.0f, 0x1p-30f, 0x1p31f}) {
        EXPECT_EQ(estimate(unit).relative_error(), one.relative_error()) << unit;
        EXPECT_EQ(estimate(unit).eye, one.eye) << unit;
    }
    EXPECT_NEAR(estimate(1e-3f).relative_error(), one.relative_error(), 1e-6);
}

}  // namespace

}  // namespace etendue
