#include "core/write_file.h"

#include "core/error.h"
#include "support/temporary_folder.h"

#include <csignal>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace etendue {

namespace {

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

TEST(WriteText, AFailureHalfWayLeavesTheOldFileAndNoOther) {
    const TemporaryFolder folder;
    write_text(folder / "a.json", "old");
    {
        const FileSizeLimit limit(1000);
        EXPECT_THROW(write_text(folder / "a.json", std::string(5000, 'x')), IoError);
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

}  // namespace

}  // namespace etendue
