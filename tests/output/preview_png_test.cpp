#include "output/preview_png.h"

#include "core/error.h"
#include "image/read.h"
#include "test_frame.h"

#include <gtest/gtest.h>

namespace etendue {

namespace {

std::vector<std::uint8_t> preview_of(const OutputFrame& frame) {
    const TestFolder folder;
    write_preview_png(folder / "a.png", frame, ColorConfig::built_in());
    const Image8 image = read_image_8bit(folder / "a.png");
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(image.width, frame.pixels.width);
    EXPECT_EQ(image.height, frame.pixels.height);
    return image.pixels;
}

OutputFrame make_frame(int channels, std::vector<float> pixels) {
    OutputFrame frame;
    frame.pixels = ImageF(static_cast<int>(pixels.size()) / channels, 1, channels);
    frame.pixels.pixels = std::move(pixels);
    frame.working_space = "Linear Rec.709 (sRGB)";
    frame.display = "sRGB - Display";
    frame.view = "Un-tone-mapped";
    return frame;
}

// Of a window that goes beyond the image, the middle two of four pixels lie within.
TEST(PreviewPng, ShowsTheImageWithoutItsOverscan) {
    OutputFrame frame = make_frame(3, {0.18f, 0, 0, 0.5f, 0, 0, 0, 0, 1, 0, 0.5f, 0});
    frame.crop_x = -1;
    frame.full_width = 2;
    frame.full_height = 1;
    const TestFolder folder;
    write_preview_png(folder / "a.png", frame, ColorConfig::built_in());
    const Image8 image = read_image_8bit(folder / "a.png");
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.height, 1);
    EXPECT_EQ(image.pixels, (std::vector<std::uint8_t>{188, 0, 0, 0, 0, 255}));
    // A window that lies beside the image is shown as it is.
    frame.crop_x = 5;
    EXPECT_EQ(preview_of(frame).size(), 12u);
}

// sRGB of 0.18, 0.5 and 0.21586: IEC 61966-2-1:1999, rounded to 8 bits.
TEST(PreviewPng, KnownColoursHaveKnownBytes) {
    const OutputFrame frame = make_frame(3, {0.0f, 1.0f, 0.18f, 0.5f, 0.21586f, 2.0f, -0.1f, 0.0005f, 0.9f});
    EXPECT_EQ(preview_of(frame), (std::vector<std::uint8_t>{0, 255, 118, 188, 128, 255, 0, 2, 243}));
}

TEST(PreviewPng, ExposureIsInStops) {
    OutputFrame frame = make_frame(3, {0.09f, 0.125f, 0.0535103f});
    frame.exposure = 1.0f;
    const auto doubled = preview_of(frame);
    EXPECT_EQ(doubled, preview_of(make_frame(3, {0.18f, 0.25f, 0.1070206f})));
    EXPECT_EQ(doubled[0], 118);
}

// Associated alpha over black: the colours as they are, whatever alpha is.
TEST(PreviewPng, TransparentPixelsLieOverBlack) {
    EXPECT_EQ(preview_of(make_frame(4, {0.18f, 0.5f, 1.0f, 0.25f, 0.0f, 0.0f, 0.0f, 0.0f})),
              (std::vector<std::uint8_t>{118, 188, 255, 0, 0, 0}));
}

TEST(PreviewPng, EmptyNamesAreTheDefaults) {
    OutputFrame explicit_frame = make_frame(3, {0.18f, 0.18f, 0.18f, 0.6f, 0.1f, 0.05f});
    explicit_frame.view = "ACES 1.0 - SDR Video";
    OutputFrame default_frame = explicit_frame;
    default_frame.display.clear();
    default_frame.view.clear();
    const auto bytes = preview_of(default_frame);
    EXPECT_EQ(bytes, preview_of(explicit_frame));
    EXPECT_EQ(bytes[0], 91) << "0.355954 of 18% grey, as ocioconvert shows it";
}

TEST(PreviewPng, UnknownViewsAndFoldersAreErrors) {
    const TestFolder folder;
    OutputFrame frame = make_frame(3, {0.0f, 0.0f, 0.0f});
    EXPECT_THROW(write_preview_png(folder / "missing/a.png", frame, ColorConfig::built_in()), IoError);
    frame.view = "no such view";
    EXPECT_THROW(write_preview_png(folder / "a.png", frame, ColorConfig::built_in()), SceneError);
    frame = make_frame(1, {0.0f});
    EXPECT_THROW(write_preview_png(folder / "a.png", frame, ColorConfig::built_in()), IoError);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

}  // namespace

}  // namespace etendue
