// Numbers with six digits are printed by flip_reference.py, which computes FLIP in another way. Its matrices are exact,
// ours are rounded as the authors' are: that is 1e-5 of an error.
#include "metrics/flip.h"

#include "metrics/flip_color.h"
#include "metrics/flip_filters.h"
#include "metrics/pixel_selection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

const ThreadPool& threads() {
    static const ThreadPool pool(2);
    return pool;
}

ImageF filled(int width, int height, const Rgb& color) {
    ImageF image(width, height, 3);
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
        image.pixels[i] = color.r;
        image.pixels[i + 1] = color.g;
        image.pixels[i + 2] = color.b;
    }
    return image;
}

struct ImagePair {
    ImageF image;
    ImageF reference;
};

/// Stripes, a ramp and a pattern, and the same with noise, as flip_reference.py makes them.
ImagePair ldr_pair(int width, int height) {
    ImagePair pair{ImageF(width, height, 3), ImageF(width, height, 3)};
    std::uint32_t state = 12345;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double clean[] = {(x % 8 < 4 ? 0.8 : 0.1) * (y + 1) / height, static_cast<double>(x) / (width - 1),
                                    (x * 7 + y * 13) % 11 / 10.0};
            for (std::size_t c = 0; c < 3; ++c) {
                state = 1664525u * state + 1013904223u;
                const double noise = 0.5 * (static_cast<double>(state >> 8) / 16777216.0 - 0.5);
                pair.reference.pixel(x, y)[c] = static_cast<float>(clean[c]);
                pair.image.pixel(x, y)[c] = static_cast<float>(std::clamp(clean[c] + noise, 0.0, 1.0));
            }
        }
    }
    return pair;
}

ImagePair hdr_pair(int width, int height) {
    ImagePair pair = ldr_pair(width, height);
    for (ImageF* image : {&pair.image, &pair.reference})
        for (float& value : image->pixels) {
            const auto v = static_cast<double>(value);
            value = static_cast<float>(40.0 * v * v * v);
        }
    return pair;
}

double flip_of(const Rgb& a, const Rgb& b) {
    return mean_of(ldr_flip(filled(30, 20, a), filled(30, 20, b), kFlipPixelsPerDegree, threads()));
}

double sum(std::span<const float> weights) {
    return std::accumulate(weights.begin(), weights.end(), 0.0);
}

TEST(FlipFilters, AreNormalized) {
    for (const double ppd : {5.0, 20.0, kFlipPixelsPerDegree, 200.0}) {
        const ContrastFilters contrast = contrast_filters(ppd);
        EXPECT_NEAR(sum(contrast.luminance), 1.0, 1e-6) << ppd;
        EXPECT_NEAR(sum(contrast.red_green), 1.0, 1e-6) << ppd;
        EXPECT_NEAR(std::pow(sum(contrast.blue_narrow), 2.0) + std::pow(sum(contrast.blue_wide), 2.0), 1.0, 1e-6);
        const FeatureFilters feature = feature_filters(ppd);
        EXPECT_NEAR(sum(feature.gaussian), 1.0, 1e-6) << ppd;
        for (const FilterWeights* derivative : {&feature.edge, &feature.point}) {
            double positive = 0.0;
            for (const float weight : *derivative) positive += static_cast<double>(std::max(weight, 0.0f));
            EXPECT_NEAR(positive, 1.0, 1e-6) << ppd;
            EXPECT_NEAR(sum(*derivative), 0.0, 1e-6) << ppd;
        }
    }
}

TEST(FlipFilters, ReachThreeStandardDeviations) {
    EXPECT_EQ(contrast_filters(kFlipPixelsPerDegree).radius, 10) << "3 sqrt(0.04 / (2 pi^2)) 67.02 = 9.05";
    EXPECT_EQ(contrast_filters(kFlipPixelsPerDegree).luminance.size(), 21u);
    EXPECT_EQ(feature_filters(kFlipPixelsPerDegree).radius, 9) << "3 * 0.5 * 0.082 * 67.02 = 8.24";
    EXPECT_EQ(feature_filters(kFlipPixelsPerDegree).edge.size(), 19u);
}

