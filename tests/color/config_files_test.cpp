// Configs that refer to themselves, and to files that are none.
#include "color/color_config.h"
#include "core/error.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

class ConfigFiles : public testing::Test {
  protected:
    ConfigFiles() { fs::create_directories(folder_); }
    ~ConfigFiles() override { fs::remove_all(folder_); }

    /// A config with `spaces` besides the reference space, and a view of `shown`.
    fs::path config(const std::string& spaces, const std::string& shown = "a") const {
        fs::path file = folder_ / "config.ocio";
        std::ofstream(file) << "ocio_profile_version: 2\nsearch_path: .\nroles: {scene_linear: ref, default: ref}\n"
                               "file_rules:\n  - !<Rule> {name: Default, colorspace: ref}\n"
                               "displays:\n  d:\n    - !<View> {name: v, colorspace: "
                            << shown << "}\ncolorspaces:\n  - !<ColorSpace> {name: ref}\n"
                            << spaces;
        return file;
    }
    static std::string space(const std::string& name, const std::string& transform) {
        return fmt::format("  - !<ColorSpace> {{name: {}, from_scene_reference: {}}}\n", name, transform);
    }
    static std::string error_of(const fs::path& file) {
        try {
            (void)ColorConfig::from_file(file);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "";
    }
    static void expect_error(const fs::path& file, const std::string& words) {
        const std::string error = error_of(file);
        EXPECT_NE(error.find(words), std::string::npos) << error;
    }

    fs::path folder_ =
        fs::temp_directory_path() /
        fmt::format("etendue-{}-{}", testing::UnitTest::GetInstance()->current_test_info()->name(), ::getpid());
};

TEST_F(ConfigFiles, RefusesSpacesThatReferToThemselves) {
    expect_error(config(space("a", "!<ColorSpaceTransform> {src: ref, dst: a}")),
                 "colour space 'a' refers to itself, or to others more than 64 deep");
    expect_error(config(space("a", "!<ColorSpaceTransform> {src: ref, dst: b}") +
                        space("b", "!<GroupTransform> {children: [!<ColorSpaceTransform> {src: a, dst: ref}]}")),
                 "refers to itself");
    expect_error(config(space("a", "!<DisplayViewTransform> {src: ref, display: d, view: v}")), "refers to itself");
    EXPECT_EQ(error_of(config(space("a", "!<ColorSpaceTransform> {src: ref, dst: b}") +
                              space("b", "!<MatrixTransform> {offset: [0.5, 0, 0, 0]}"))),
              "");
}

TEST_F(ConfigFiles, RefusesSpacesThatAreMadeOfTooMany) {
    std::string chain = space("s0", "!<MatrixTransform> {offset: [0.5, 0, 0, 0]}");
    std::string doubled = chain;
    for (int i = 1; i <= 70; ++i) {
        chain += space(fmt::format("s{}", i), fmt::format("!<ColorSpaceTransform> {{src: ref, dst: s{}}}", i - 1));
        if (i <= 30)
            doubled +=
                space(fmt::format("s{}", i), fmt::format("!<GroupTransform> {{children: [!<ColorSpaceTransform> "
                                                         "{{src: ref, dst: s{0}}}, !<ColorSpaceTransform> {{src: "
                                                         "s{0}, dst: ref}}]}}",
                                                         i - 1));
    }
    expect_error(config(chain, "s70"), "more than 64 deep");
    expect_error(config(doubled, "s30"), "made of more than 100000 transforms");
}

TEST_F(ConfigFiles, RefusesTablesThatAreNoFiles) {
    ASSERT_EQ(::mkfifo((folder_ / "pipe.spi1d").c_str(), 0600), 0);
    expect_error(config(space("a", "!<FileTransform> {src: pipe.spi1d}")), "it is no regular file");
    fs::create_symlink("/dev/zero", folder_ / "zero.spi1d");
    expect_error(config(space("a", "!<FileTransform> {src: zero.spi1d}")), "it is no regular file");
    expect_error(folder_ / "pipe.spi1d", "it is no regular file");
}

TEST_F(ConfigFiles, KnowsItsTables) {
    std::ofstream(folder_ / "half.spi1d") << "Version 1\nFrom 0.0 1.0\nLength 2\nComponents 1\n{\n 0.0\n 0.5\n}\n";
    const fs::path file =
        config(space("a", "!<FileTransform> {src: half.spi1d}") + space("b", "!<FileTransform> {src: missing.spi1d}"));
    EXPECT_EQ(ColorConfig::from_file(file).files(), (std::vector<fs::path>{file, folder_ / "half.spi1d"}));
    EXPECT_TRUE(ColorConfig::built_in().files().empty());
}

}  // namespace

}  // namespace etendue
