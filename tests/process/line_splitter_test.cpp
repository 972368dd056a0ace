#include "process/line_splitter.h"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

std::vector<std::string> lines_of(LineSplitter splitter, const std::vector<std::string_view>& pieces) {
    std::vector<std::string> lines;
    const auto take = [&lines](const std::string& line) { lines.push_back(line); };
    for (const std::string_view piece : pieces) splitter.add(piece, take);
    splitter.finish(take);
    return lines;
}

TEST(LineSplitter, PiecesMayEndAnywhere) {
    const std::vector<std::string> wanted{"one", "", "two", "three"};
    EXPECT_EQ(lines_of(LineSplitter(100), {"one\n\ntwo\nthree"}), wanted);
    EXPECT_EQ(lines_of(LineSplitter(100), {"o", "ne", "\n", "\nt", "wo\nthree", "\n"}), wanted);
    EXPECT_TRUE(lines_of(LineSplitter(100), {}).empty());
}

TEST(LineSplitter, LongLinesAreCutAndTheNextIsWhole) {
    EXPECT_EQ(lines_of(LineSplitter(4), {"abc", "defg", "h\nxy"}), (std::vector<std::string>{"abcd", "xy"}));
    EXPECT_EQ(lines_of(LineSplitter(4), {"abcdefgh"}), (std::vector<std::string>{"abcd"}));
}

}  // namespace

}  // namespace etendue::test
