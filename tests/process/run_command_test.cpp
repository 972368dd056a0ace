#include "process/run_command.h"

#include "core/error.h"

#include <chrono>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(RunCommand, TellsWhatTheProgramWroteAndHowItEnded) {
    const CommandResult result = run_command({"sh", "-c", "echo \"$1\"; echo oops >&2; cat; exit 7", "sh", "a b; $x"});
    EXPECT_EQ(result.exit_code, 7);
    EXPECT_EQ(result.out, "a b; $x\n");
    EXPECT_EQ(result.err, "oops\n");
    EXPECT_EQ(run_command({"sh", "-c", "kill -9 $$"}).exit_code, 128 + 9);
}

/// More than a pipe holds, to both sides.
TEST(RunCommand, ReadsMuchOfBothOutputs) {
    const CommandResult result =
        run_command({"sh", "-c", "head -c 1000000 /dev/zero >&2; head -c 1500000 /dev/zero; echo end"});
    EXPECT_EQ(result.out.size(), 1500004u);
    EXPECT_EQ(result.err.size(), 1000000u);
}

TEST(RunCommand, DoesNotWaitForWhatTheProgramHasLeftBehind) {
    const auto start = std::chrono::steady_clock::now();
    const CommandResult result = run_command({"sh", "-c", "sleep 30 & echo left"});
    EXPECT_EQ(result.out, "left\n");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(15));
}

TEST(RunCommand, SaysThatThereIsNoSuchProgram) {
    try {
        (void)run_command({"no-such-program"});
        FAIL();
    } catch (const IoError& error) {
        EXPECT_STREQ(error.what(), "cannot run no-such-program: No such file or directory");
    }
}

}  // namespace

}  // namespace etendue::test
