// Deep images from the command line to the file, past checkpoints and parts.
#include "image/read_channels.h"
#include "image/write.h"
#include "program/run_program.h"
#include "program/small_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

const std::array<std::string, 4> kChannels{"R", "G", "B", "A"};

class DeepFiles : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_scene(folder_ / "box");
    }
    [[nodiscard]] ProgramResult render(const std::string& output, const Arguments& more) const {
        Arguments arguments{"render", (folder_ / "box").string(), "--float", "--quiet", "--deep", "-o", output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        if (std::ranges::find(more, "--spp") == more.end()) arguments.insert(arguments.end(), {"--spp", "8"});
        return run_etendue(arguments, work_);
    }
    /// Flattened by OpenImageIO: R, G, B, A of each pixel.
    [[nodiscard]] std::vector<float> flattened(const std::string& file) const {
        const OIIO::ImageBuf deep((work_ / file).string());
        EXPECT_TRUE(deep.deep()) << file;
        EXPECT_EQ(deep.spec().channelnames, (std::vector<std::string>{"R", "G", "B", "A", "Z", "ZBack"}));
        const OIIO::ImageBuf flat = OIIO::ImageBufAlgo::flatten(deep);
        EXPECT_FALSE(flat.has_error()) << flat.geterror();
        std::vector<float> pixels(static_cast<std::size_t>(flat.spec().image_pixels()) * 4);
        EXPECT_TRUE(flat.get_pixels(OIIO::ROI(flat.xbegin(), flat.xend(), flat.ybegin(), flat.yend(), 0, 1, 0, 4),
                                    OIIO::TypeDesc::FLOAT, pixels.data()));
        return pixels;
    }
    /// Of each pixel, the depth of what lies at half of its alpha; 0 where there is nothing.
    [[nodiscard]] std::vector<double> middle_depths(const std::string& file) const {
        const OIIO::ImageBuf deep((work_ / file).string());
        std::vector<double> depths;
        for (int y = deep.ybegin(); y < deep.yend(); ++y)
            for (int x = deep.xbegin(); x < deep.xend(); ++x) {
                double alpha = 0.0;
                double depth = 0.0;
                for (int s = 0; s < deep.deep_samples(x, y) && alpha < 0.5; ++s) {
                    alpha += (1.0 - alpha) * static_cast<double>(deep.deep_value(x, y, 0, 3, s));
                    depth = static_cast<double>(deep.deep_value(x, y, 0, 4, s));
                }
                depths.push_back(depth);
            }
        return depths;
    }
    void expect_flattens_to(const std::string& deep, const std::string& image) const {
        const ChannelImage expected = read_channels(work_ / image);
        const std::vector<float> flat = flattened(deep);
        ASSERT_EQ(flat.size(), expected.pixels.pixels.size());
        for (std::size_t p = 0; p < flat.size(); p += 4)
            for (std::size_t c = 0; c < 4; ++c) {
                const auto channel = static_cast<std::size_t>(std::ranges::find(expected.channel_names, kChannels[c]) -
                                                              expected.channel_names.begin());
                const float value = expected.pixels.pixels[p + channel];
                EXPECT_NEAR(flat[p + c], value, 1e-3f * std::max(1.0f, value)) << p;
            }
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(DeepFiles, FlattenToTheImageByOpenImageIO) {
    for (const char* integrator : {"path", "bdpt"}) {
        const ProgramResult result = render("a.exr", {"--integrator", integrator});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        expect_flattens_to("a.deep.exr", "a.exr");
    }
}

TEST_F(DeepFiles, AreInTheSpaceOfTheImageAndOfItsCrop) {
    ASSERT_EQ(render("c.exr", {"--exr-space", "ACES2065-1", "--crop", "3,2,12,9"}).exit_code, 0);
    expect_flattens_to("c.deep.exr", "c.exr");
}

TEST_F(DeepFiles, OfPartsAreThoseOfTheWhole) {
    for (const char* integrator : {"path", "bdpt"}) {
        const Arguments settings{"--integrator", integrator, "--spp", "16"};
        const auto with = [&](const Arguments& more) {
            Arguments all = settings;
            all.insert(all.end(), more.begin(), more.end());
            return all;
        };
        ASSERT_EQ(render("whole.exr", settings).exit_code, 0);
        ASSERT_EQ(render("a.partial", with({"--samples", "0:8"})).exit_code, 0);
        ASSERT_EQ(render("b.partial", with({"--samples", "8:16"})).exit_code, 0);
        const ProgramResult merged =
            run_etendue({"merge", "a.partial", "b.partial", "-o", "merged.exr", "--float", "--quiet"}, work_);
        ASSERT_EQ(merged.exit_code, 0) << merged.err;
        expect_flattens_to("merged.deep.exr", "whole.exr");
        const std::vector<double> depths = middle_depths("merged.deep.exr");
        const std::vector<double> expected = middle_depths("whole.deep.exr");
        ASSERT_EQ(depths.size(), expected.size());
        EXPECT_GT(std::ranges::count_if(expected, [](double depth) { return depth > 0.0 && depth < 10.0; }), 10);
        for (std::size_t p = 0; p < depths.size(); ++p) EXPECT_NEAR(depths[p], expected[p], 0.03 * expected[p]) << p;
    }
    const ProgramResult crop = render("c.partial", {"--integrator", "bdpt", "--crop", "0,0,8,8"});
    EXPECT_EQ(crop.exit_code, 3);
    EXPECT_NE(crop.err.find("--deep: a part that is a crop"), std::string::npos) << crop.err;
    EXPECT_EQ(render("c.partial", {"--integrator", "path", "--crop", "0,0,8,8"}).exit_code, 0);
}

TEST_F(DeepFiles, OfMediansAreRefused) {
    const ProgramResult result = render("r.exr", {"--robust", "mon:5"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find("a deep image composites to the means"), std::string::npos) << result.err;
}

TEST_F(DeepFiles, HaveNoHalfFloats) {
    const ProgramResult result = render("r.exr", {"--aov", "deep:half"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find("32-bit"), std::string::npos) << result.err;
}

TEST_F(DeepFiles, OfAnImageThatWasReplacedAreNoted) {
    ASSERT_EQ(render("n.exr", {}).exit_code, 0);
    const Arguments without{"render", (folder_ / "box").string(), "--spp", "2", "-o", "n.exr"};
    const std::string note = "note: n.deep.exr is of the image that was replaced";
    const ProgramResult replaced = run_etendue(without, work_);
    ASSERT_EQ(replaced.exit_code, 0);
    EXPECT_NE(replaced.err.find(note), std::string::npos) << replaced.err;
    EXPECT_TRUE(fs::exists(work_ / "n.deep.exr"));
    Arguments again = without;
    again.emplace_back("--deep");
    const ProgramResult with = run_etendue(again, work_);
    EXPECT_EQ(with.err.find("note: n.deep.exr"), std::string::npos) << with.err;
    EXPECT_EQ(run_etendue(again, work_).err.find("note: n.deep.exr"), std::string::npos) << "it is this image's";
}

/// True if `command` succeeds; what it prints goes to `output`.
bool deep_succeeds(const std::string& command, const fs::path& output) {
    return std::system(fmt::format("{} > '{}' 2>&1", command, output.string()).c_str()) == 0;
}

TEST_F(DeepFiles, AreReadByOpenExrsOwnTools) {
    const fs::path text = work_ / "said.txt";
    if (!deep_succeeds("command -v exrheader exrinfo", text))
        GTEST_SKIP() << "there is no exrheader or no exrinfo (Debian: openexr)";
    ASSERT_EQ(render("h.exr", {}).exit_code, 0);
    const fs::path file = work_ / "h.deep.exr";
    ASSERT_TRUE(deep_succeeds(fmt::format("exrheader '{}'", file.string()), text));
    const std::string header = read_file(text);
    EXPECT_NE(header.find("deepscanline"), std::string::npos) << header;
    EXPECT_NE(header.find("ZBack, 32-bit floating-point"), std::string::npos) << header;
    EXPECT_TRUE(deep_succeeds(fmt::format("exrinfo -s '{}'", file.string()), text)) << read_file(text);
}

}  // namespace

}  // namespace etendue::test
