#include "batch/batch_progress.h"

#include "core/error.h"
#include "program/small_files.h"
#include "session/usage_error.h"

#include <array>
#include <chrono>
#include <ctime>
#include <optional>
#include <regex>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace etendue::test {

namespace {

constexpr std::nullopt_t kNotKnown = std::nullopt;

TEST(TimeLeft, IsTheSumOfTheEstimates) {
    TimeLeft time;
    time.add(10.0);
    time.add(30.0);
    EXPECT_EQ(time.left(), 40.0);
    time.begin(0, 10.0, 1.0);
    EXPECT_EQ(time.left(), 40.0);
    time.follow(0, 4.0, 0.01);
    EXPECT_EQ(time.left(), 36.0);
}

TEST(TimeLeft, IsCorrectedByWhatHasFinished) {
    TimeLeft time;
    time.add(10.0);
    time.add(30.0);
    time.begin(0, 10.0, 1.0);
    time.end(0, 20.0);
    EXPECT_EQ(time.left(), 60.0) << "it all takes twice as long";
    time.begin(1, 30.0, 1.0);
    time.follow(1, 15.0, 0.01);
    EXPECT_EQ(time.left(), 45.0);
    time.follow(1, 15.0, 0.5);
    EXPECT_EQ(time.left(), 15.0) << "the image under way knows better";
    time.follow(1, 1.0, 0.5, 100.0);
    EXPECT_EQ(time.left(), 100.0) << "half was done before";
    time.follow(1, 100.0, 0.01);
    EXPECT_EQ(time.left(), 0.0) << "never less than nothing";
}

TEST(TimeLeft, WithoutEstimatesIsTheMeanOfWhatHasFinished) {
    TimeLeft time;
    for (int i = 0; i < 3; ++i) time.add(kNotKnown);
    EXPECT_EQ(time.left(), kNotKnown);
    time.begin(0, kNotKnown, 1.0);
    time.follow(0, 1.0, 0.01);
    EXPECT_EQ(time.left(), kNotKnown);
    time.follow(0, 1.0, 0.25);
    EXPECT_EQ(time.left(), 3.0 + 2 * 4.0) << "by the image under way";
    time.end(0, 6.0);
    EXPECT_EQ(time.left(), 12.0);
    time.begin(1, kNotKnown, 1.0);
    time.end(1, kNotKnown);
    EXPECT_EQ(time.left(), 6.0) << "one that failed at once says nothing";
}

TEST(TimeLeft, CountsImagesAtTheSameTimeByTheirShareOfTheThreads) {
    TimeLeft time;
    for (const double seconds : {10.0, 10.0, 20.0}) time.add(seconds);
    time.begin(0, 10.0, 0.5);
    time.begin(1, 10.0, 0.5);
    EXPECT_EQ(time.left(), 40.0) << "two at a time take twice as long each";
    time.follow(0, 4.0, 0.0);
    time.follow(1, 4.0, 0.5);
    EXPECT_EQ(time.left(), (10.0 - 2.0) + (4.0 - 2.0) + 20.0);
    time.end(0, 20.0);
    time.end(1, 20.0);
    EXPECT_EQ(time.left(), 20.0) << "they took what was expected";
    time.begin(2, 20.0, 0.25);
    EXPECT_EQ(time.left(), 80.0) << "the longest ends last, whatever is idle";
}

TEST(FormatCount, TellsOfFailuresOnlyWhereThereAreSome) {
    EXPECT_EQ(format_count(7, 0, 8), "[7/8] ");
    EXPECT_EQ(format_count(7, 1, 8), "[7/8, 1 failed] ");
}

TEST(FormatLine, TellsHowFarTheBatchIs) {
    const BatchProgressLine line{
        .done = 12, .failed = 1, .of = 40, .under_way = {{"box frame 7", "43%"}}, .elapsed = 62.0, .left = 750.0};
    EXPECT_TRUE(
        format_line(line, 100).starts_with("[12/40, 1 failed] box frame 7: 43%  1:02 elapsed, 12:30 left, ends "))
        << format_line(line, 100);
    EXPECT_EQ(format_line({.done = 1, .of = 3, .under_way = {{"box", "load"}}}, 100), "[1/3] box: load  0.0 s elapsed");
}

TEST(FormatLine, FitsTheTerminalAndKeepsTheEndOfTheName) {
    const BatchProgressLine line{.done = 1, .of = 3, .under_way = {{"a/very/long/name frame 7", "43%"}}};
    const std::string whole = format_line(line, 200);
    for (int width = 0; width < 200; ++width)
        EXPECT_LE(format_line(line, width).size(), static_cast<std::size_t>(width)) << width;
    EXPECT_EQ(format_line(line, static_cast<int>(whole.size()) - 1).substr(0, 29), "[1/3] ...ry/long/name frame 7");
}

TEST(FormatLine, ListsImagesAtTheSameTimeAndCountsThoseWithoutRoom) {
    const BatchProgressLine line{
        .done = 1, .of = 9, .under_way = {{"shots/a", "43%"}, {"shots/b", "load"}, {"c", "9%"}}};
    const std::string whole = "[1/9] shots/a: 43%, shots/b: load, c: 9%  0.0 s elapsed";
    EXPECT_EQ(format_line(line, 100), whole);
    const int width = static_cast<int>(whole.size());
    EXPECT_EQ(format_line(line, width), whole);
    EXPECT_EQ(format_line(line, width - 1), "[1/9] shots/a: 43%, shots/b: load, +1  0.0 s elapsed");
    EXPECT_EQ(format_line(line, width - 5), "[1/9] shots/a: 43%, +2  0.0 s elapsed");
    EXPECT_EQ(format_line(line, 36), "[1/9] ...s/a: 43%, +2  0.0 s elapsed");
    for (int narrow = 0; narrow < width; ++narrow)
        EXPECT_LE(format_line(line, narrow).size(), static_cast<std::size_t>(narrow)) << narrow;
}

TEST(FormatClock, NamesTheDayUnlessItIsToday) {
    std::tm noon{};
    noon.tm_year = 126;
    noon.tm_mon = 10;
    noon.tm_mday = 28;
    noon.tm_hour = 12;
    const auto now = std::chrono::system_clock::from_time_t(std::mktime(&noon));
    EXPECT_EQ(format_clock(now + std::chrono::minutes(95), now), "13:35");
    EXPECT_EQ(format_clock(now + std::chrono::hours(13), now), "Sun 01:00");
    EXPECT_EQ(format_clock(now + std::chrono::days(9), now), "2026-12-07 12:00");
}

TEST(BatchProgress, SaysWhenSomethingFailed) {
    testing::internal::CaptureStderr();
    BatchProgress(true).say_error("error: no");
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(std::regex_match(said, std::regex(R"(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d  error: no\n)"))) << said;
}

/// As tests capture stderr in a file, it is no terminal.
TEST(BatchProgress, WritesALineWithTheTimeWhereThereIsNoTerminal) {
    testing::internal::CaptureStderr();
    {
        const std::chrono::milliseconds no_pause(0);
        BatchProgress(false, {}, no_pause).update({.done = 1, .of = 3, .under_way = {{"box", "43%"}}, .left = 60.0});
        BatchProgress(false).update({.done = 2, .of = 3});
        BatchProgress(true, {}, no_pause).update({.done = 3, .of = 3});
    }
    const std::string said = testing::internal::GetCapturedStderr();
    const std::regex line(R"(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d  \[1/3\] box: 43%  .* elapsed, 1:00 left, ends .*\n)");
    EXPECT_TRUE(std::regex_match(said, line)) << "one line, as the others are not due or quiet: " << said;
}

TEST(BatchLog, HasEveryLineWithItsTime) {
    const TestFolder folder;
    {
        BatchProgress progress(true, folder / "log", std::chrono::milliseconds(0));
        progress.say("2 of 3 images to render");
        progress.update({.done = 1, .of = 3, .under_way = {{"box", "43%"}}, .left = 60.0});
    }
    BatchProgress(true, folder / "log").say("again");
    const std::string log = read_file(folder / "log");
    const std::regex lines(R"((\d{4}-\d\d-\d\d \d\d:\d\d:\d\d  )2 of 3 images to render\n)"
                           R"((.{19}  )\[1/3\] box: 43%  .* elapsed, 1:00 left, ends .*\n.{19}  again\n)");
    EXPECT_TRUE(std::regex_match(log, lines)) << log;
    EXPECT_THROW(BatchProgress(true, folder / "no/log"), UsageError);
}

TEST(BatchLog, MayBeADeviceAndNoPipe) {
    const TestFolder folder;
    ASSERT_EQ(::mkfifo((folder / "log").c_str(), 0600), 0);
    EXPECT_THROW(BatchProgress(true, folder / "log"), IoError);
    EXPECT_NO_THROW(BatchProgress(true, "/dev/null").say("nobody reads it"));
}

// Somebody may write "--log /dev/stdout" where that is a pipe to another program.
TEST(BatchLog, MayBeAPipeThatIsOpen) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    BatchProgress(true, fmt::format("/dev/fd/{}", ends[1])).say("again");
    std::array<char, 100> text{};
    EXPECT_GT(::read(ends[0], text.data(), text.size()), 0);
    for (const int end : ends) ::close(end);
}

}  // namespace

}  // namespace etendue::test
