#include "image/exr_header.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

// Magic, version, two attributes, the end of the header and a byte of pixels.
std::vector<std::uint8_t> make_header() {
    const std::string text("\x76\x2f\x31\x01\x02\0\0\0first\0string\0\x03\0\0\0abcsecond\0int\0\x04\0\0\0\0\0\0\0\0x",
                           49);
    return {text.begin(), text.end()};
}

TEST(RenameExrAttribute, RenamesInPlace) {
    auto bytes = make_header();
    ASSERT_TRUE(rename_exr_attribute(bytes, "second", "fourth"));
    auto expected = make_header();
    for (std::size_t i = 0; i < 6; ++i) expected[28 + i] = static_cast<std::uint8_t>("fourth"[i]);
    EXPECT_EQ(bytes, expected);
}

TEST(RenameExrAttribute, RenamesInEveryPart) {
    // Two headers, each ended by an empty name, and an empty header after them.
    const std::string header("first\0int\0\x04\0\0\0abcd\0", 19);
    const std::string text =
        std::string("\x76\x2f\x31\x01\x02\x10\0\0", 8) + header + header + std::string("\0first", 6);
    std::vector<std::uint8_t> bytes(text.begin(), text.end());
    ASSERT_TRUE(rename_exr_attribute(bytes, "first", "fifth"));
    const std::string renamed(bytes.begin(), bytes.end());
    EXPECT_EQ(renamed.substr(8, 5), "fifth");
    EXPECT_EQ(renamed.substr(8 + header.size(), 5), "fifth");
    EXPECT_EQ(renamed.substr(renamed.size() - 5), "first") << "pixels are no header";
}

TEST(RenameExrAttribute, LeavesEverythingElseAlone) {
    auto bytes = make_header();
    EXPECT_FALSE(rename_exr_attribute(bytes, "abc", "xyz")) << "a value is no name";
    EXPECT_FALSE(rename_exr_attribute(bytes, "first", "longer"));
    EXPECT_FALSE(rename_exr_attribute(bytes, "third", "third"));
    EXPECT_EQ(bytes, make_header());
}

TEST(RenameExrAttribute, StopsAtTheEndOfCutHeaders) {
    for (std::size_t length = 0; length < make_header().size(); ++length) {
        auto bytes = make_header();
        bytes.resize(length);
        EXPECT_FALSE(rename_exr_attribute(bytes, "missing", "missing")) << length;
    }
}

}  // namespace

}  // namespace etendue
