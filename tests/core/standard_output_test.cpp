#include "core/standard_output.h"

#include "core/error.h"

#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace etendue {

namespace {

TEST(StandardOutput, ShowsTextAndKeepsData) {
    testing::internal::CaptureStdout();
    print_text("a\x1b\n");
    print_data("b\x1b\n");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "a\\x1b\nb\x1b\n");
}

TEST(StandardOutput, FailsOnAFullDisk) {
    const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    ASSERT_GE(full, 0);
    const int saved = ::dup(STDOUT_FILENO);
    ::dup2(full, STDOUT_FILENO);
    std::string error;
    try {
        print_data("a");
    } catch (const IoError& failure) {
        error = failure.what();
    }
    ::dup2(saved, STDOUT_FILENO);
    ::close(saved);
    ::close(full);
    EXPECT_EQ(error, "cannot write to standard output: No space left on device");
}

}  // namespace

}  // namespace etendue
