#include "image/write.h"

#include "core/error.h"
#include "image/read.h"
#include "image_test_files.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <gtest/gtest.h>

namespace etendue {

namespace {

// Values over the range of normal halves, different in every channel.
ImageF make_gradient(int width, int height, int channels) {
    ImageF image(width, height, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        image.pixels[i] = std::exp2(static_cast<float>(i % 27) - 13.0f) * (1.0f + 0.37f * static_cast<float>(i % 7));
    }
    return image;
}

OIIO::ImageSpec spec_of(const std::filesystem::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    EXPECT_TRUE(input) << OIIO::geterror();
    return input ? input->spec() : OIIO::ImageSpec();
}

class WriteExr : public ::testing::TestWithParam<int> {};

TEST_P(WriteExr, FloatReadsBackExactly) {
    const TemporaryFolder folder;
    const ImageF image = make_gradient(13, 7, GetParam());
    write_image(folder / "a.exr", image, {.depth = PixelDepth::Float});
    const ImageF back = read_image_float(folder / "a.exr");
    EXPECT_EQ(back.width, 13);
    EXPECT_EQ(back.height, 7);
    EXPECT_EQ(back.channels, GetParam());
    EXPECT_EQ(back.pixels, image.pixels);
    EXPECT_EQ(folder.file_count(), 1u) << "no temporary file stays";
}

TEST_P(WriteExr, HalfReadsBackWithinHalfPrecision) {
    const TemporaryFolder folder;
    const ImageF image = make_gradient(13, 7, GetParam());
    write_image(folder / "a.exr", image, {.depth = PixelDepth::Half});
    const ImageF back = read_image_float(folder / "a.exr");
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < back.pixels.size(); ++i) {
        EXPECT_NEAR(back.pixels[i], image.pixels[i], image.pixels[i] * std::exp2(-11.0f)) << i;
    }
    EXPECT_EQ(spec_of(folder / "a.exr").format, OIIO::TypeDesc::HALF);
}

INSTANTIATE_TEST_SUITE_P(Channels, WriteExr, ::testing::Values(1, 2, 3, 4));

TEST(WriteImage, HalfKeepsFiniteValuesFinite) {
    const TemporaryFolder folder;
    ImageF image(4, 1, 1);
    image.pixels = {1e9f, -1e9f, std::numeric_limits<float>::infinity(), 65504.0f};
    write_image(folder / "a.exr", image, {.depth = PixelDepth::Half});
    const ImageF back = read_image_float(folder / "a.exr");
    EXPECT_EQ(back.pixels, (std::vector<float>{65504.0f, -65504.0f, image.pixels[2], 65504.0f}));
}

TEST(WriteImage, ExrCarriesEveryKindOfAttribute) {
    const TemporaryFolder folder;
    Mat4f matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = static_cast<float>(i) + 0.5f;
    const std::vector<float> primaries{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    ImageWriteOptions options;
    options.attributes = {{"chromaticities", primaries},
                          {"worldToCamera", matrix},
                          {"worldToNDC", matrix},
                          {"etendue:scene", std::string("a scene")},
                          {"etendue:spp", 64},
                          {"etendue:renderTime", 1.5f},
                          {"PixelAspectRatio", 1.25f},
                          {"Software", std::string("Etendue 0.1.0")},
                          {"oiio:ColorSpace", std::string("ACEScg")}};
    write_image(folder / "a.exr", make_gradient(4, 4, 3), options);

    const OIIO::ImageSpec spec = spec_of(folder / "a.exr");
    const auto* read_primaries = spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
    ASSERT_TRUE(read_primaries);
    EXPECT_TRUE(std::ranges::equal(std::span(static_cast<const float*>(read_primaries->data()), 8), primaries));
    for (const char* name : {"worldToCamera", "worldToNDC"}) {
        const auto* read_matrix = spec.find_attribute(name, OIIO::TypeMatrix);
        ASSERT_TRUE(read_matrix) << name;
        EXPECT_TRUE(std::ranges::equal(std::span(static_cast<const float*>(read_matrix->data()), 16),
                                       std::span(matrix.getValue(), 16)))
            << name;
    }
    EXPECT_EQ(spec.get_string_attribute("etendue:scene"), "a scene");
    EXPECT_EQ(spec.get_int_attribute("etendue:spp"), 64);
    EXPECT_EQ(spec.get_float_attribute("etendue:renderTime"), 1.5f);
    EXPECT_EQ(spec.get_float_attribute("PixelAspectRatio"), 1.25f);
    EXPECT_EQ(spec.get_string_attribute("Software"), "Etendue 0.1.0");
    EXPECT_EQ(spec.get_string_attribute("oiio:ColorSpace"), "ACEScg");
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
}

TEST(WriteImage, ExrKeepsTheCropWindowInTheFullImage) {
    const TemporaryFolder folder;
    ImageWriteOptions options;
    options.offset_x = 10;
    options.offset_y = 20;
    options.full_width = 64;
    options.full_height = 48;
    const ImageF image = make_gradient(5, 6, 3);
    write_image(folder / "a.exr", image, options);
    const OIIO::ImageSpec spec = spec_of(folder / "a.exr");
    EXPECT_EQ(spec.x, 10);
    EXPECT_EQ(spec.y, 20);
    EXPECT_EQ(spec.width, 5);
    EXPECT_EQ(spec.height, 6);
    EXPECT_EQ(spec.full_x, 0);
    EXPECT_EQ(spec.full_y, 0);
    EXPECT_EQ(spec.full_width, 64);
    EXPECT_EQ(spec.full_height, 48);
    EXPECT_EQ(read_image_float(folder / "a.exr").height, 6) << "reading gives the data window";
    const ImageInfo info = read_image_info(folder / "a.exr");
    EXPECT_EQ(info.data_window, (PixelRect{10, 20, 15, 26}));
    EXPECT_EQ(info.display_window, (PixelRect{0, 0, 64, 48}));
}

TEST(WriteImage, ExrTakesAnyChannelNames) {
    const TemporaryFolder folder;
    const ImageF image = make_gradient(3, 3, 2);
    write_image(folder / "a.exr", image, {.depth = PixelDepth::Float, .channel_names = {"variance.R", "variance.G"}});
    EXPECT_EQ(spec_of(folder / "a.exr").channelnames, (std::vector<std::string>{"variance.R", "variance.G"}));
    EXPECT_EQ(read_image_float(folder / "a.exr").pixels, image.pixels);
}

TEST(WriteImage, ExrOfSeveralParts) {
    const TemporaryFolder folder;
    const ImageF first = make_gradient(5, 3, 3);
    const ImageF second = make_gradient(5, 3, 4);
    write_image_parts(folder / "a.exr", std::vector<ImagePart>{{"one", &first}, {"two", &second}},
                      {.depth = PixelDepth::Float, .attributes = {{"oiio:ColorSpace", std::string("ACEScg")}}});
    EXPECT_EQ(folder.file_count(), 1u) << "no temporary file stays";
    const auto input = OIIO::ImageInput::open((folder / "a.exr").string());
    ASSERT_TRUE(input) << OIIO::geterror();
    for (int part = 0; part < 2; ++part) {
        ASSERT_TRUE(input->seek_subimage(part, 0));
        EXPECT_EQ(input->spec().get_string_attribute("name"), part == 0 ? "one" : "two");
        EXPECT_EQ(input->spec().get_string_attribute("oiio:ColorSpace"), "ACEScg");
        const ImageF& image = part == 0 ? first : second;
        std::vector<float> pixels(image.pixels.size());
        ASSERT_TRUE(input->read_image(part, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, pixels.data()));
        EXPECT_EQ(pixels, image.pixels);
    }
    EXPECT_FALSE(input->seek_subimage(2, 0));
}

TEST(WriteImage, PngRoundsToNearestAndClamps) {
    const TemporaryFolder folder;
    ImageF image(4, 1, 4);
    image.pixels = {0.0f,
                    1.0f,
                    -3.0f,
                    2.0f,
                    0.49f / 255.0f,
                    0.51f / 255.0f,
                    127.4f / 255.0f,
                    0.0f,
                    127.6f / 255.0f,
                    254.51f / 255.0f,
                    std::nanf(""),
                    0.25f,
                    0.3f,
                    0.2f,
                    0.1f,
                    0.5f};
    write_image(folder / "a.png", image, {.depth = PixelDepth::UInt8});
    const Image8 back = read_image_8bit(folder / "a.png");
    // The last pixels show that colour is not multiplied with or divided by alpha.
    EXPECT_EQ(back.pixels, (std::vector<std::uint8_t>{0, 255, 0, 255, 0, 1, 127, 0, 128, 255, 0, 64, 77, 51, 26, 128}));
}

TEST(WriteImage, RefusesWhatTheFormatCannotHold) {
    const TemporaryFolder folder;
    const ImageF image = make_gradient(2, 2, 3);
    EXPECT_THROW(write_image(folder / "a.png", image, {.depth = PixelDepth::Half}), IoError);
    EXPECT_THROW(write_image(folder / "a.exr", image, {.depth = PixelDepth::UInt8}), IoError);
    EXPECT_THROW(write_image(folder / "a.gif", image, {.depth = PixelDepth::UInt8}), IoError);
    EXPECT_THROW(write_image(folder / "a.exr", ImageF(), {}), IoError);
    EXPECT_THROW(write_image(folder / "a.exr", image, {.channel_names = {"R"}}), IoError);
    EXPECT_EQ(folder.file_count(), 0u);
}

TEST(WriteImage, FailureNamesThePathAndKeepsTheOldFile) {
    const TemporaryFolder folder;
    const ImageF image = make_gradient(2, 2, 3);
    try {
        write_image(folder / "no/such/folder.exr", image, {});
        FAIL() << "nothing was thrown";
    } catch (const IoError& error) {
        EXPECT_NE(std::string(error.what()).find("no/such/folder.exr"), std::string::npos) << error.what();
    }
    EXPECT_EQ(folder.file_count(), 0u);
}

}  // namespace

}  // namespace etendue
