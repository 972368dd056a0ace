#include "image/radiance_header.h"

#include "core/error.h"
#include "image/image_reader.h"
#include "image/read.h"

#include <array>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A flat picture of 2 by 3 pixels in file order, whose first has the given mantissas over 128 and the others none but
/// their number in red, in 1/128.
std::vector<std::byte> picture(const std::string& header, const std::array<unsigned char, 3>& first) {
    std::string text = header;
    for (int i = 0; i < 6; ++i) {
        const unsigned char pixel[4] = {i == 0 ? first[0] : static_cast<unsigned char>(i),
                                        i == 0 ? first[1] : static_cast<unsigned char>(0),
                                        i == 0 ? first[2] : static_cast<unsigned char>(0), 129};
        text.append(reinterpret_cast<const char*>(pixel), 4);
    }
    std::vector<std::byte> bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
}

constexpr std::array<unsigned char, 3> kWhite{128, 128, 128};

/// Red of all pixels in 1/128, row by row; the first in file order is 128.
std::vector<int> reds(const std::string& size) {
    const std::vector<std::byte> file = picture("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n", kWhite);
    const ImageF image = read_image_float(std::span(file));
    const ImageInfo info = read_image_info(std::span(file));
    EXPECT_EQ(info.width, image.width);
    EXPECT_EQ(info.height, image.height);
    EXPECT_EQ(info.display_window, (PixelRect{0, 0, image.width, image.height}));
    std::vector<int> values{image.width};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            values.push_back(static_cast<int>(std::lround(image.pixel(x, y)[0] * 128.0f)));
    return values;
}

TEST(RadianceHeader, PicturesAreUprightWhateverTheirAxes) {
    using Values = std::vector<int>;
    EXPECT_EQ(reds("-Y 3 +X 2"), (Values{2, 128, 1, 2, 3, 4, 5}));
    EXPECT_EQ(reds("+Y 3 +X 2"), (Values{2, 4, 5, 2, 3, 128, 1}));
    EXPECT_EQ(reds("-Y 3 -X 2"), (Values{2, 1, 128, 3, 2, 5, 4}));
    EXPECT_EQ(reds("+Y 3 -X 2"), (Values{2, 5, 4, 3, 2, 1, 128}));
    EXPECT_EQ(reds("+X 3 -Y 2"), (Values{3, 128, 2, 4, 1, 3, 5}));
    EXPECT_EQ(reds("-X 3 -Y 2"), (Values{3, 4, 2, 128, 5, 3, 1}));
    EXPECT_EQ(reds("+X 3 +Y 2"), (Values{3, 1, 3, 5, 128, 2, 4}));
    EXPECT_EQ(reds("-X 3 +Y 2"), (Values{3, 5, 3, 1, 4, 2, 128}));
}

ImageF read(const std::string& header, const std::array<unsigned char, 3>& first = kWhite) {
    const std::vector<std::byte> file = picture(header, first);
    return read_image_float(std::span(file));
}

TEST(RadianceHeader, ExposuresAreTakenOut) {
    const ImageF image = read(
        "#?RADIANCE\nEXPOSURE=2\n FORMAT = 32-bit_rle_rgbe\nEXPOSURE= 0.25\n"
        "COLORCORR= 1 2 4\n\n-Y 3 +X 2\n");
    EXPECT_FLOAT_EQ(image.pixel(0, 0)[0], 2.0f);
    EXPECT_FLOAT_EQ(image.pixel(0, 0)[1], 1.0f);
    EXPECT_FLOAT_EQ(image.pixel(0, 0)[2], 0.5f);
}

TEST(RadianceHeader, XyzBecomesRec709) {
    // X, Y and Z of the white of Rec.709, D65, as far as mantissas go.
    const ImageF image = read("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 3 +X 2\n", {122, 128, 139});
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(image.pixel(0, 0)[c], 1.0f, 0.02f) << c;
}

TEST(RadianceHeader, LineEndsOfOtherSystemsAndNoFormatAreRead) {
    for (const char* header : {"#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 3 +X 2\r\n", "#?RGBE\n\n-Y 3 +X 2\n",
                               "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\nVIEW= -vtv\n\n-Y 3 +X 2\n"}) {
        const ImageF image = read(header);
        EXPECT_FLOAT_EQ(image.pixel(0, 0)[0], 1.0f) << header;
        EXPECT_FLOAT_EQ(image.pixel(1, 2)[0], 5.0f / 128.0f) << header;
    }
}

TEST(RadianceHeader, LongLinesAndManyAreRead) {
    std::string many;
    for (int i = 0; i < 300; ++i) many += "# pcomb\n";
    for (const std::string& history : {std::string(127, '#') + "\n", std::string(600, '#') + "\n", many}) {
        const ImageF image = read("#?RADIANCE\n" + history + "FORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 2\n");
        EXPECT_FLOAT_EQ(image.pixel(0, 0)[0], 1.0f) << history.size();
    }
}

TEST(RadianceHeader, PiecesAreThoseOfTheWholePicture) {
    const std::vector<std::byte> file = picture("#?RADIANCE\nEXPOSURE=2\n\n+X 3 -Y 2\n", kWhite);
    const ImageF whole = read_image_float(std::span(file));
    ImageReader reader{ImageSource(std::span(file))};
    ASSERT_EQ(reader.info().width, 3);
    std::vector<float> row(9);
    reader.read_rows(0, 1, 2, row);
    EXPECT_TRUE(std::equal(row.begin(), row.end(), whole.pixels.begin() + 9));
}

TEST(RadianceHeader, WhatIsWrongIsSaid) {
    const auto error = [](const std::string& header) {
        try {
            (void)read(header);
        } catch (const IoError& caught) {
            return std::string(caught.what());
        }
        return std::string("read");
    };
    EXPECT_EQ(error("#?RADIANCE\nFORMAT=8-bit\n\n-Y 3 +X 2\n"),
              "its header's FORMAT is neither 32-bit_rle_rgbe nor 32-bit_rle_xyze");
    EXPECT_EQ(error("#?RADIANCE\nEXPOSURE=-1\n\n-Y 3 +X 2\n"), "its header's EXPOSURE is not a number above 0");
    EXPECT_EQ(error("#?RADIANCE\nCOLORCORR=1 2\n\n-Y 3 +X 2\n"), "its header's COLORCORR is not a number above 0");
    EXPECT_EQ(error("#?RADIANCE\nEXPOSURE=1e30\nEXPOSURE=1e30\n\n-Y 3 +X 2\n"),
              "its header's exposures multiply to no number");
    EXPECT_EQ(error("#?RADIANCE\n\n3 2\n"), "its header does not end with its size, as in '-Y 512 +X 1024'");
    EXPECT_EQ(error("#?RADIANCE\n\n-Y 3 +Y 2\n"), "its header gives the size along one axis twice");
    EXPECT_EQ(error("#?RADIANCE\nFORMAT=32-bit_rle_rgbe"), "its header has no end");
    EXPECT_NE(error("#?RADIANCE\n\n+Y 16000 +X 16000\n").find("cannot hold"), std::string::npos);
}

}  // namespace
}  // namespace etendue
