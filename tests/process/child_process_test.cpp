#include "process/child_process.h"

#include "core/error.h"
#include "program/forked.h"
#include "program/run_program.h"
#include "program/small_files.h"

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

ChildOptions shell(const std::string& script) {
    return {.program = "/bin/sh", .name = "sh", .arguments = {"-c", script}};
}

struct Finished {
    ChildEnd end{};
    Lines messages{};
    Lines progress{};
    Lines last{};
    std::string output{};
};

Finished finish(ChildProcess& child) {
    Finished result;
    while (child.wait(
        std::chrono::milliseconds(1000), [&](const std::string& line) { result.messages.push_back(line); },
        [&](const std::string& line) { result.progress.push_back(line); })) {
    }
    result.end = child.end();
    result.last.assign(child.last_messages().begin(), child.last_messages().end());
    result.output = child.output();
    return result;
}

Finished run_shell(const std::string& script) {
    ChildProcess child(shell(script));
    return finish(child);
}

bool is_running(int pid) {
    return kill(pid, 0) == 0;
}

TEST(ChildProcess, HandsOverAllThatItWrites) {
    const Finished result = run_shell("echo out; echo one >&2; echo p >&3; printf 'two\\nhalf' >&2; exit 7");
    EXPECT_EQ(result.end.exit_code, 7);
    EXPECT_EQ(result.end.signal, 0);
    EXPECT_EQ(result.output, "out\n");
    EXPECT_EQ(result.messages, (Lines{"one", "two", "half"}));
    EXPECT_EQ(result.last, result.messages);
    EXPECT_EQ(result.progress, Lines{"p"});
}

TEST(ChildProcess, KeepsTheLastLinesAndABoundedAmount) {
    const Finished result = run_shell(
        "i=0; while [ $i -lt 100 ]; do echo line $i >&2; i=$((i+1)); done; head -c 3000000 /dev/zero; "
        "head -c 3000000 /dev/zero >&2");
    EXPECT_EQ(result.messages.size(), 101u);
    ASSERT_EQ(result.last.size(), ChildProcess::kKeptLines);
    EXPECT_EQ(result.last.front(), "line 81");
    EXPECT_EQ(result.last.back().size(), ChildProcess::kLongestLine);
    EXPECT_EQ(result.output.size(), ChildOptions{}.most_output);
}

TEST(ChildProcess, SaysWhichSignalEndedIt) {
    const Finished result = run_shell("kill -SEGV $$");
    EXPECT_EQ(result.end.signal, SIGSEGV);
    EXPECT_EQ(signal_name(result.end.signal), "SIGSEGV");
    EXPECT_EQ(signal_name(999), "signal 999");
}

TEST(ChildProcess, PassesSignalsOn) {
    ChildProcess child(shell("trap 'echo caught >&2; exit 9' TERM; echo ready >&2; while :; do sleep 0.01; done"));
    const auto send_when_ready = [&](const std::string& line) {
        if (line == "ready") child.send(SIGTERM);
    };
    while (child.wait(std::chrono::milliseconds(100), send_when_ready, [](const std::string&) {})) {
    }
    EXPECT_EQ(child.end().exit_code, 9);
    EXPECT_EQ(child.last_messages().back(), "caught");
    child.send(SIGTERM);  // nobody gets it
}

TEST(ChildProcess, SeveralAreWaitedForTogether) {
    ChildProcess silent(shell("exec sleep 100"));
    ChildProcess ends(shell("sleep 0.05; echo over >&2"));
    const std::array<const ChildProcess*, 2> both{&silent, &ends};
    Lines messages;
    const auto take = [&](const std::string& line) { messages.push_back(line); };
    const auto start = std::chrono::steady_clock::now();
    do ChildProcess::wait_for_any(both, std::chrono::seconds(50));
    while (ends.wait(std::chrono::milliseconds(0), take, take));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(40));
    EXPECT_EQ(messages, Lines{"over"});
    EXPECT_TRUE(silent.wait(std::chrono::milliseconds(0), take, take));
    EXPECT_GT(silent.own_memory_bytes(), 0u);
    EXPECT_EQ(ends.own_memory_bytes(), 0u);
}

TEST(ChildProcess, AProgramThatCannotBeStartedIsAnError) {
    try {
        const ChildProcess child({.program = "/no/such/program"});
        FAIL();
    } catch (const IoError& error) {
        EXPECT_NE(std::string(error.what()).find("/no/such/program: No such file"), std::string::npos) << error.what();
    }
}

TEST(ChildProcess, GetsNoDescriptorsButItsOwn) {
    // What this process has got from its own parent, it does not pass on.
    const std::set<int> expected{0, 1, 2, 3};
    ChildProcess other(shell("exec sleep 100"));
    const Finished result = run_shell("ls /proc/self/fd");
    std::istringstream numbers(result.output);
    std::set<int> found;
    for (int fd = 0; numbers >> fd;) found.insert(fd);
    for (const int fd : expected) EXPECT_EQ(found.erase(fd), 1u) << fd;
    EXPECT_EQ(found.size(), 1u) << "the listing's own: " << result.output;
}

TEST(ChildProcess, HasAGroupOfItsOwnSoThatATerminalReachesOnlyTheParent) {
    const Finished result = run_shell("echo $$ $(cut -d' ' -f5 /proc/$$/stat)");
    const std::string pid = result.output.substr(0, result.output.find(' '));
    EXPECT_EQ(result.output, pid + " " + pid + "\n");
}

TEST(ChildProcess, HasTheMemoryLimitThatIsAskedFor) {
    ChildOptions options = shell("ulimit -d");
    EXPECT_EQ(run_shell("ulimit -d").output, "unlimited\n");
    options.memory_limit = 100u << 20;
    ChildProcess child(options);
    EXPECT_EQ(finish(child).output, "102400\n");
}

TEST(ChildProcess, IsKilledWithTheObject) {
    const TestFolder folder;
    int pid = 0;
    {
        ChildProcess child(
            shell(fmt::format("echo $$ > {0}.new; mv {0}.new {0}; exec sleep 1000", (folder / "pid").string())));
        ASSERT_TRUE(wait_until([&] { return fs::exists(folder / "pid"); }));
        pid = std::stoi(read_file(folder / "pid"));
        EXPECT_TRUE(is_running(pid));
    }
    EXPECT_FALSE(is_running(pid));
}

TEST(ChildProcess, DiesWhenItsParentIsKilled) {
    const TestFolder folder;
    const pid_t parent = run_forked([&] {
        const ChildProcess child(
            shell(fmt::format("echo $$ > {0}.new; mv {0}.new {0}; exec sleep 1000", (folder / "pid").string())));
        return pause();
    });
    ASSERT_TRUE(wait_until([&] { return fs::exists(folder / "pid"); }));
    const int pid = std::stoi(read_file(folder / "pid"));
    EXPECT_TRUE(is_running(pid));
    kill(parent, SIGKILL);
    waitpid(parent, nullptr, 0);
    // Whoever takes in orphans here may not ask for its end, hence not merely whether it is there.
    EXPECT_TRUE(wait_until([&] {
        return !is_running(pid) || read_file(fmt::format("/proc/{}/stat", pid)).find(") Z ") != std::string::npos;
    }));
}

}  // namespace

}  // namespace etendue::test
