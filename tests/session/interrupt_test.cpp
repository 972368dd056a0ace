#include "session/interrupt.h"

#include "program/forked.h"

#include <csignal>
#include <functional>

#include <gtest/gtest.h>
#include <sys/wait.h>

namespace etendue::test {

namespace {

/// Exit code of a process that does `body`, and would end with 7.
int exit_code_of(const std::function<void()>& body) {
    const pid_t pid = run_forked([&] {
        install_interrupt_handlers();
        body();
        return interrupt_requested() ? 7 : 8;
    });
    int status = 0;
    EXPECT_EQ(waitpid(pid, &status, 0), pid);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Interrupt, IsARequest) {
    EXPECT_EQ(exit_code_of([] { std::raise(SIGINT); }), 7);
    EXPECT_EQ(exit_code_of([] {}), 8);
}

TEST(Interrupt, EndsTheProcessWhereThereIsNothingToKeep) {
    for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}, std::pair{SIGHUP, 143}})
        EXPECT_EQ(exit_code_of([&, number = signal] {
                      const NothingToKeep nothing;
                      std::raise(number);
                  }),
                  code);
}

TEST(Interrupt, IsARequestAgainWhereThereIsSomethingToKeep) {
    EXPECT_EQ(exit_code_of([] {
                  const NothingToKeep nothing;
                  const SomethingToKeep something;
                  std::raise(SIGINT);
              }),
              7);
    EXPECT_EQ(exit_code_of([] {
                  const NothingToKeep nothing;
                  { const SomethingToKeep something; }
                  std::raise(SIGINT);
              }),
              130);
    EXPECT_EQ(exit_code_of([] {
                  { const NothingToKeep nothing; }
                  std::raise(SIGINT);
              }),
              7);
}

/// A second signal to a process that another looks after is as the first, which it is obeying.
TEST(Interrupt, LeavesToAProcessThatStopsTheTimeItTakes) {
    EXPECT_EQ(exit_code_of([] {
                  take_all_interrupts_for_one();
                  const NothingToKeep nothing;
                  {
                      const SomethingToKeep something;
                      std::raise(SIGTERM);
                  }
                  std::raise(SIGTERM);
              }),
              7);
}

}  // namespace

}  // namespace etendue::test
