// What is said of samples that were not finite: the command shows the first of them alone.
#include "program/run_program.h"
#include "program/small_files.h"

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

using Arguments = std::vector<std::string>;

/// Of the report in `err`, from "the first is" on, up to the command; and the words of that, without the program and
/// quotes.
struct Report {
    explicit Report(const std::string& err) {
        const std::string begin = "the first is ";
        const std::string end = "To see it alone: etendue ";
        const std::size_t from = err.find(begin);
        const std::size_t to = err.find(end);
        if (from == std::string::npos || to == std::string::npos) return;
        first = err.substr(from, to - from);
        std::istringstream words(err.substr(to + end.size(), err.find('\n', to) - to - end.size()));
        for (std::string word; words >> word;) {
            std::erase(word, '\'');
            command.push_back(word);
        }
    }

    std::string first;
    Arguments command;
};

/// Of a triangle under a sky that is brighter than floats hold.
class DroppedSamples : public testing::Test {
  protected:
    void SetUp() override {
        write_scene(folder_ / "sky");
        write_file(folder_ / "sky/render.json",
                   R"({"size": [16, 12], "camera": "main", "environment": {"color": [1e38, 1e38, 1e38]}})");
    }
    [[nodiscard]] Report render(const Arguments& more) const {
        Arguments arguments{"render", "sky", "--spp", "3", "--seed", "5", "-o", "sky.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return Report(run_etendue(arguments, folder_.path()).err);
    }
    [[nodiscard]] Report render_again(const Report& report) const {
        return Report(run_etendue(report.command, folder_.path()).err);
    }

    TestFolder folder_;
};

// A splat falls elsewhere than into the pixel whose light path has left it.
TEST_F(DroppedSamples, OfSplatsAreTheLightPathsThatLeftThem) {
    const Report report = render({"--integrator", "light"});
    ASSERT_FALSE(report.command.empty());
    EXPECT_EQ(render_again(report).first, report.first);
}

TEST_F(DroppedSamples, AreRenderedAgainAsTheyWere) {
    const Arguments options{"--integrator",     "bdpt", "--heuristic",      "power", "--bdpt-connections", "cache:3",
                            "--clamp-indirect", "7",    "--texture-memory", "8M",    "--light-samples",    "3"};
    const Report report = render(options);
    ASSERT_FALSE(report.command.empty());
    for (std::size_t i = 0; i < options.size(); i += 2) {
        const auto given = std::ranges::find(report.command, options[i]);
        ASSERT_LT(given, report.command.end() - 1) << options[i];
        EXPECT_EQ(given[1], options[i + 1]);
    }
    EXPECT_EQ(render_again(report).first, report.first);
}

}  // namespace

}  // namespace etendue::test
