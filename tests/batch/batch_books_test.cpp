#include "batch/batch_books.h"

#include <chrono>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

TEST(OldestReports, AreAsOldAsTheyAreLargeAndSlowToWrite) {
    EXPECT_EQ(oldest_reports({}, 0), seconds(1));
    EXPECT_EQ(oldest_reports({}, 100), seconds(2));
    EXPECT_EQ(oldest_reports(milliseconds(10), 100), seconds(2)) << "writing takes little";
    EXPECT_EQ(oldest_reports(milliseconds(500), 100), seconds(10)) << "a twentieth of the time goes into writing";
}

TEST(OldestReports, AreNeverOlderThanAMinute) {
    EXPECT_EQ(oldest_reports(seconds(4), 1), minutes(1));
    EXPECT_EQ(oldest_reports({}, 100'000), minutes(1));
}

}  // namespace

}  // namespace etendue::test
