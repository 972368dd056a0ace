#include "process/process_owner.h"

#include "program/forked.h"

#include <csignal>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace etendue::test {

namespace {

TEST(ProcessOwner, ThisProcessLives) {
    const ProcessOwner self = this_process();
    EXPECT_EQ(self.pid, getpid());
    EXPECT_GT(self.start_time, 0u);
    EXPECT_FALSE(self.host.empty());
    EXPECT_EQ(liveness(self), Liveness::Alive);
}

TEST(ProcessOwner, ANumberThatWasUsedAgainIsOfAnother) {
    ProcessOwner earlier = this_process();
    --earlier.start_time;
    EXPECT_EQ(liveness(earlier), Liveness::Dead);
}

TEST(ProcessOwner, OfOtherMachinesNothingIsKnown) {
    ProcessOwner other = this_process();
    other.machine += "x";
    EXPECT_EQ(liveness(other), Liveness::Unknown);
}

TEST(ProcessOwner, IsDeadAsSoonAsItHasEndedEvenIfNobodyAsked) {
    ProcessOwner child = this_process();
    const pid_t pid = run_forked([] { return pause(); });
    child.pid = pid;
    EXPECT_NE(liveness(child), Liveness::Unknown);
    kill(pid, SIGKILL);
    siginfo_t ended{};
    ASSERT_EQ(waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOWAIT), 0);
    EXPECT_EQ(liveness(child), Liveness::Dead);
    waitpid(pid, nullptr, 0);
    EXPECT_EQ(liveness(child), Liveness::Dead);
}

}  // namespace

}  // namespace etendue::test