TEST(FlipColor, OpponentSpaceIsLeftAsItWasEntered) {
    EXPECT_NEAR(opponent_of({1.0f, 1.0f, 1.0f}).y, 1.0f, 1e-6f);
    EXPECT_NEAR(opponent_of({0.3f, 0.3f, 0.3f}).cx, 0.0f, 1e-6f) << "grey has no chroma";
    EXPECT_NEAR(opponent_of({0.3f, 0.3f, 0.3f}).cz, 0.0f, 1e-6f);
    const Rgb color{0.2f, 0.7f, 0.4f};
    const Rgb back = linear_of(opponent_of(color));
    EXPECT_NEAR(back.r, color.r, 1e-5f);
    EXPECT_NEAR(back.g, color.g, 1e-5f);
    EXPECT_NEAR(back.b, color.b, 1e-5f);
}

TEST(FlipColor, LabIsThatOfCie) {
    const HuntLab white = hunt_lab({1.0f, 1.0f, 1.0f});
    EXPECT_NEAR(white.l, 100.0f, 1e-4f);
    EXPECT_NEAR(white.a, 0.0f, 1e-3f);
    EXPECT_NEAR(white.b, 0.0f, 1e-3f);
    // CIE L*a*b* of Rec.709's green under D65: 87.735, -86.183, 83.180; chroma times 0.87735.
    const HuntLab green = hunt_lab({0.0f, 1.0f, 0.0f});
    EXPECT_NEAR(green.l, 87.735f, 5e-3f);
    EXPECT_NEAR(green.a, -0.87735f * 86.183f, 1e-2f);
    EXPECT_NEAR(green.b, 0.87735f * 83.180f, 1e-2f);
}

TEST(FlipColor, ErrorsBendWhereDifferencesAreLarge) {
    const ColorError error;
    const HuntLab black{};
    // 41.276570 by exact matrices; by those of the authors, which are rounded, 41.2761.
    EXPECT_NEAR(error.largest(), 41.276570f, 1e-3f);
    EXPECT_NEAR(error(hunt_lab({0.0f, 1.0f, 0.0f}), hunt_lab({0.0f, 0.0f, 1.0f})), 1.0f, 1e-6f);
    EXPECT_EQ(error(black, black), 0.0f);
    // The knee: a compressed distance of 0.4 of the largest.
    const HuntLab knee{std::pow(0.4f * error.largest(), 1.0f / 0.7f), 0.0f, 0.0f};
    EXPECT_NEAR(error(black, knee), 0.95f, 1e-4f);
    const HuntLab half{std::pow(0.2f * error.largest(), 1.0f / 0.7f), 0.0f, 0.0f};
    EXPECT_NEAR(error(black, half), 0.475f, 1e-4f);
    EXPECT_NEAR(hyab({10.0f, 3.0f, 0.0f}, {30.0f, 0.0f, 4.0f}), 25.0f, 1e-5f) << "20 and the hypotenuse of 3 and 4";
}

TEST(LdrFlip, OfOneColorAgainstAnotherIsTheErrorOfTheColors) {
    EXPECT_NEAR(flip_of(Rgb(0.0f), Rgb(1.0f)), 0.967379, 2e-5);
    EXPECT_NEAR(flip_of({1.0f, 0.0f, 0.0f}, Rgb(0.0f)), 0.970497, 2e-5);
    EXPECT_NEAR(flip_of({1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}), 0.986661, 2e-5);
    EXPECT_NEAR(flip_of({0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}), 1.0, 2e-5);
    EXPECT_NEAR(flip_of(Rgb(0.18f), Rgb(0.2f)), 0.104365, 2e-4);
}

TEST(LdrFlip, IsZeroForEqualImagesAndSymmetric) {
    const ImagePair pair = ldr_pair(40, 30);
    const ImageF same = ldr_flip(pair.image, pair.image, kFlipPixelsPerDegree, threads());
    EXPECT_TRUE(std::ranges::all_of(same.pixels, [](float error) { return error == 0.0f; }));
    EXPECT_EQ(ldr_flip(pair.image, pair.reference, 20.0, threads()).pixels,
              ldr_flip(pair.reference, pair.image, 20.0, threads()).pixels);
}

