#include "output/data_image.h"

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace etendue {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

ImageF image_of(int channels, std::vector<float> values) {
    ImageF image(static_cast<int>(values.size()) / channels, 1, channels);
    image.pixels = std::move(values);
    return image;
}

using Values = std::vector<float>;

TEST(DataImage, DirectionsHaveZeroInTheMiddle) {
    const ImageF normals = image_of(3, {0.0f, 1.0f, -1.0f, 0.5f, -0.5f, 1.0009f});
    EXPECT_EQ(style_of_values(normals), DataStyle::Signed);
    EXPECT_EQ(show_data(normals, DataStyle::Signed).pixels.pixels, (Values{0.5f, 1.0f, 0.0f, 0.75f, 0.25f, 1.0f}));
    EXPECT_EQ(show_data(image_of(2, {0.0f, 1.0f}), DataStyle::Signed).pixels.pixels, (Values{0.5f, 1.0f, 0.0f}));
    EXPECT_EQ(style_of_values(image_of(3, {0.0f, 1.5f, 0.0f})), DataStyle::Range);
    EXPECT_EQ(style_of_values(image_of(1, {0.5f})), DataStyle::Range) << "a depth may be small";
}

TEST(DataImage, DepthsGoFromTheNearestToTheFarthest) {
    const DataPicture depth =
        show_data(image_of(1, {2.0f, 4.0f, 6.0f, kInfinity, 1e30f, std::nanf("")}), DataStyle::Range);
    EXPECT_EQ(depth.pixels.pixels, (Values{0, 0, 0, 0.5f, 0.5f, 0.5f, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0}));
    EXPECT_EQ(depth.made, "2 to 6 as black to white");
    EXPECT_EQ(show_data(image_of(1, {3.0f, 3.0f}), DataStyle::Range).pixels.pixels, Values(6, 0.0f)) << "all are equal";
    EXPECT_EQ(show_data(image_of(1, {kInfinity}), DataStyle::Range).pixels.pixels, Values(3, 1.0f)) << "nothing is hit";
}

TEST(DataImage, ChannelsHaveRangesOfTheirOwnUnlessToldOtherwise) {
    const ImageF positions = image_of(3, {0, 10, -4, 2, 30, 4});
    const DataPicture own = show_data(positions, DataStyle::Range);
    EXPECT_EQ(own.pixels.pixels, (Values{0, 0, 0, 1, 1, 1}));
    EXPECT_EQ(own.made, "0 to 2, 10 to 30, -4 to 4 as black to white");
    EXPECT_EQ(show_data(positions, DataStyle::Range, DataRange{0, 20}).pixels.pixels,
              (Values{0, 0.5f, 0, 0.1f, 1, 0.2f}));
}

TEST(DataImage, RangesMayBeAsWideAsFloats) {
    const float most = 9e9f;
    const Values shown = show_data(image_of(1, {-most, 0.0f, most}), DataStyle::Range).pixels.pixels;
    EXPECT_EQ(shown[0], 0.0f);
    EXPECT_EQ(shown[3], 0.5f);
    EXPECT_EQ(shown[6], 1.0f);
}

TEST(DataImage, IdsHaveColoursOfTheirOwn) {
    Values ids;
    for (int i = 0; i < 200; ++i) ids.push_back(static_cast<float>(i));
    const Values shown = show_data(image_of(1, ids), DataStyle::Ids).pixels.pixels;
    std::set<Values> colors;
    for (std::size_t i = 0; i < shown.size(); i += 3) colors.insert({shown[i], shown[i + 1], shown[i + 2]});
    EXPECT_EQ(colors.size(), 200u);
    EXPECT_EQ((Values{shown[0], shown[1], shown[2]}), Values(3, 0.0f)) << "0 is nothing";
}

TEST(DataImage, MattesAreWeighedByCoverage) {
    const Values whole = show_data(image_of(4, {7.0f, 1.0f, 0.0f, 0.0f}), DataStyle::Mattes).pixels.pixels;
    const Values other = show_data(image_of(4, {9.0f, 1.0f, 0.0f, 0.0f}), DataStyle::Mattes).pixels.pixels;
    const Values both = show_data(image_of(4, {7.0f, 0.75f, 9.0f, 0.25f}), DataStyle::Mattes).pixels.pixels;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(both[c], 0.75f * whole[c] + 0.25f * other[c]);
    EXPECT_EQ(show_data(image_of(4, {7.0f, std::nanf(""), 0, kInfinity}), DataStyle::Mattes).pixels.pixels,
              Values(3, 0.0f));
}

}  // namespace

}  // namespace etendue
