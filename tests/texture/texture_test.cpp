#include "texture/texture.h"

#include "texture/test_images.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// One row of floats 0, 1, 2, …
Texture ramp(int width, Wrap wrap, bool nearest) {
    ImageF image(width, 1, 1);
    for (int x = 0; x < width; ++x) image.pixel(x, 0)[0] = static_cast<float>(x);
    return make_texture(std::move(image), {.wrap_u = wrap, .wrap_v = wrap, .nearest = nearest});
}

float at(const Texture& texture, float u, float v = 0.5f) {
    return texture.lookup({u, v}).rgb.r;
}

TEST(Texture, EveryByteIsDecodedByTheSrgbCurveAndAlphaNever) {
    for (int value = 0; value < 256; ++value) {
        const auto byte = static_cast<std::uint8_t>(value);
        const double linear = value / 255.0;
        for (const int channels : {1, 2, 3, 4}) {
            const Image8 image =
                bytes(1, 1, channels, std::vector<std::uint8_t>(static_cast<std::size_t>(channels), byte));
            const Texel color = make_texture(image, {.encoding = Encoding::Srgb}).lookup({0.5f, 0.5f});
            EXPECT_NEAR(color.rgb.r, srgb_to_linear(value), 1e-6);
            EXPECT_NEAR(color.rgb.g, srgb_to_linear(value), 1e-6);
            EXPECT_NEAR(color.rgb.b, srgb_to_linear(value), 1e-6);
            const Texel data = make_texture(image, {.encoding = Encoding::Linear}).lookup({0.5f, 0.5f});
            EXPECT_NEAR(data.rgb.r, linear, 1e-6);
            EXPECT_NEAR(data.rgb.b, linear, 1e-6);
            const bool has_alpha = channels == 2 || channels == 4;
            EXPECT_NEAR(color.alpha, has_alpha ? linear : 1.0, 1e-6);
            EXPECT_NEAR(data.alpha, has_alpha ? linear : 1.0, 1e-6);
        }
    }
}

TEST(Texture, ChannelsBecomeGreyAlphaAndColour) {
    const auto lookup = [](int channels) {
        ImageF image(1, 1, channels);
        for (int c = 0; c < channels; ++c) image.pixels[static_cast<std::size_t>(c)] = 0.1f * static_cast<float>(c + 1);
        return make_texture(image, {}).lookup({0.5f, 0.5f});
    };
    EXPECT_EQ(lookup(1).rgb, Rgb(0.1f));
    EXPECT_EQ(lookup(1).alpha, 1.0f);
    EXPECT_EQ(lookup(2).rgb, Rgb(0.1f));
    EXPECT_FLOAT_EQ(lookup(2).alpha, 0.2f);
    EXPECT_FLOAT_EQ(lookup(3).rgb.b, 0.3f);
    EXPECT_EQ(lookup(3).alpha, 1.0f);
    EXPECT_FLOAT_EQ(lookup(4).alpha, 0.4f);
}

TEST(Texture, TheOriginIsTheFirstTexelOfTheTopRow) {
    const Image8 image = bytes(2, 2, 1, {0, 51, 102, 255});
    for (const bool nearest : {false, true}) {
        const Texture texture = make_texture(image, {.nearest = nearest});
        EXPECT_NEAR(at(texture, 0.25f, 0.25f), 0.0f, 1e-6f);
        EXPECT_NEAR(at(texture, 0.75f, 0.25f), 0.2f, 1e-6f);
        EXPECT_NEAR(at(texture, 0.25f, 0.75f), 0.4f, 1e-6f);
        EXPECT_NEAR(at(texture, 0.75f, 0.75f), 1.0f, 1e-6f);
    }
}

TEST(Texture, BilinearPassesThroughCentresAndIsLinearBetween) {
    const Texture texture = ramp(4, Wrap::Clamp, false);
    for (int x = 0; x < 4; ++x) EXPECT_NEAR(at(texture, (static_cast<float>(x) + 0.5f) / 4.0f), x, 1e-6f);
    EXPECT_NEAR(at(texture, 1.75f / 4.0f), 1.25f, 1e-6f);
    const Texture square = make_texture(bytes(2, 2, 1, {0, 0, 0, 255}), {.wrap_u = Wrap::Clamp, .wrap_v = Wrap::Clamp});
    EXPECT_NEAR(at(square, 0.5f, 0.5f), 0.25f, 1e-6f);
}