TEST(LdrFlip, IsThatOfTheSlowProgram) {
    const ImagePair pair = ldr_pair(40, 30);
    const ImageF map = ldr_flip(pair.image, pair.reference, kFlipPixelsPerDegree, threads());
    EXPECT_NEAR(mean_of(map), 0.228000, 2e-5);
    EXPECT_NEAR(map.pixel(0, 0)[0], 0.468158f, 5e-5f);
    EXPECT_NEAR(map.pixel(7, 3)[0], 0.357012f, 5e-5f);
    EXPECT_NEAR(map.pixel(39, 29)[0], 0.157400f, 5e-5f);
    const ImageF near = ldr_flip(pair.image, pair.reference, 20.0, threads());
    EXPECT_NEAR(mean_of(near), 0.479616, 2e-5);
    EXPECT_NEAR(near.pixel(0, 0)[0], 0.355374f, 5e-5f);
    EXPECT_NEAR(near.pixel(7, 3)[0], 0.650166f, 5e-5f);
    EXPECT_NEAR(near.pixel(39, 29)[0], 0.336348f, 5e-5f);
}

TEST(LdrFlip, IsTheSameInAnyNumberOfPieces) {
    // Higher than a strip, so that strips meet.
    const ImagePair pair = ldr_pair(25, 130);
    const ThreadPool one(1);
    const ThreadPool five(5);
    const ImageF map = ldr_flip(pair.image, pair.reference, kFlipPixelsPerDegree, one);
    EXPECT_EQ(map.pixels, ldr_flip(pair.image, pair.reference, kFlipPixelsPerDegree, five).pixels);
    // A part that is farther from the cut than the filters reach.
    ImagePair part{ImageF(25, 70, 3), ImageF(25, 70, 3)};
    std::copy_n(pair.image.pixels.begin() + 25 * 60 * 3, 25 * 70 * 3, part.image.pixels.begin());
    std::copy_n(pair.reference.pixels.begin() + 25 * 60 * 3, 25 * 70 * 3, part.reference.pixels.begin());
    const ImageF part_map = ldr_flip(part.image, part.reference, kFlipPixelsPerDegree, one);
    for (int y = 10; y < 70; ++y)
        for (int x = 0; x < 25; ++x) EXPECT_EQ(part_map.pixel(x, y)[0], map.pixel(x, y + 60)[0]) << x << " " << y;
}

TEST(LdrFlip, SeesLessFromFarther) {
    const ImagePair pair = ldr_pair(40, 30);
    const double near = mean_of(ldr_flip(pair.image, pair.reference, 10.0, threads()));
    const double far = mean_of(ldr_flip(pair.image, pair.reference, 150.0, threads()));
    EXPECT_GT(near, 2.0 * far);
}

TEST(LdrFlip, TakesImagesSmallerThanItsFiltersAndIgnoresAlpha) {
    ImageF image(1, 1, 4);
    ImageF reference(1, 1, 4);
    image.pixels = {1.0f, 1.0f, 1.0f, 0.25f};
    reference.pixels = {0.0f, 0.0f, 0.0f, 1.0f};
    EXPECT_NEAR(ldr_flip(image, reference, kFlipPixelsPerDegree, threads()).pixels[0], 0.967379f, 2e-5f);
    EXPECT_THROW((void)ldr_flip(ImageF(2, 2, 2), ImageF(2, 2, 2), 67.0, threads()), std::invalid_argument);
    EXPECT_THROW((void)ldr_flip(ImageF(2, 3, 3), ImageF(2, 2, 3), 67.0, threads()), std::invalid_argument);
}

TEST(HdrFlip, IsThatOfTheSlowProgram) {
    const ImagePair pair = hdr_pair(40, 30);
    const HdrFlip flip = hdr_flip(pair.image, pair.reference, {.pixels_per_degree = 20.0}, threads());
    EXPECT_NEAR(flip.exposures.start, -3.894152f, 1e-5f);
    EXPECT_NEAR(flip.exposures.stop, -1.301232f, 1e-5f);
    EXPECT_EQ(flip.exposures.count, 3);
    EXPECT_NEAR(mean_of(flip.map), 0.597186, 2e-5);
    EXPECT_NEAR(flip.map.pixel(0, 0)[0], 0.277549f, 5e-5f);
    EXPECT_NEAR(flip.map.pixel(7, 3)[0], 0.972626f, 5e-5f);
    EXPECT_NEAR(flip.map.pixel(39, 29)[0], 0.209553f, 5e-5f);
}

