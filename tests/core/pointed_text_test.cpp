// Messages that point into a text.
#include "core/pointed_text.h"

#include <string>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(PointedText, PointsAtTheCharacter) {
    EXPECT_EQ(pointed_text("C X L", 2, 4), "    C X L\n      ^");
    EXPECT_EQ(pointed_text("C (D", 4, 2), "  C (D\n      ^") << "behind the end";
    EXPECT_EQ(pointed_text("", 0, 0), "\n^");
    EXPECT_EQ(pointed_text("ab", 99, 0), "ab\n  ^");
}

TEST(PointedText, CountsCharactersNotBytes) {
    EXPECT_EQ(pointed_text("é é L", 6, 0), "é é L\n    ^");
    EXPECT_EQ(pointed_text("C é", 2, 0), "C é\n  ^");
    EXPECT_EQ(pointed_text("C é", 3, 0), "C é\n  ^") << "within the character";
}

TEST(PointedText, StaysOnOneLine) {
    EXPECT_EQ(pointed_text("C\nD\tL", 2, 0), "C D L\n  ^");
    EXPECT_EQ(pointed_text("C\xff L", 3, 0), "C  L\n   ^") << "a byte of no character";
}

TEST(PointedText, ShowsWhatLiesAroundOnly) {
    const std::string text = std::string(100, 'a') + "X" + std::string(100, 'b');
    EXPECT_EQ(pointed_text(text, 100, 0),
              "..." + std::string(48, 'a') + "X" + std::string(23, 'b') + "...\n" + std::string(51, ' ') + "^");
    std::string accents;
    for (int i = 0; i < 100; ++i) accents += "é";
    const std::string shown = pointed_text(accents, 101, 0);
    EXPECT_EQ(shown.substr(0, 5), "...é") << "no half of a character";
}

TEST(PointedText, NamesACharacter) {
    EXPECT_EQ(character_at("C é L", 2), "é");
    EXPECT_EQ(character_at("C é L", 3), "é");
    EXPECT_EQ(character_at("CX", 1), "X");
    EXPECT_EQ(character_at("C\nD", 1), "\\x0a");
    EXPECT_EQ(character_at("C\xff", 1), "\\xff");
    EXPECT_EQ(character_at("C", 1), "end of text");
}

}  // namespace

}  // namespace etendue
