#include "image/encoded_format.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace etendue {

namespace {

using namespace std::string_view_literals;

std::string name_of(std::string_view head) {
    const auto format = detect_format(std::as_bytes(std::span(head)));
    return format ? std::string(format->name) : "";
}

TEST(DetectFormat, KnowsFormatsByTheirFirstBytes) {
    EXPECT_EQ(name_of("\x89PNG\r\n\x1a\n...."), "png");
    EXPECT_EQ(name_of("\xff\xd8\xff\xe0"), "jpeg");
    EXPECT_EQ(name_of("\x76\x2f\x31\x01"), "openexr");
    EXPECT_EQ(name_of("#?RADIANCE\n"), "hdr");
    EXPECT_EQ(name_of("#?RGBE\n"), "hdr");
    for (const std::string_view tiff : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}) EXPECT_EQ(name_of(tiff), "tiff");
}

TEST(DetectFormat, AnimationsStandForFewerPixels) {
    const auto expansion = [](std::string_view head) {
        return detect_format(std::as_bytes(std::span(head)))->max_expansion;
    };
    const std::int64_t still = expansion("RIFF....WEBPVP8X\x0a\0\0\0\x10\0\0\0......"sv);
    EXPECT_EQ(still, expansion("RIFF....WEBPVP8L................"sv));
    EXPECT_LT(expansion("RIFF....WEBPVP8X\x0a\0\0\0\x12\0\0\0......"sv), still / 100);
}

TEST(DetectFormat, KnowsNothingElse) {
    EXPECT_EQ(name_of(""), "");
    EXPECT_EQ(name_of("\x89PN"), "") << "a cut magic number is none";
    EXPECT_EQ(name_of("glTF, which is no image"), "");
}

}  // namespace

}  // namespace etendue
