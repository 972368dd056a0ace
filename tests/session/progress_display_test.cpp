#include "session/progress_display.h"

#include <string>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(FormatDuration, ChangesUnitsAsItGrows) {
    EXPECT_EQ(format_duration(0.0), "0.0 s");
    EXPECT_EQ(format_duration(3.44), "3.4 s");
    EXPECT_EQ(format_duration(9.9), "9.9 s");
    EXPECT_EQ(format_duration(59.4), "0:59");
    EXPECT_EQ(format_duration(59.6), "1:00");
    EXPECT_EQ(format_duration(123.0), "2:03");
    EXPECT_EQ(format_duration(3599.7), "1:00:00");
    EXPECT_EQ(format_duration(3723.0), "1:02:03");
    EXPECT_EQ(format_duration(360000.0), "100:00:00");
}

TEST(FormatProgress, TellsShareTimesAndRates) {
    const RenderProgress progress{0.25, 30.0, 3'000'000, 60'000'000};
    const std::string line = format_progress("box", progress, 160);
    EXPECT_TRUE(line.starts_with("box [")) << line;
    EXPECT_NE(line.find(" 25%"), std::string::npos) << line;
    EXPECT_NE(line.find("0:30 elapsed"), std::string::npos) << line;
    EXPECT_NE(line.find("1:30 left"), std::string::npos) << line;
    EXPECT_NE(line.find("100 ksamples/s"), std::string::npos) << line;
    EXPECT_NE(line.find("2.0 Mrays/s"), std::string::npos) << line;
    EXPECT_NE(line.find("##########.............................."), std::string::npos) << line;
}

TEST(FormatProgress, HundredPercentOnlyWhenDone) {
    EXPECT_NE(format_progress("", {0.9999, 1.0, 1, 1}, 160).find(" 99%"), std::string::npos);
    EXPECT_NE(format_progress("", {1.0, 1.0, 1, 1}, 160).find("100%"), std::string::npos);
}

TEST(FormatProgress, FitsTheTerminal) {
    const RenderProgress progress{0.5, 100.0, 1, 1};
    for (int width = 0; width < 200; ++width)
        EXPECT_LE(format_progress("a scene with a long name", progress, width).size(), static_cast<std::size_t>(width));
}

TEST(FormatProgress, SurvivesTheVeryBeginning) {
    const std::string line = format_progress("box", {0.0, 0.0, 0, 0}, 160);
    EXPECT_NE(line.find("? left"), std::string::npos) << line;
    EXPECT_EQ(line.find("nan"), std::string::npos) << line;
    EXPECT_EQ(line.find("inf"), std::string::npos) << line;
}

}  // namespace

}  // namespace etendue::test
