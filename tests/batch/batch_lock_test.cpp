#include "batch/batch_lock.h"

#include "core/error.h"
#include "program/forked.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "support/file_calls.h"

#include <chrono>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;

class BatchLockTest : public testing::Test {
  protected:
    /// The one lock file that is there.
    [[nodiscard]] fs::path lock_file() const { return *fs::directory_iterator(folder_ / ".etendue/locks"); }

    /// Leaves a lock behind whose owner is dead.
    void let_somebody_die(const std::string& image) const {
        const pid_t pid = run_forked([&]() -> int {
            const LockAttempt got = locks_.take(image);
            _exit(got.lock ? 0 : 1);  // without giving it up
        });
        int status = 0;
        waitpid(pid, &status, 0);
        EXPECT_EQ(status, 0);
    }

    /// Makes the lock one of another machine, touched so many seconds ago.
    void move_elsewhere(int seconds) const {
        std::string text = read_file(lock_file());
        text.replace(text.find("\"machine\":\""), 11, "\"machine\":\"elsewhere ");
        write_file(lock_file(), text);
        fs::last_write_time(lock_file(), fs::file_time_type::clock::now() - std::chrono::seconds(seconds));
    }

    TestFolder folder_;
    BatchLocks locks_{folder_.path()};
};

TEST_F(BatchLockTest, IsHeldUntilTheEndOfItsLife) {
    {
        const LockAttempt first = locks_.take("a/box");
        ASSERT_TRUE(first.lock);
        EXPECT_FALSE(first.lock->dead_owner());
        const LockAttempt second = locks_.take("a/box");
        EXPECT_FALSE(second.lock);
        EXPECT_EQ(second.holder, this_process());
        EXPECT_TRUE(locks_.take("a/ball").lock) << "another image";
    }
    EXPECT_TRUE(locks_.take("a/box").lock);
}

TEST_F(BatchLockTest, TellsItsHolderToWhoOnlyLooks) {
    EXPECT_FALSE(locks_.find_holder("box"));
    EXPECT_TRUE(list(folder_.path()).empty()) << "looking leaves no trace";
    let_somebody_die("box");
    EXPECT_FALSE(locks_.find_holder("box"));
    move_elsewhere(10);
    EXPECT_TRUE(locks_.find_holder("box"));
    move_elsewhere(1000);
    EXPECT_FALSE(locks_.find_holder("box"));
    const LockAttempt held = locks_.take("box");
    EXPECT_EQ(locks_.find_holder("box"), this_process());
}

TEST_F(BatchLockTest, LeavesNothingBehind) {
    { const LockAttempt got = locks_.take("box"); }
    locks_.tidy();
    EXPECT_TRUE(list(folder_.path()).empty());
    EXPECT_TRUE(locks_.take("box").lock) << "and what is missing is made again";
}

TEST_F(BatchLockTest, TidyingKeepsWhatIsHeldAndRemovesWhatTheDeadLeft) {
    let_somebody_die("left");
    const LockAttempt held = locks_.take("held");
    EXPECT_EQ(list(folder_ / ".etendue/locks").size(), 2u);
    locks_.tidy();
    EXPECT_EQ(list(folder_ / ".etendue/locks").size(), 1u);
    EXPECT_FALSE(locks_.take("held").lock);
}

TEST_F(BatchLockTest, IsTakenOverFromTheDeadAtOnce) {
    let_somebody_die("box");
    const LockAttempt got = locks_.take("box");
    ASSERT_TRUE(got.lock);
    ASSERT_TRUE(got.lock->dead_owner());
    EXPECT_EQ(got.lock->dead_owner()->host, this_process().host);
    EXPECT_NE(got.lock->dead_owner()->pid, this_process().pid);
}

TEST_F(BatchLockTest, OfAnotherMachineIsTakenOverWhenItWasNotTouchedForLong) {
    let_somebody_die("box");
    move_elsewhere(100);
    EXPECT_FALSE(locks_.take("box").lock);
    fs::last_write_time(lock_file(), fs::file_time_type::clock::now() - std::chrono::seconds(200));
    const LockAttempt got = locks_.take("box");
    ASSERT_TRUE(got.lock);
    EXPECT_TRUE(got.lock->dead_owner()->machine.starts_with("elsewhere"));
}