TEST(Texture, NearestDoesNotMix) {
    const Texture texture = ramp(4, Wrap::Repeat, true);
    for (const float u : {0.26f, 0.3f, 0.45f, 0.49f}) EXPECT_EQ(at(texture, u), 1.0f);
}

TEST(Texture, RepeatWrapsBothWays) {
    for (const bool nearest : {false, true}) {
        const Texture texture = ramp(5, Wrap::Repeat, nearest);
        for (const float u : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f})
            for (const float turns : {-7.0f, -1.0f, 1.0f, 2.0f, 100.0f})
                EXPECT_NEAR(at(texture, u + turns), at(texture, u), 1e-3f) << u << " + " << turns;
    }
    // Over the seam the last texel mixes with the first.
    EXPECT_NEAR(at(ramp(4, Wrap::Repeat, false), 0.0f), 1.5f, 1e-5f);
    EXPECT_NEAR(at(ramp(4, Wrap::Repeat, false), 1.0f), 1.5f, 1e-5f);
}

TEST(Texture, MirrorTurnsBackAtItsSeamWithoutAStep) {
    for (const bool nearest : {false, true}) {
        const Texture texture = ramp(5, Wrap::Mirror, nearest);
        for (const float u : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f}) {
            EXPECT_NEAR(at(texture, -u), at(texture, u), 1e-4f);
            EXPECT_NEAR(at(texture, 2.0f - u), at(texture, u), 1e-4f);
            EXPECT_NEAR(at(texture, u + 2.0f), at(texture, u), 1e-4f);
            EXPECT_NEAR(at(texture, u - 4.0f), at(texture, u), 1e-4f);
        }
    }
    // At the seams both neighbours are the same texel.
    EXPECT_NEAR(at(ramp(4, Wrap::Mirror, false), 0.0f), 0.0f, 1e-5f);
    EXPECT_NEAR(at(ramp(4, Wrap::Mirror, false), 1.0f), 3.0f, 1e-5f);
}

TEST(Texture, ClampHoldsTheEdge) {
    for (const bool nearest : {false, true}) {
        const Texture texture = ramp(4, Wrap::Clamp, nearest);
        for (const float u : {-1e9f, -3.0f, -0.01f, 0.0f}) EXPECT_EQ(at(texture, u), 0.0f);
        for (const float u : {1.0f, 1.01f, 5.0f, 1e9f}) EXPECT_EQ(at(texture, u), 3.0f);
    }
}

TEST(Texture, WrapsApplyPerAxis) {
    const Texture texture = make_texture(bytes(2, 2, 1, {0, 255, 0, 255}),
                                         {.wrap_u = Wrap::Repeat, .wrap_v = Wrap::Clamp, .nearest = true});
    EXPECT_EQ(at(texture, 1.25f, 7.0f), 0.0f);
    EXPECT_EQ(at(texture, 1.75f, -7.0f), 1.0f);
}

TEST(Texture, AnyCoordinateReadsATexel) {
    const float infinity = std::numeric_limits<float>::infinity();
    const float extremes[] = {1e10f,  -1e10f,       3e38f,       -3e38f,       1e-45f, -1e-45f,
                              -1e-9f, 1.0f - 1e-7f, 16777216.0f, -16777217.0f, 0.0f,   -0.0f};
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
        for (const bool nearest : {false, true}) {
            const Texture texture = ramp(3, wrap, nearest);
            for (const float u : extremes) {
                const float value = at(texture, u, u);
                EXPECT_TRUE(value >= 0.0f && value <= 2.0f) << u;
            }
            const float origin = at(texture, 0.0f, 0.0f);
            for (const float u : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN()})
                EXPECT_EQ(at(texture, u, u), origin);
        }
}

