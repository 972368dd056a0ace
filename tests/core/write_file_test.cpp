#include "core/write_file.h"

#include "core/error.h"
#include "support/file_calls.h"
#include "support/temporary_folder.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <span>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

bool has_locks = true;

}  // namespace

/// The kernel's, in place of the C library's: or what it says of a file system that has none.
extern "C" int flock(int fd, int operation) noexcept {
    if (has_locks) return static_cast<int>(::syscall(SYS_flock, fd, operation));
    errno = ENOLCK;
    return -1;
}

namespace etendue {

namespace {

/// Takes the locks from all file systems while it lives.
class NoLocks {
  public:
    NoLocks() { has_locks = false; }
    ~NoLocks() { has_locks = true; }
    NoLocks(const NoLocks&) = delete;
    NoLocks& operator=(const NoLocks&) = delete;
};

std::string text_of(const std::filesystem::path& path) {
    const auto bytes = read_all(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(WriteText, WritesAndReplaces) {
    const TemporaryFolder folder;
    const auto path = folder / "a.json";
    write_text(path, "first");
    write_text(path, "2nd");
    EXPECT_EQ(text_of(path), "2nd");
    EXPECT_EQ(folder.file_count(), 1u) << "no temporary file stays";
}

TEST(WriteText, NamesMayBeAsLongAsTheFileSystemTakes) {
    const TemporaryFolder folder;
    const auto path = folder / (std::string(250, 'n') + ".json");
    write_text(path, "first");
    write_text(path, "2nd");
    EXPECT_EQ(text_of(path), "2nd");
    EXPECT_EQ(folder.file_count(), 1u);
}

// After a loss of power the name stands for all bytes or for the old ones: docs/reliability.md.
TEST(WriteFile, BytesAreOnTheDiskBeforeTheName) {
    const TemporaryFolder folder;
    const FileCalls calls;
    write_file(folder / "a.json", [&](const ByteSink& sink) {
        sink(std::as_bytes(std::span("first ", 6)));
        sink(std::as_bytes(std::span("second", 6)));
    });
    ASSERT_EQ(calls.all().size(), 2u);
    const std::string& synced = calls.all()[0];
    const std::string& renamed = calls.all()[1];
    ASSERT_TRUE(renamed.starts_with("rename .a.json.")) << renamed;
    EXPECT_EQ(synced, "fsync " + renamed.substr(7) + " 12");
}

TEST(WriteText, FollowsLinks) {
    const TemporaryFolder folder;
    write_text(folder / "target", "old");
    std::filesystem::create_symlink("target", folder / "link");
    write_text(folder / "link", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(text_of(folder / "target"), "new");
}

TEST(WriteText, ReportsPathAndReasonAndCreatesNoFolder) {
    const TemporaryFolder folder;
    const auto path = folder / "missing/a.json";
    try {
        write_text(path, "text");
        FAIL() << "nothing was thrown";
    } catch (const IoError& error) {
        EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos) << error.what();
    }
    EXPECT_EQ(folder.file_count(), 0u);
}

TEST(WriteText, FailsBelowAFile) {
    const TemporaryFolder folder;
    write_text(folder / "file", "text");
    EXPECT_THROW(write_text(folder / "file/a.json", "text"), IoError);
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(WriteText, FailsOnAFolderAndLeavesNothing) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "taken");
    EXPECT_THROW(write_text(folder / "taken", "text"), IoError);
    EXPECT_EQ(folder.file_count(), 1u);
}

// Files of this process cannot grow beyond `bytes` while it lives, as if the disk were full.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &old_limit_);
        const rlimit limit{bytes, old_limit_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &old_limit_);
        std::signal(SIGXFSZ, old_handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    rlimit old_limit_{};
    void (*old_handler_)(int);
};

TEST(WriteText, FailsOnAPipeThatNobodyReads) {
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_THROW(write_text(folder / "pipe", "text"), IoError);
    const int reader = ::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    ASSERT_GE(reader, 0);
    write_text(folder / "pipe", "text");
    std::array<char, 8> text{};
    EXPECT_EQ(::read(reader, text.data(), text.size()), 4);
    ::close(reader);
}

TEST(WriteText, AFailureHalfWayLeavesTheOldFileAndNoOther) {
    const TemporaryFolder folder;
    write_text(folder / "a.json", "old");
    {
        const FileSizeLimit limit(1024);
        try {
            write_text(folder / "a.json", std::string(5000, 'x'));
            ADD_FAILURE() << "it was written";
        } catch (const IoError& error) {
            const std::string text = error.what();
            EXPECT_NE(text.find("no file may have more than 1 KiB here; raise that limit (ulimit -f)"),
                      std::string::npos)
                << text;
        }
    }
    EXPECT_EQ(text_of(folder / "a.json"), "old");
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(WriteText, SeesAFullDisk) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this machine has no /dev/full";
    EXPECT_THROW(write_text("/dev/full", "text"), IoError);
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full")) << "a device must not be replaced";
}

TEST(WriteText, WritesDevicesInPlace) {
    write_text("/dev/null", "text");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

/// What a killed writer of `name` would leave, as the running one sees it.
std::filesystem::path temporary_of(const TemporaryFolder& folder, const std::string& name) {
    std::filesystem::path temporary;
    write_file(folder / name, [&](const ByteSink&) {
        for (const auto& entry : std::filesystem::directory_iterator(folder / "."))
            if (entry.path().extension() == ".tmp") temporary = entry.path();
    });
    EXPECT_FALSE(temporary.empty());
    return temporary.lexically_normal();
}

TEST(WriteFile, TakesOverWhatAKilledWriterLeft) {
    const TemporaryFolder folder;
    const auto left = temporary_of(folder, "a");
    std::ofstream(left) << "what was written before the kill, and is longer";
    write_text(folder / "a", "short");
    EXPECT_EQ(text_of(folder / "a"), "short");
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(WriteFile, APipeUnderItsTemporaryNameIsNothingToWaitFor) {
    const TemporaryFolder folder;
    const auto left = temporary_of(folder, "a");
    ASSERT_EQ(::mkfifo(left.c_str(), 0600), 0);
    write_text(folder / "a", "text");
    EXPECT_EQ(text_of(folder / "a"), "text");
    remove_abandoned_files_of(folder / "a");
    EXPECT_TRUE(std::filesystem::is_fifo(left)) << "another program's";
}

TEST(WriteFile, TwoWritersOfOneFileDoNotMixTheirBytes) {
    const TemporaryFolder folder;
    write_file(folder / "a", [&](const ByteSink& sink) {
        sink(std::as_bytes(std::span("first ", 6)));
        write_text(folder / "a", "second");
        EXPECT_EQ(text_of(folder / "a"), "second");
        EXPECT_EQ(remove_abandoned_files(folder / "."), 0u) << "it is not abandoned";
        sink(std::as_bytes(std::span("writer", 6)));
    });
    EXPECT_EQ(text_of(folder / "a"), "first writer") << "the last to finish";
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(WriteFile, TwoWritersOfOneFileDoNotMixTheirBytesWithoutLocksEither) {
    const NoLocks none;
    const TemporaryFolder folder;
    write_file(folder / "a", [&](const ByteSink& sink) {
        sink(std::as_bytes(std::span("first ", 6)));
        write_text(folder / "a", "second");
        EXPECT_EQ(text_of(folder / "a"), "second");
        EXPECT_EQ(remove_abandoned_files(folder / "."), 0u) << "it is not abandoned";
        remove_abandoned_files_of(folder / "a");
        sink(std::as_bytes(std::span("writer", 6)));
    });
    EXPECT_EQ(text_of(folder / "a"), "first writer") << "the last to finish";
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(RemoveAbandonedFiles, GoesByAgeWithoutLocks) {
    const NoLocks none;
    const TemporaryFolder folder;
    const auto left = temporary_of(folder, "a");
    std::ofstream(left) << "half";
    write_text(folder / "a", "whole");
    EXPECT_TRUE(std::filesystem::exists(left)) << "its writer may live";
    std::filesystem::last_write_time(left, std::filesystem::file_time_type::clock::now() - std::chrono::hours(2));
    EXPECT_EQ(remove_abandoned_files(folder / "."), 1u);
    EXPECT_FALSE(std::filesystem::exists(left));
    EXPECT_EQ(text_of(folder / "a"), "whole");
}

TEST(WriteFile, WhatThrowsLeavesNothing) {
    const TemporaryFolder folder;
    EXPECT_THROW(write_file(folder / "a", [](const ByteSink&) { throw IoError("no"); }), IoError);
    EXPECT_EQ(folder.file_count(), 0u);
}

TEST(RemoveAbandonedFiles, TakesThoseOfOneFile) {
    const TemporaryFolder folder;
    const auto left = temporary_of(folder, "a");
    const auto other = temporary_of(folder, "b");
    for (const auto& path : {left, other}) std::ofstream(path) << "half";
    write_file(folder / "c", [&](const ByteSink&) {
        remove_abandoned_files_of(folder / "a");
        remove_abandoned_files_of(folder / "c");
    });
    EXPECT_FALSE(std::filesystem::exists(left));
    EXPECT_TRUE(std::filesystem::exists(other));
    EXPECT_TRUE(std::filesystem::exists(folder / "c")) << "its writer lived";
}

TEST(RemoveAbandonedFiles, TakesThoseOfTheDeadAndNoOthers) {
    const TemporaryFolder folder;
    const auto left = temporary_of(folder, "a");
    std::filesystem::create_directories(folder / "below/deep");
    for (const auto& path : {left, (folder / "below/deep") / left.filename(), folder / "below/.mine.tmp",
                             folder / "below/.a.another-host-0.etendue.tmp", folder / "b.tmp"})
        std::ofstream(path) << "half";
    const auto old = folder / "below/.b.another-host-0.etendue.tmp";
    std::ofstream(old) << "half";
    std::filesystem::last_write_time(old, std::filesystem::file_time_type::clock::now() - std::chrono::hours(2));
    EXPECT_EQ(remove_abandoned_files(folder / "."), 3u);
    EXPECT_FALSE(std::filesystem::exists(left));
    EXPECT_FALSE(std::filesystem::exists(old));
    EXPECT_TRUE(std::filesystem::exists(folder / "below/.mine.tmp")) << "another program's";
    EXPECT_TRUE(std::filesystem::exists(folder / "below/.a.another-host-0.etendue.tmp")) << "its writer may live";
    EXPECT_TRUE(std::filesystem::exists(folder / "a"));
    EXPECT_EQ(remove_abandoned_files(folder / "missing"), 0u);
}

}  // namespace

}  // namespace etendue
