#include "output/aces_file.h"

#include "core/error.h"
#include "image/read.h"
#include "output/exr_driver.h"
#include "support/aces_container.h"
#include "support/temporary_folder.h"
#include "test_frame.h"

#include <cmath>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

namespace etendue {

namespace {

using test::AcesContainerCheck;
using Lines = std::vector<std::string>;

OutputFrame whole_frame(int channels) {
    OutputFrame frame = make_test_frame();
    frame.crop_x = frame.crop_y = frame.full_width = frame.full_height = 0;
    if (channels == 3) frame.pixels = ImageF(3, 2, 3);
    return frame;
}

std::vector<std::byte> written(const OutputFrame& frame) {
    const TestFolder folder;
    write_aces(folder / "a.exr", frame, ColorConfig::built_in());
    return read_all(folder / "a.exr");
}

TEST(AcesFile, SatisfiesTheStandard) {
    EXPECT_EQ(AcesContainerCheck::violations(written(whole_frame(4))), Lines());
    EXPECT_EQ(AcesContainerCheck::violations(written(whole_frame(3))), Lines());
    EXPECT_EQ(AcesContainerCheck::violations(written(make_test_frame())), Lines()) << "a crop window";
}

/// So that the check above means something: an ordinary EXR fails it on most counts, a damaged one on one.
TEST(AcesFile, TheCheckFindsWhatIsWrong) {
    const TestFolder folder;
    ExrDriver(folder / "a.exr", ColorConfig::built_in()).write(whole_frame(4));
    const Lines found = AcesContainerCheck::violations(read_all(folder / "a.exr"));
    const auto has = [&](const char* line) { return std::ranges::find(found, line) != found.end(); };
    EXPECT_TRUE(has("it is compressed"));
    EXPECT_TRUE(has("acesImageContainerFlag is missing"));
    EXPECT_TRUE(has("worldToCamera is a m44f, which is no type of them"));
    EXPECT_TRUE(has("chromaticity 0"));
    std::vector<std::byte> damaged = written(whole_frame(4));
    damaged[4] = std::byte{2 + 8};
    EXPECT_EQ(AcesContainerCheck::violations(damaged).size(), 1u);
    damaged = written(whole_frame(4));
    damaged.push_back(std::byte{0});
    EXPECT_EQ(AcesContainerCheck::violations(damaged), Lines{"the file is not as long as its lines are"});
}

TEST(AcesFile, ConvertsToAces) {
    OutputFrame frame = whole_frame(3);
    frame.working_space = "Linear Rec.709 (sRGB)";
    frame.pixels = ImageF(2, 1, 4);
    frame.pixels.pixels = {1.0f, 0.0f, 0.0f, 0.5f, 0.18f, 0.18f, 0.18f, 1.0f};
    const TestFolder folder;
    write_aces(folder / "a.exr", frame, ColorConfig::built_in());
    const ImageF back = read_image_float(folder / "a.exr");
    // The first column of Rec.709 to AP0, Bradford: AMPAS, ACES 1.3.
    const std::array<float, 8> expected{0.4397010f, 0.0897923f, 0.0175440f, 0.5f, 0.18f, 0.18f, 0.18f, 1.0f};
    ASSERT_EQ(back.pixels.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(back.pixels[i], expected[i], expected[i] * std::exp2(-11.0f) + 1e-6f) << i;
    EXPECT_TRUE(read_image_info(folder / "a.exr").is_aces_container);
}

TEST(AcesFile, HoldsOnlyValidValues) {
    OutputFrame frame = whole_frame(3);
    frame.working_space = "ACES2065-1";
    const float infinity = std::numeric_limits<float>::infinity();
    frame.pixels = ImageF(2, 1, 3);
    frame.pixels.pixels = {std::nanf(""), infinity, -infinity, 1e9f, -2.0f, 0.5f};
    const TestFolder folder;
    write_aces(folder / "a.exr", frame, ColorConfig::built_in());
    EXPECT_EQ(read_image_float(folder / "a.exr").pixels,
              (std::vector<float>{0.0f, 65504.0f, -65504.0f, 65504.0f, -2.0f, 0.5f}));
    EXPECT_EQ(AcesContainerCheck::violations(read_all(folder / "a.exr")), Lines());
}

TEST(AcesFile, NeedsAces) {
    const TestFolder folder;
    std::ofstream(folder / "config.ocio") << "ocio_profile_version: 1\nsearch_path: \"\"\n"
                                             "roles: {default: linear, scene_linear: linear}\n"
                                             "displays:\n  s:\n    - !<View> {name: v, colorspace: linear}\n"
                                             "colorspaces:\n  - !<ColorSpace>\n    name: linear\n";
    OutputFrame frame = whole_frame(3);
    frame.working_space = "linear";
    EXPECT_THROW(write_aces(folder / "a.exr", frame, ColorConfig::from_file(folder / "config.ocio")), SceneError);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

}  // namespace

}  // namespace etendue