TEST(Texture, TheMeanIsOfLinearValues) {
    const Texture texture =
        make_texture(bytes(2, 1, 4, {0, 255, 100, 0, 255, 255, 200, 51}), {.encoding = Encoding::Srgb});
    const Texel mean = texture.mean();
    EXPECT_NEAR(mean.rgb.r, 0.5, 1e-6);
    EXPECT_NEAR(mean.rgb.g, 1.0, 1e-6);
    EXPECT_NEAR(mean.rgb.b, 0.5 * (srgb_to_linear(100) + srgb_to_linear(200)), 1e-6);
    EXPECT_NEAR(mean.alpha, 0.1, 1e-6);
}

TEST(Texture, TheRangeIsOfEachChannelOfTheImage) {
    // More values than are compared at once, and some beside.
    ImageF image(5, 60, 4);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = 0.25f + 1e-4f * static_cast<float>(i % 97);
    image.pixel(4, 59)[1] = 0.125f;
    image.pixel(2, 3)[0] = 0.75f;
    image.pixel(4, 59)[3] = 2.0f;
    const auto range = make_texture(std::move(image), {}).range();
    ASSERT_TRUE(range);
    EXPECT_EQ(range->least.rgb.g, 0.125f);
    EXPECT_NEAR(range->least.rgb.r, 0.25f, 5e-4f);
    EXPECT_EQ(range->greatest.rgb.r, 0.75f);
    EXPECT_NEAR(range->greatest.rgb.g, 0.26f, 5e-4f);
    EXPECT_EQ(range->greatest.alpha, 2.0f);
    const auto grey = make_texture(bytes(3, 1, 1, {255, 51, 102}), {}).range();
    EXPECT_FLOAT_EQ(grey->least.rgb.g, 0.2f);
    EXPECT_FLOAT_EQ(grey->greatest.rgb.g, 1.0f);
    EXPECT_EQ(grey->greatest.alpha, 1.0f);
    const auto color = make_texture(bytes(2, 1, 3, {0, 100, 200, 50, 60, 70}), {.encoding = Encoding::Srgb}).range();
    EXPECT_NEAR(color->least.rgb.g, srgb_to_linear(60), 1e-6);
    EXPECT_NEAR(color->greatest.rgb.b, srgb_to_linear(200), 1e-6);
}

TEST(Texture, KeepsTheFilesDepthForAllLevels) {
    // 4 × 2, 2 × 1 and 1 × 1 texels.
    EXPECT_EQ(make_texture(Image8(4, 2, 3), {}).bytes(), 33u);
    EXPECT_EQ(make_texture(Image16(4, 2, 3), {}).bytes(), 66u);
    EXPECT_EQ(make_texture(ImageH(4, 2, 3), {}).bytes(), 66u);
    EXPECT_EQ(make_texture(ImageF(4, 2, 3), {}).bytes(), 132u);
}

/// A footprint of `width` × `height` in texture coordinates.
TextureFootprint box(float width, float height) {
    return {{{width, 0.0f}, {0.0f, height}}};
}

TEST(TextureFilter, FootprintsBelowATexelReadThePoint) {
    const Texture texture = ramp(8, Wrap::Repeat, false);
    for (const float u : {0.1f, 0.43f, 0.9f})
        EXPECT_EQ(texture.lookup({u, 0.5f}, box(0.12f, 0.9f)).rgb.r, texture.lookup({u, 0.5f}).rgb.r);
}

TEST(TextureFilter, AFootprintOverTheWholeImageReadsItsMean) {
    const Texture texture = ramp(8, Wrap::Repeat, false);
    for (const float size : {1.0f, 3.0f, 1e6f, 1e30f, std::numeric_limits<float>::infinity()})
        EXPECT_NEAR(texture.lookup({0.3f, 0.5f}, box(size, size)).rgb.r, 3.5f, 1e-5f) << size;
}

TEST(TextureFilter, FootprintsThatAreNoNumbersReadTheMean) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NEAR(ramp(8, Wrap::Repeat, false).lookup({0.3f, 0.5f}, box(nan, nan)).rgb.r, 3.5f, 1e-5f);
}

/// Rows of 0, 1, 2, … as many as columns, so that footprints of one size in both directions are circles.
Texture square_ramp(int size, TextureOptions options) {
    ImageF image(size, size, 1);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) image.pixel(x, y)[0] = static_cast<float>(x);
    return make_texture(std::move(image), options);
}

