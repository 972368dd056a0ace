#include "core/log.h"

#include <string>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(Log, WritesLinesFromItsLevelUp) {
    testing::internal::CaptureStderr();
    set_log_level(LogLevel::Warning);
    log_info("not {}", "this");
    log_warning("loaded {} of {}", 1, 2);
    log_error("failed");
    set_log_level(LogLevel::Off);
    log_error("silent");
    set_log_level(LogLevel::Info);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "loaded 1 of 2\nfailed\n");
}

TEST(Log, NamesInALineAddNoMessageAndMoveNoCursor) {
    testing::internal::CaptureStderr();
    log_warning("material '{}' is black", "a\x1b[2J\nerror: fake");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "material 'a\\x1b[2J\n  error: fake' is black\n");
}

TEST(Log, BracesInALineAreJustText) {
    testing::internal::CaptureStderr();
    log_line(LogLevel::Info, "a {} b {0} %s");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "a {} b {0} %s\n");
}

}  // namespace

}  // namespace etendue
