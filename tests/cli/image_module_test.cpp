// What reads and writes images is loaded late, out of the program's own file.
#include "image/read.h"
#include "program/run_program.h"
#include "program/small_files.h"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;

/// While it lives, programs that start find no OpenImageIO but a broken file in `folder`.
class BrokenLibrary {
  public:
    explicit BrokenLibrary(const fs::path& folder) {
        const std::string version = image_library_version();
        const std::string minor = version.substr(0, version.find('.', version.find('.') + 1));
        file_ = folder / ("libOpenImageIO.so." + minor);
        write_file(file_, "broken");
        setenv(kName, folder.c_str(), 1);
    }
    ~BrokenLibrary() { unsetenv(kName); }
    BrokenLibrary(const BrokenLibrary&) = delete;
    BrokenLibrary& operator=(const BrokenLibrary&) = delete;

    [[nodiscard]] const fs::path& file() const { return file_; }

  private:
    static constexpr const char* kName = "LD_LIBRARY_PATH";
    fs::path file_;
};

class ImageModule : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_scene(box_);
    }
    [[nodiscard]] ProgramResult run(const std::vector<std::string>& arguments) const {
        return run_etendue(arguments, work_, {}, Start::Executed);
    }

    TestFolder folder_;
    fs::path box_ = folder_ / "box";
    fs::path image_ = folder_ / "image.exr";
    fs::path work_ = folder_ / "work";
};

TEST_F(ImageModule, IsInTheProgramWhereverThatIs) {
    const fs::path program = folder_ / "elsewhere/another-name";
    fs::create_directories(program.parent_path());
    fs::copy_file(ETENDUE_PROGRAM, program);
    const std::string command =
        fmt::format("'{}' render '{}' --quiet -o '{}'", program.string(), box_.string(), image_.string());
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(read_image_info(image_).width, 16);
}

TEST_F(ImageModule, IsNotLoadedByWhatOpensNoImage) {
    const BrokenLibrary broken(folder_.path());
    EXPECT_EQ(run({"--help"}).exit_code, 0);
    EXPECT_EQ(run({"inspect", box_.string()}).exit_code, 0);
    EXPECT_EQ(run({"render", box_.string(), "--quiet", "-o", "a.partial"}).exit_code, 0);
}

TEST_F(ImageModule, SaysWhyItCannotBeLoaded) {
    ASSERT_EQ(run({"render", box_.string(), "--quiet", "-o", image_.string()}).exit_code, 0);
    const BrokenLibrary broken(folder_.path());
    // No fault of the image, which would be exit code 3.
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"render", box_.string(), "--quiet", "-o", "a.exr"},
          std::vector<std::string>{"view", image_.string(), "-o", "a.png"}}) {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 1);
        const std::string expected = "error: images cannot be read or written: OpenImageIO cannot be loaded: ";
        EXPECT_TRUE(result.err.starts_with(expected + broken.file().string())) << result.err;
    }
    EXPECT_EQ(list(work_), std::vector<std::string>());
}

// Files in memory count against the limit of file sizes, too.
TEST_F(ImageModule, IsLoadedWhateverTheSoftLimitOfFileSizes) {
    const std::string command = fmt::format("bash -c \"ulimit -S -f 64 && exec '{}' render '{}' --quiet -o '{}'\"",
                                            ETENDUE_PROGRAM, box_.string(), image_.string());
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(read_image_info(image_).width, 16);
}

TEST_F(ImageModule, SaysWhichLimitIsTooLow) {
    const fs::path messages = folder_ / "messages";
    const std::string command = fmt::format("bash -c \"ulimit -f 64 && exec '{}' render '{}' --quiet -o '{}' 2> '{}'\"",
                                            ETENDUE_PROGRAM, box_.string(), image_.string(), messages.string());
    const int status = std::system(command.c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << "no signal: " << status;
    EXPECT_NE(read_file(messages).find("no file may have more than 64 KiB here: raise that limit (ulimit -f)"),
              std::string::npos)
        << read_file(messages);
    EXPECT_FALSE(fs::exists(image_));
}

// Libraries that start within less crash, or wait for ever.
TEST_F(ImageModule, ALimitThatIsTooLowForLibrariesIsAnError) {
    const fs::path messages = folder_ / "messages";
    for (const char* limit : {"-s 64", "-d 60000", "-v 550000"}) {
        const std::string command =
            fmt::format("bash -c \"ulimit {} && exec timeout 60 '{}' render '{}' --quiet -o '{}' 2> '{}'\"", limit,
                        ETENDUE_PROGRAM, box_.string(), image_.string(), messages.string());
        const int status = std::system(command.c_str());
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << limit << ": " << status;
        EXPECT_NE(read_file(messages).find(fmt::format("raise that limit (ulimit {:.2})", limit)), std::string::npos)
            << read_file(messages);
    }
    EXPECT_FALSE(fs::exists(image_));
}

TEST_F(ImageModule, AFileAboveTheLimitIsAnErrorAndNoSignal) {
    const fs::path messages = folder_ / "messages";
    const std::string command =
        fmt::format("bash -c \"ulimit -S -f 1 && exec '{}' render '{}' --quiet -o '{}' 2> '{}'\"", ETENDUE_PROGRAM,
                    box_.string(), image_.string(), messages.string());
    const int status = std::system(command.c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << "no signal: " << status;
    EXPECT_NE(read_file(messages).find("File too large"), std::string::npos) << read_file(messages);
}

TEST_F(ImageModule, AProfileIsNotLostWithItsPictures) {
    const BrokenLibrary broken(folder_.path());
    const ProgramResult result = run({"profile", box_.string(), "-o", "profile", "--integrators", "path", "--spp", "1",
                                      "--repeat", "1", "--threads", "1"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("OpenImageIO cannot be loaded"), std::string::npos) << result.err;
    EXPECT_NE(result.out.find("path"), std::string::npos) << "the table";
    const std::string profile = read_file(work_ / "profile/profile.json");
    EXPECT_NE(profile.find("\"path\""), std::string::npos) << profile;
    EXPECT_TRUE(fs::exists(work_ / "profile/index.html"));
}

TEST_F(ImageModule, AComparisonIsNotLostWithItsPictures) {
    const BrokenLibrary broken(folder_.path());
    const ProgramResult result = run({"compare", box_.string(), "-o", "report", "--integrators", "path,naive", "--spp",
                                      "2", "--seeds", "3", "--quiet"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("OpenImageIO cannot be loaded"), std::string::npos) << result.err;
    EXPECT_NE(read_file(work_ / "report/report.json").find("\"naive\""), std::string::npos);
}

}  // namespace

}  // namespace etendue::test
