// Layers from the command line to the file, and past checkpoints and parts.
#include "app/run_program.h"
#include "app/small_files.h"
#include "image/open_image.h"
#include "image/read.h"
#include "support/temporary_folder.h"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

class Layers : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_scene(folder_ / "box");
    }
    [[nodiscard]] ProgramResult render(const std::string& output, const Arguments& more) const {
        Arguments arguments{"render", (folder_ / "box").string(), "--size", "16x12", "--spp", "4", "--float", "--quiet",
                            "-o",     output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_etendue(arguments, work_);
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(Layers, WhatIsWrongIsSaidWithItsPlace) {
    const auto error = [&](const Arguments& more, int exit_code) {
        const ProgramResult result = render("a.exr", more);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return result.err;
    };
    EXPECT_NE(error({"--aov", "dept"}, 3).find("did you mean 'depth'"), std::string::npos);
    EXPECT_NE(error({"--aov", "a.b=depth"}, 2).find("--aov"), std::string::npos);
    const std::string expression = error({"--aov", "c=lpe:C D X L"}, 3);
    EXPECT_NE(expression.find("--aov: layer 'c': 'X' is no event"), std::string::npos) << expression;
    EXPECT_NE(expression.find("    C D X L\n        ^"), std::string::npos) << expression;
    EXPECT_NE(error({"--aov", "c=lpe:D L"}, 3).find("begins with the camera"), std::string::npos);
    EXPECT_NE(error({"--aov", "a=depth", "--aov", "a=N"}, 3).find("two of this name"), std::string::npos);
    EXPECT_NE(error({"--aov", "direct", "--integrator", "whitted"}, 3).find("does not tell paths apart"),
              std::string::npos);
    EXPECT_FALSE(fs::exists(work_ / "a.exr"));
}

}  // namespace

}  // namespace etendue::test
