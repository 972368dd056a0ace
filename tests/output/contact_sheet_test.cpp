#include "output/contact_sheet.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

namespace etendue {

namespace {

LabelledImage flat(const char* label, float value, int width = 12, int height = 9) {
    LabelledImage image{label, ImageF(width, height, 3)};
    std::ranges::fill(image.pixels.pixels, value);
    return image;
}

int count_of(const ImageF& sheet, float value) {
    return static_cast<int>(std::ranges::count(sheet.pixels, value)) / 3;
}

TEST(ContactSheet, ShowsEveryImageWhole) {
    const ImageF sheet = make_contact_sheet({{flat("", 0.25f)}, {flat("", 0.5f), flat("", 0.75f)}});
    for (const float value : {0.25f, 0.5f, 0.75f}) EXPECT_EQ(count_of(sheet, value), 12 * 9) << value;
    EXPECT_GT(sheet.width, 2 * 12);
    EXPECT_GT(sheet.height, 2 * 9);
}

TEST(ContactSheet, LabelsAreDrawnBesideTheImages) {
    const ImageF without = make_contact_sheet({{flat("", 0.25f)}});
    const ImageF with = make_contact_sheet({{flat("1", 0.25f)}});
    EXPECT_EQ(with.width, without.width);
    EXPECT_EQ(count_of(with, 0.25f), 12 * 9);
    // A 1 has ten pixels, each drawn as four.
    EXPECT_EQ(count_of(without, without.pixels[0]) - count_of(with, with.pixels[0]), 40);
}

TEST(ContactSheet, NarrowImagesStandAsFarApartAsTheirLabelsNeed) {
    // The same label under each of a row is drawn as often, with nothing over it.
    const ImageF none = make_contact_sheet({{flat("     ", 0.25f, 2)}});
    const ImageF one = make_contact_sheet({{flat("(8,8)", 0.25f, 2)}});
    const ImageF three =
        make_contact_sheet({{flat("(8,8)", 0.25f, 2), flat("(8,8)", 0.25f, 2), flat("(8,8)", 0.25f, 2)}});
    const int ink = count_of(none, none.pixels[0]) - count_of(one, one.pixels[0]);
    ASSERT_GT(ink, 0);
    EXPECT_EQ(three.width * three.height - 3 * 2 * 9 - count_of(three, three.pixels[0]), 3 * ink);
}

TEST(ContactSheet, RefusesNothingAndDifferentSizes) {
    EXPECT_THROW((void)make_contact_sheet({}), std::invalid_argument);
    EXPECT_THROW((void)make_contact_sheet({{}, {}}), std::invalid_argument);
    EXPECT_THROW((void)make_contact_sheet({{flat("", 0.1f), flat("", 0.1f, 13)}}), std::invalid_argument);
}

}  // namespace

}  // namespace etendue