TEST(TextureFilter, BetweenTwoLevelsTheFilterMovesContinuously) {
    const Texture texture = square_ramp(16, {.wrap_u = Wrap::Clamp});
    float before = texture.lookup({0.1f, 0.5f}, box(1.0f / 16.0f, 1.0f / 16.0f)).rgb.r;
    for (float size = 1.0f / 16.0f; size < 1.2f; size *= 1.01f) {
        const float value = texture.lookup({0.1f, 0.5f}, box(size, size)).rgb.r;
        EXPECT_NEAR(value, before, 0.15f) << size;
        before = value;
    }
    EXPECT_NEAR(before, 7.5f, 1e-4f);
}

// Stripes along u: a footprint that is long along v and narrow along u must keep them, an isotropic one must not.
TEST(TextureFilter, LongFootprintsStaySharpAcross) {
    Image8 image(64, 64, 1);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) image.pixel(x, y)[0] = x % 8 < 4 ? 255 : 0;
    const Texture texture = make_texture(image, {});
    const float texel = 1.0f / 64.0f;
    EXPECT_NEAR(texture.lookup({2.0f * texel, 0.5f}, box(texel, 8.0f * texel)).rgb.r, 1.0f, 1e-5f);
    EXPECT_NEAR(texture.lookup({2.0f * texel, 0.5f}, box(8.0f * texel, 8.0f * texel)).rgb.r, 0.5f, 1e-2f);
    // Along u the taps take the mean of the stripes.
    EXPECT_NEAR(texture.lookup({2.0f * texel, 0.5f}, box(8.0f * texel, texel)).rgb.r, 0.5f, 1e-5f);
}

TEST(TextureFilter, WrapsHoldInEveryLevel) {
    const auto edge_of = [](Wrap wrap) {
        return square_ramp(8, {.wrap_u = wrap}).lookup({0.0f, 0.5f}, box(0.25f, 0.25f)).rgb.r;
    };
    // Level 1 has the values 0.5, 2.5, 4.5, 6.5.
    EXPECT_NEAR(edge_of(Wrap::Clamp), 0.5f, 1e-5f);
    EXPECT_NEAR(edge_of(Wrap::Mirror), 0.5f, 1e-5f);
    EXPECT_NEAR(edge_of(Wrap::Repeat), 3.5f, 1e-5f);
}

TEST(TextureFilter, MinificationFiltersDoWhatTheySay) {
    const auto at_size = [](const TextureOptions& options, float size) {
        return square_ramp(8, options).lookup({0.4f, 0.5f}, box(size, size)).rgb.r;
    };
    // u = 0.4 is 3.2 texels of the image and 1.6 of level 1 (0.5, 2.5, 4.5, 6.5) and 0.8 of level 2 (1.5, 5.5).
    const float image = 2.7f;
    const float level1 = 2.7f;
    const float level2 = 1.5f + 4.0f * 0.3f;
    const float between = 0.25f * std::exp2(0.25f);
    EXPECT_EQ(at_size({.nearest_minified = true, .mip_filter = MipFilter::None}, 1.0f), 3.0f);
    EXPECT_NEAR(at_size({.mip_filter = MipFilter::None}, 1.0f), image, 1e-5f);
    EXPECT_EQ(at_size({.nearest_minified = true, .mip_filter = MipFilter::Nearest}, between), 2.5f);
    EXPECT_NEAR(at_size({.mip_filter = MipFilter::Nearest}, between), level1, 1e-5f);
    EXPECT_NEAR(at_size({.nearest_minified = true}, between), 0.75f * 2.5f + 0.25f * 1.5f, 1e-5f);
    EXPECT_NEAR(at_size({}, between), 0.75f * level1 + 0.25f * level2, 1e-5f);
    // Magnified, only the magnification filter counts.
    EXPECT_EQ(at_size({.nearest = true, .mip_filter = MipFilter::None}, 0.01f), 3.0f);
    EXPECT_NEAR(at_size({.nearest_minified = true}, 0.01f), image, 1e-5f);
}

}  // namespace

}  // namespace etendue::test
