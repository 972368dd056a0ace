#include "texture/mip_chain.h"

#include "support/random.h"
#include "texture/test_images.h"

#include <array>
#include <limits>
#include <type_traits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

template <typename T>
Image<T> noise(int width, int height, int channels) {
    Random random(7);
    Image<T> image(width, height, channels);
    for (T& value : image.pixels) {
        if constexpr (std::is_integral_v<T>)
            value = static_cast<T>(random.next() * static_cast<float>(std::numeric_limits<T>::max()));
        else
            value = static_cast<T>(random.next());
    }
    return image;
}

TEST(MipChain, CountsLevelsAndTexels) {
    EXPECT_EQ(mip_level_count(1, 1), 1);
    EXPECT_EQ(mip_level_count(256, 256), 9);
    EXPECT_EQ(mip_level_count(5, 300), 9);
    EXPECT_EQ(mip_texel_count(1, 1), 1u);
    EXPECT_EQ(mip_texel_count(4, 4), 21u);
    EXPECT_EQ(mip_texel_count(5, 3), 15u + 2u + 1u);
}

// The coarsest level is the mean of all texels, which only area weights give for sizes that are not powers of two. The
// tolerance is one rounding to the image's depth.
template <typename T>
void expect_coarsest_is_mean(Encoding encoding, double tolerance) {
    for (const auto& [width, height] : {std::pair{8, 8}, {7, 5}, {1, 13}, {12, 3}, {31, 33}})
        for (const int channels : {1, 2, 3, 4}) {
            const MipChain chain = make_chain(noise<T>(width, height, channels), encoding);
            const Texel coarsest = chain.sample({0.2f, 0.7f}, 100.0f, false, {});
            const Texel mean = chain.mean();
            EXPECT_NEAR(coarsest.rgb.r, mean.rgb.r, tolerance) << width << " x " << height << " x " << channels;
            EXPECT_NEAR(coarsest.rgb.b, mean.rgb.b, tolerance) << width << " x " << height << " x " << channels;
            EXPECT_NEAR(coarsest.alpha, mean.alpha, tolerance) << width << " x " << height << " x " << channels;
        }
}

TEST(MipChain, LevelsKeepTheMeanInLinearLight) {
    for (const Encoding encoding : {Encoding::Linear, Encoding::Srgb}) {
        // The curve's slope at white is 2.27.
        expect_coarsest_is_mean<std::uint8_t>(encoding, 0.5 / 255.0 * 2.3);
        expect_coarsest_is_mean<std::uint16_t>(encoding, 0.5 / 65535.0 * 2.3 + 2e-6);
        expect_coarsest_is_mean<Float16>(encoding, 1.2e-3);
        expect_coarsest_is_mean<float>(encoding, 2e-6);
    }
}

TEST(MipChain, BlackAndWhiteAverageToTheByteForHalf) {
    const MipChain chain = make_chain(bytes(2, 2, 3, {0, 0, 0, 255, 255, 255, 255, 255, 255, 0, 0, 0}), Encoding::Srgb);
    EXPECT_NEAR(chain.sample({0.5f, 0.5f}, 1.0f, false, {}).rgb.g, srgb_to_linear(188), 1e-6);
}

TEST(MipChain, EveryByteSurvivesAveragingWithItself) {
    for (int value = 0; value < 256; ++value) {
        const auto byte = static_cast<std::uint8_t>(value);
        const MipChain chain = make_chain(bytes(2, 2, 2, std::vector<std::uint8_t>(8, byte)), Encoding::Srgb);
        const Texel coarse = chain.sample({0.5f, 0.5f}, 1.0f, false, {});
        EXPECT_NEAR(coarse.rgb.r, srgb_to_linear(value), 1e-6);
        EXPECT_NEAR(coarse.alpha, value / 255.0, 1e-6);
    }
}

TEST(MipChain, GivenLevelsAreKeptAndTheOthersAreMadeFromThem) {
    std::vector<NativeImage> levels{Image8(4, 4, 1), bytes(2, 2, 1, {255, 255, 255, 255})};
    const MipChain chain(std::move(levels), Encoding::Linear);
    EXPECT_EQ(chain.sample({0.5f, 0.5f}, 0.0f, false, {}).rgb.r, 0.0f);
    EXPECT_FLOAT_EQ(chain.sample({0.5f, 0.5f}, 0.25f, false, {}).rgb.r, 0.25f);
    EXPECT_EQ(chain.sample({0.5f, 0.5f}, 1.0f, false, {}).rgb.r, 1.0f);
    EXPECT_EQ(chain.sample({0.5f, 0.5f}, 2.0f, false, {}).rgb.r, 1.0f);
    EXPECT_EQ(chain.bytes(), 21u);
}

// Each half of the image has one texel that shows, dark beside bright or the other way round; the colours of the others
// must not be seen. Where nothing shows in half of a level, the level below says what colour surrounds it.
TEST(MipChain, ColoursByAlphaAreOfWhatShows) {
    const std::vector<std::uint8_t> dark{60, 255}, bright{200, 255}, hidden{255, 0}, black{0, 0};
    std::vector<std::uint8_t> texels;
    for (const auto& texel : {dark, hidden, black, black, hidden, bright, black, black})
        texels.insert(texels.end(), texel.begin(), texel.end());
    const double mean = 0.5 * (srgb_to_linear(60) + srgb_to_linear(200));
    std::vector<NativeImage> levels{bytes(4, 2, 2, texels)};
    const MipChain chain(std::move(levels), Encoding::Srgb, MipLevels::AllByAlpha);
    const double byte = 2.3 / 255.0;
    EXPECT_NEAR(chain.sample({0.25f, 0.5f}, 1.0f, true, {}).rgb.g, mean, byte);
    EXPECT_NEAR(chain.sample({0.25f, 0.5f}, 1.0f, true, {}).alpha, 0.5, 1.0 / 255.0);
    EXPECT_NEAR(chain.sample({0.75f, 0.5f}, 1.0f, true, {}).rgb.g, mean, byte);
    EXPECT_EQ(chain.sample({0.75f, 0.5f}, 1.0f, true, {}).alpha, 0.0f);
    EXPECT_NEAR(chain.sample({0.5f, 0.5f}, 2.0f, true, {}).rgb.g, mean, byte);
    EXPECT_EQ(chain.sample({0.3f, 0.1f}, 0.0f, true, {}).rgb.g, 1.0f) << "the image itself stays as it is";
}

TEST(MipChain, WithoutLevelsThereIsOnlyTheImage) {
    std::vector<NativeImage> levels{bytes(2, 1, 1, {0, 255})};
    const MipChain chain(std::move(levels), Encoding::Linear, MipLevels::AsGiven);
    EXPECT_EQ(chain.bytes(), 2u);
    EXPECT_EQ(chain.sample({0.25f, 0.5f}, 5.0f, false, {}).rgb.r, 0.0f);
}

}  // namespace

}  // namespace etendue::test
