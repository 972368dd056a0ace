// Scene regressions: the scenes of scenes/ and every row of materials against their stored references, by a z-test of
// block means.
//
// With --update-references the same program renders the references instead; with --seed N it renders the tests with
// other seeds, which tells chance from error: a test that fails for one seed in a thousand is right.
#include "core/error.h"
#include "loader/loader.h"
#include "metrics/block_agreement.h"
#include "metrics/error_metrics.h"
#include "regression/difference_image.h"
#include "regression/reference.h"
#include "regression/regression_scenes.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

/// Probability that a scene's test fails although all is right, for another seed.
constexpr double kSignificance = 1e-3;

struct Arguments {
    bool update_references = false;
    std::uint32_t seed = 1;
    bool valid = true;
};

class SceneRegression : public testing::Test {
  public:
    SceneRegression(const RegressionScene& scene, const Arguments& arguments) : scene_(scene), arguments_(arguments) {}

    void TestBody() override {
        if (arguments_.update_references) {
            update_reference(scene_);
            std::cout << "wrote " << ReferenceFiles::of(scene_).mean.string() << '\n';
            return;
        }
        const ImageEstimate reference = read_reference(scene_);
        const ImageEstimate image = render_estimate(scene_, scene_.test, SampleSequence::Sobol, arguments_.seed);
        ASSERT_EQ(image.mean.width, reference.mean.width) << "run tools/dev/update_references";
        ASSERT_EQ(image.mean.height, reference.mean.height) << "run tools/dev/update_references";
        const BlockAgreement agreement = test_agreement(image, reference,
                                                        {.block_size = scene_.block_size,
                                                         .significance = kSignificance,
                                                         .mean_tolerance = scene_.mean_tolerance,
                                                         .block_tolerance = kNegligible});
        std::cout << agreement.str() << '\n';
        if (agreement.agree()) return;
        FAIL() << agreement.str() << ".\n"
               << compute_error_metrics(image.mean, reference.mean).str()
               << write_difference(ETENDUE_REGRESSION_OUTPUT, std::string(scene_.name), image.mean, reference.mean)
               << "\nIf the change is meant, look at the images, then run tools/dev/update_references.";
    }

  private:
    /// Relative. Where rare samples make all of the difference (the filter's tail on an edge), their variance is often
    /// not seen at all; what they do is less than this.
    static constexpr double kNegligible = 2e-3;

    const RegressionScene& scene_;
    Arguments arguments_;
};

class EverySceneHasATest : public testing::Test {
  public:
    void TestBody() override {
        std::set<std::string> tested;
        for (const RegressionScene& scene : regression_scenes()) tested.emplace(scene.name);
        for (const std::string_view name : scenes_without_reference())
            EXPECT_TRUE(tested.emplace(name).second) << name << " has a reference";
        std::set<std::string> present;
        for (const std::string_view parent : kSceneDirectories)
            for (const std::filesystem::path& path : find_scene_directories(parent))
                present.insert(path.filename().string());
        EXPECT_EQ(tested, present) << "rows of regression_scenes.cpp, and directories of scenes";
    }
};

/// Reads and removes our own arguments; gtest's are left.
Arguments parse_arguments(int& argc, char** argv) {
    Arguments arguments;
    int kept = 1;
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        if (argument == "--update-references") {
            arguments.update_references = true;
        } else if (argument == "--seed" && i + 1 < argc) {
            const std::string_view text = argv[++i];
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), arguments.seed);
            arguments.valid &= error == std::errc() && end == text.data() + text.size();
        } else {
            arguments.valid &= argument.starts_with("--gtest_");
            argv[kept++] = argv[i];
        }
    }
    argc = kept;
    argv[argc] = nullptr;
    return arguments;
}

void register_tests(const Arguments& arguments) {
    for (const RegressionScene& scene : regression_scenes()) {
        std::string name(scene.name);
        std::replace(name.begin(), name.end(), '-', '_');
        testing::RegisterTest(
            "Scenes", name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
            [&scene, arguments]() -> testing::Test* { return new SceneRegression(scene, arguments); });
    }
    if (!arguments.update_references)
        testing::RegisterTest("Scenes", "every_scene_has_a_test", nullptr, nullptr, __FILE__, __LINE__,
                              []() -> testing::Test* { return new EverySceneHasATest; });
}

}  // namespace
}  // namespace etendue::test

int main(int argc, char** argv) {
    const etendue::test::Arguments arguments = etendue::test::parse_arguments(argc, argv);
    if (!arguments.valid) {
        std::cerr << "usage: test_regression [--update-references] [--seed N] [--gtest_...]\n";
        return 2;
    }
    testing::InitGoogleTest(&argc, argv);
    etendue::test::register_tests(arguments);
    return RUN_ALL_TESTS();
}
