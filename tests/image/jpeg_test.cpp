#include "image/jpeg.h"

#include "image/read.h"

#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

ImageF wave(int width, int height, int channels) {
    ImageF image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.pixel(x, y)[static_cast<std::size_t>(c)] =
                    0.5f + 0.4f * std::sin(0.1f * static_cast<float>(x + y) + static_cast<float>(c));
    return image;
}

ImageF decode(const std::vector<unsigned char>& file) {
    return read_image_float(std::as_bytes(std::span(file)));
}

float largest_difference(const ImageF& decoded, const ImageF& image) {
    float largest = 0.0f;
    for (int y = 0; y < decoded.height; ++y)
        for (int x = 0; x < decoded.width; ++x)
            for (std::size_t c = 0; c < static_cast<std::size_t>(decoded.channels); ++c)
                largest = std::max(largest, std::abs(decoded.pixel(x, y)[c] - image.pixel(x, y)[c]));
    return largest;
}

TEST(Jpeg, IsCutOffWithoutItsEndMarker) {
    const std::vector<unsigned char> whole = encode_jpeg(wave(50, 30, 3), 90);
    const auto cut = [](std::span<const unsigned char> bytes) { return is_cut_jpeg(std::as_bytes(bytes)); };
    EXPECT_FALSE(cut(whole));
    std::vector<unsigned char> longer = whole;
    longer.resize(whole.size() + 100);
    EXPECT_FALSE(cut(longer)) << "what follows the end does not matter";
    for (std::size_t length = 30; length < whole.size(); ++length)
        EXPECT_TRUE(cut(std::span(whole).first(length))) << length;
    // A comment may hold an image of its own: it is passed over.
    std::vector<unsigned char> comment{0xff, 0xd8, 0xff, 0xfe, 0x00, 0x06, 0xff, 0xd8, 0xff, 0xd9};
    comment.insert(comment.end(), whole.begin() + 2, whole.end() - 2);
    EXPECT_TRUE(cut(comment));
    EXPECT_FALSE(is_cut_jpeg(std::as_bytes(std::span("\x89PNG\r\n\x1a\n"))));
}

TEST(Jpeg, ThatIsCutOffShowsWhatThereIs) {
    const ImageF image = wave(50, 30, 3);
    std::vector<unsigned char> file = encode_jpeg(image, 95);
    file.resize(file.size() * 3 / 4);
    EXPECT_NEAR(decode(file).pixel(0, 0)[0], image.pixel(0, 0)[0], 0.05f);
}

TEST(Jpeg, HoldsTheImage) {
    for (const int channels : {1, 3}) {
        const ImageF image = wave(50, 30, channels);
        const ImageF decoded = decode(encode_jpeg(image, 95));
        ASSERT_EQ(decoded.width, 50);
        ASSERT_EQ(decoded.height, 30);
        ASSERT_EQ(decoded.channels, channels);
        EXPECT_LT(largest_difference(decoded, image), 0.06f);
    }
}

TEST(Jpeg, LeavesAlphaOut) {
    const ImageF image = wave(40, 40, 4);
    const ImageF decoded = decode(encode_jpeg(image, 95));
    ASSERT_EQ(decoded.channels, 3);
    EXPECT_LT(largest_difference(decoded, image), 0.06f);
    EXPECT_EQ(decode(encode_jpeg(wave(40, 40, 2), 95)).channels, 1);
}

TEST(Jpeg, LowerQualityTakesFewerBytes) {
    const ImageF image = wave(200, 200, 3);
    EXPECT_LT(encode_jpeg(image, 40).size(), encode_jpeg(image, 90).size());
}

}  // namespace

}  // namespace etendue
