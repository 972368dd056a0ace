#include "core/shown_text.h"

#include <string>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(ShownText, LeavesReadableTextAlone) {
    for (const char* text : {"", "Bühne 3", "名前", "a\\b", "\U0001F600", "می\u200cخواهم"})
        EXPECT_EQ(shown_text(text), text);
}

TEST(ShownText, NumbersWhatWouldMoveTheCursorOrTurnTheText) {
    EXPECT_EQ(shown_text("a\x1b[31mb"), "a\\x1b[31mb");
    EXPECT_EQ(shown_text("a\nb\tc\x7f"), "a\\x0ab\\x09c\\x7f");
    EXPECT_EQ(shown_text(std::string("a\0b", 3)), "a\\x00b");
    EXPECT_EQ(shown_text("a\u009bb"), "a\\u{9b}b") << "C1 controls";
    for (const char* mark : {"\u061c", "\u200e", "\u202e", "\u2028", "\u2066", "\ufeff"})
        EXPECT_EQ(shown_text(mark).substr(0, 3), "\\u{") << mark;
}

TEST(ShownText, NumbersBytesThatAreNoCharacter) {
    EXPECT_EQ(shown_text("a\xff\xc3"), "a\\xff\\xc3");
    EXPECT_EQ(shown_text("\xc0\x9b"), "\\xc0\\x9b") << "longer than it needs to be";
    EXPECT_EQ(shown_text("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a pair";
    EXPECT_EQ(shown_text("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
}

TEST(Shown, CutsBetweenCharacters) {
    EXPECT_EQ(shown("a\nb"), "a\\x0ab");
    EXPECT_EQ(shown(std::string(79, 'x') + "éé"), std::string(79, 'x') + "...");
    EXPECT_EQ(shown(std::string(78, 'x') + "é"), std::string(78, 'x') + "é");
    EXPECT_EQ(last_characters("aéb", 2), "b");
    EXPECT_EQ(last_characters("aéb", 3), "éb");
}

TEST(ShownLines, KeepsLinesAndNothingElse) {
    EXPECT_EQ(shown_lines("a\n\x1b\n"), "a\n\\x1b\n");
    EXPECT_EQ(shown_message("error: a\nerror: b\n   c\n"), "error: a\n  error: b\n   c\n");
}

}  // namespace

}  // namespace etendue