TEST(HdrFlip, IsTheSameAtAnyScale) {
    ImagePair pair = hdr_pair(40, 30);
    const HdrFlip flip = hdr_flip(pair.image, pair.reference, {}, threads());
    for (ImageF* image : {&pair.image, &pair.reference})
        for (float& value : image->pixels) value *= 1024.0f;
    const HdrFlip brighter = hdr_flip(pair.image, pair.reference, {}, threads());
    EXPECT_NEAR(brighter.exposures.start, flip.exposures.start - 10.0f, 1e-5f);
    EXPECT_NEAR(mean_of(brighter.map), mean_of(flip.map), 1e-5);
}

TEST(HdrFlip, ExposuresShowTheBrightestAndTheMedianAlike) {
    // ACES shows 2.1189 as 0.85: by the root of the fit.
    ImageF reference = filled(3, 1, Rgb(1.0f));
    std::fill_n(reference.pixels.begin(), 3, 8.0f);
    const ExposureRange range = exposures_for(reference);
    EXPECT_NEAR(range.stop, std::log2(2.1189f), 1e-4f);
    EXPECT_NEAR(range.start, range.stop - 3.0f, 1e-5f);
    EXPECT_EQ(range.count, 3);
    EXPECT_FLOAT_EQ(range.exposure(0), range.start);
    EXPECT_FLOAT_EQ(range.exposure(2), range.stop);
    EXPECT_EQ(exposure_range(1.0f, 1.0f).count, 2);
    // The file name of the authors' own example: -12.5423 to 0.9427 are 14 exposures.
    EXPECT_EQ(exposure_range(-12.5423f, 0.9427f).count, 14);
}

TEST(HdrFlip, BlackAndBrokenReferencesHaveExposuresToo) {
    EXPECT_EQ(exposures_for(ImageF(4, 4, 3)).start, 0.0f);
    EXPECT_EQ(exposures_for(ImageF(4, 4, 3)).stop, 0.0f);
    ImageF mostly_black(5, 1, 3);
    std::fill_n(mostly_black.pixels.begin(), 6, 2.0f);
    EXPECT_NEAR(exposures_for(mostly_black).stop, std::log2(2.1189f / 2.0f), 1e-4f);
    mostly_black.pixels[14] = std::numeric_limits<float>::infinity();
    mostly_black.pixels[11] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NEAR(exposures_for(mostly_black).start, std::log2(2.1189f / 2.0f), 1e-4f);
}

TEST(HdrFlip, TakesTheExposuresThatItIsTold) {
    const ImagePair pair = hdr_pair(20, 20);
    const HdrFlip flip =
        hdr_flip(pair.image, pair.reference, {.start_exposure = -2.0f, .stop_exposure = 2.5f}, threads());
    EXPECT_EQ(flip.exposures.start, -2.0f);
    EXPECT_EQ(flip.exposures.stop, 2.5f);
    EXPECT_EQ(flip.exposures.count, 5);
    EXPECT_THROW((void)hdr_flip(pair.image, pair.reference, {.start_exposure = 90.0f}, threads()),
                 std::invalid_argument);
}

TEST(HdrFlip, WhatCannotBeShownIsBlackOrWhite) {
    ImageF odd = filled(8, 8, Rgb(0.5f));
    ImageF plain = odd;
    odd.pixels[0] = -1e4f;
    plain.pixels[0] = 0.0f;
    odd.pixels[30] = std::numeric_limits<float>::quiet_NaN();
    plain.pixels[30] = 0.0f;
    odd.pixels[60] = std::numeric_limits<float>::infinity();
    plain.pixels[60] = 1e10f;
    const HdrFlip flip = hdr_flip(odd, plain, {.start_exposure = -1.0f, .stop_exposure = 1.0f}, threads());
    EXPECT_EQ(mean_of(flip.map), 0.0);
}

TEST(HdrFlip, DescriptionsSayWhatWasDone) {
    EXPECT_NE(describe_ldr_flip(kFlipPixelsPerDegree).find("67.02 pixels per degree"), std::string::npos);
    const std::string text = describe_hdr_flip(30.0, exposure_range(-3.25f, 1.0f));
    for (const char* part : {"30.00 pixels per degree", "ACES", "5 exposures", "-3.25", "1.0"})
        EXPECT_NE(text.find(part), std::string::npos) << text;
}

}  // namespace
}  // namespace etendue