// Servers of network file systems have clocks of their own, which give files their times.
TEST_F(BatchLockTest, IsAsOldAsTheClockOfItsFilesSays) {
    for (const int ahead : {-1000, 1000}) {
        const ServerClock server{std::chrono::seconds(ahead)};
        const std::string image = fmt::format("box {}", ahead);
        let_somebody_die(image);
        move_elsewhere(100 - ahead);
        EXPECT_FALSE(locks_.take(image).lock) << "it is 100 s old: the server is ahead by " << ahead;
        move_elsewhere(200 - ahead);
        EXPECT_TRUE(locks_.take(image).lock) << "it is 200 s old: the server is ahead by " << ahead;
    }
}

TEST_F(BatchLockTest, IsOnTheDiskBeforeItIsHeld) {
    const FileCalls calls;
    const LockAttempt got = locks_.take("box");
    ASSERT_EQ(calls.all().size(), 1u);
    EXPECT_EQ(calls.all().front(),
              fmt::format("fsync {} {}", lock_file().filename().string(), fs::file_size(lock_file())));
}

TEST_F(BatchLockTest, ThatSaysNothingIsNobodysOnceItIsOld) {
    let_somebody_die("box");
    for (const char* text : {"", "{", "[]", R"({"host":"a","machine":"b","pid":"1","start_time":0})"}) {
        write_file(lock_file(), text);
        EXPECT_FALSE(locks_.take("box").lock) << "another machine may be writing it: " << text;
        locks_.tidy();
        EXPECT_TRUE(fs::exists(lock_file())) << text;
        fs::last_write_time(lock_file(), fs::file_time_type::clock::now() - std::chrono::seconds(200));
        EXPECT_TRUE(locks_.take("box").lock) << text;
        let_somebody_die("box");
    }
}

TEST_F(BatchLockTest, ThatIsAPipeIsNobodysAndNothingToWaitFor) {
    let_somebody_die("box");
    const fs::path file = lock_file();
    fs::remove(file);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_FALSE(locks_.find_holder("box"));
    EXPECT_TRUE(locks_.take("box").lock);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    locks_.tidy();
    EXPECT_TRUE(list(folder_.path()).empty());
}

TEST_F(BatchLockTest, IsTouchedAndTellsWhenItIsLost) {
    const BatchLocks eager(folder_.path(), {.between_touches = std::chrono::milliseconds(0)});
    LockAttempt got = eager.take("box");
    fs::last_write_time(lock_file(), fs::file_time_type::clock::now() - std::chrono::seconds(200));
    EXPECT_TRUE(got.lock->keep_alive());
    EXPECT_LT(fs::file_time_type::clock::now() - fs::last_write_time(lock_file()), std::chrono::seconds(100));
    // Another process takes this one for dead.
    move_elsewhere(1000);
    const LockAttempt other = locks_.take("box");
    EXPECT_TRUE(other.lock);
    EXPECT_FALSE(got.lock->keep_alive());
    got.lock.reset();
    EXPECT_TRUE(fs::exists(lock_file())) << "what is another's is left alone";
}

/// Seen to fail without the mutex.
TEST_F(BatchLockTest, OnlyOneOfManyTakesOverWhatADeadOneLeft) {
    constexpr int kProcesses = 6;
    constexpr int kRounds = 20;
    for (int round = 0; round < kRounds; ++round) {
        const std::string image = fmt::format("image {}", round);
        let_somebody_die(image);
        const fs::path begin = folder_ / fmt::format("begin {}", round);
        const auto tried = [&](int i) { return folder_ / fmt::format("tried {} {}", round, i); };
        for (int i = 0; i < kProcesses; ++i) {
            (void)run_forked([&] {
                if (!wait_until([&] { return fs::exists(begin); }, std::chrono::microseconds(100))) return 0;
                const LockAttempt got = locks_.take(image);
                write_file(tried(i), "");
                // Who ends too early is dead, and others may take over.
                for (int other = 0; other < kProcesses; ++other)
                    (void)wait_until([&] { return fs::exists(tried(other)); });
                return got.lock ? 1 : 0;
            });
        }
        write_file(begin, "");
        int winners = 0;
        for (int i = 0; i < kProcesses; ++i) {
            int status = 0;
            ASSERT_GT(wait(&status), 0);
            winners += WEXITSTATUS(status);
        }
        ASSERT_EQ(winners, 1) << "round " << round;
    }
}

TEST_F(BatchLockTest, WhereNothingCanBeWrittenIsAnError) {
    write_file(folder_ / "file", "");
    EXPECT_THROW((void)BatchLocks(folder_ / "file").take("box"), IoError);
    EXPECT_THROW((void)BatchLocks("/proc/self").take("box"), IoError);
    EXPECT_THROW(BatchLocks("/proc/self").require(), IoError);
}

}  // namespace

}  // namespace etendue::test
