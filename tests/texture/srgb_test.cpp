#include "texture/srgb.h"

#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(Srgb, TheTablesAreTheCurveAndTheStraightLine) {
    for (std::size_t i = 0; i < 256; ++i) {
        const double v = static_cast<double>(i) / 255.0;
        const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        EXPECT_EQ(srgb_decoding8()[i], static_cast<float>(linear)) << i;
        EXPECT_EQ(linear_from_srgb8(static_cast<std::uint8_t>(i)), static_cast<float>(linear)) << i;
        EXPECT_EQ(linear_decoding8()[i], static_cast<float>(i) * (1.0f / 255.0f)) << i;
    }
}

}  // namespace

}  // namespace etendue::test
