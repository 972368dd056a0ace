// etendue view from outside: what it shows, lists and refuses, and the colour options of render.
#include "image/read.h"
#include "image/write.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "support/aces_container.h"
#include "support/temporary_folder.h"
#include "support/text.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

class View : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(work_); }

    [[nodiscard]] ProgramResult run(const std::vector<std::string>& arguments) const {
        return run_etendue(arguments, work_);
    }
    /// The bytes of the PNG that `etendue view FILE -o out.png ...` writes.
    [[nodiscard]] Bytes view(const std::string& file, std::vector<std::string> options) const {
        options.insert(options.begin(), {"view", file, "-o", "out.png"});
        const ProgramResult result = run(options);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_image_8bit(work_ / "out.png").pixels;
    }
    /// One row of `values`, in channels of these names.
    void exr(const std::string& name, const std::vector<std::string>& channels, std::vector<float> values,
             std::vector<ImageAttribute> attributes = {
                 {"oiio:ColorSpace", std::string("Linear Rec.709 (sRGB)")}}) const {
        const int count = static_cast<int>(channels.size());
        ImageF image(static_cast<int>(values.size()) / count, 1, count);
        image.pixels = std::move(values);
        write_image(work_ / name, image,
                    {.depth = PixelDepth::Float, .channel_names = channels, .attributes = std::move(attributes)});
    }
    /// Ends with `code` and says `message`; nothing is written.
    void expect_refused(const std::vector<std::string>& arguments, int code, const std::string& message) const {
        const auto before = list(work_);
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_TRUE(contains(result.err, message)) << message << " in\n" << result.err;
        EXPECT_EQ(list(work_), before);
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

const std::vector<std::string> kPlain{"--view", "Un-tone-mapped"};

// sRGB of 0.18 and 0.5 by IEC 61966-2-1 is 118 and 188 of 255.
TEST_F(View, ShowsColoursOverBlack) {
    exr("a.exr", {"R", "G", "B", "A"}, {0.18f, 0.5f, 1.0f, 0.25f, 0.0f, 2.0f, -1.0f, 1.0f});
    EXPECT_EQ(view("a.exr", kPlain), (Bytes{118, 188, 255, 0, 255, 0}));
    EXPECT_EQ(view("a.exr", {"--view", "Un-tone-mapped", "--exposure", "-1"})[2], 188);
    EXPECT_EQ(list(work_), (std::vector<std::string>{"a.exr", "out.png"}));
}

TEST_F(View, Has16Bits) {
    exr("a.exr", {"R", "G", "B"}, {0.18f, 0.5f, 1.0f});
    (void)view("a.exr", {"--view", "Un-tone-mapped", "--bits", "16"});
    EXPECT_EQ(read_image_info(work_ / "out.png").bits_per_channel, 16);
    const ImageF image = read_image_float(work_ / "out.png");
    EXPECT_NEAR(image.pixels[0], 0.461356f, 1e-5f);
    EXPECT_NEAR(image.pixels[1], 0.735357f, 1e-5f);
}

TEST_F(View, TakesTheSpaceFromTheFile) {
    const std::vector<float> green{0.0f, 0.5f, 0.0f};
    exr("named.exr", {"R", "G", "B"}, green, {{"oiio:ColorSpace", std::string("lin_rec2020")}});
    exr("rec2020.exr", {"R", "G", "B"}, green,
        {{"chromaticities", std::vector<float>{0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f}}});
    exr("own.exr", {"R", "G", "B"}, green,  // no space of the config
        {{"chromaticities", std::vector<float>{0.700f, 0.292f, 0.170f, 0.790f, 0.131f, 0.046f, 0.3127f, 0.3290f}}});
    exr("aces.exr", {"R", "G", "B"}, green, {{"acesImageContainerFlag", 1}});
    exr("silent.exr", {"R", "G", "B"}, green, {});
    const Bytes named = view("named.exr", {"--view", "Un-tone-mapped", "--display", "Display P3 - Display"});
    EXPECT_EQ(view("rec2020.exr", {"--view", "Un-tone-mapped", "--display", "Display P3 - Display"}), named);
    const Bytes own = view("own.exr", {"--view", "Un-tone-mapped", "--display", "Display P3 - Display"});
    EXPECT_NE(own, named);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(own[i], named[i], 8);
    EXPECT_EQ(view("silent.exr", {"--view", "Un-tone-mapped", "--input-space", "ACES2065-1"}),
              view("aces.exr", kPlain));
    const ProgramResult result = run({"view", "silent.exr", "-o", "out.png"});
    EXPECT_TRUE(contains(result.err, "does not say its colour space; it is taken to be in 'Linear Rec.709 (sRGB)'"))
        << result.err;
    EXPECT_EQ(view("silent.exr", kPlain), (Bytes{0, 188, 0}));
    EXPECT_EQ(view("silent.exr", {"--view", "Un-tone-mapped", "--input-space", "srgb_tx"}), (Bytes{0, 128, 0}))
        << "encoded already";
}

TEST_F(View, ShowsOtherLayers) {
    exr("a.exr", {"R", "G", "B", "key.R", "key.G", "key.B", "N.X", "N.Y", "N.Z", "depth.Z", "object_id", "Y.Y"},
        {1, 1, 1, 0.18f, 0.5f, 0, 0, 1, -1, 2, 0, 0.5f, 1, 1, 1, 0.5f, 0.18f, 0, 1, 0, 0, 6, 3, 0.18f});
    EXPECT_EQ(view("a.exr", {"--view", "Un-tone-mapped", "--layer", "key"}), (Bytes{118, 188, 0, 188, 118, 0}));
    EXPECT_EQ(view("a.exr", {"--layer", "N"}), (Bytes{128, 255, 0, 255, 128, 128}));
    EXPECT_EQ(view("a.exr", {"--layer", "depth"}), (Bytes{0, 0, 0, 255, 255, 255}));
    EXPECT_EQ(view("a.exr", {"--layer", "depth", "--range", "0:8"}), (Bytes{64, 64, 64, 191, 191, 191}));
    EXPECT_EQ(view("a.exr", {"--layer", "N.Y"}), (Bytes{255, 255, 255, 0, 0, 0}));
    EXPECT_EQ(view("a.exr", {"--layer", "Y", "--view", "Un-tone-mapped"}), (Bytes{188, 188, 188, 118, 118, 118}))
        << "luminance";
    const Bytes ids = view("a.exr", {"--layer", "object_id"});
    EXPECT_EQ((Bytes{ids[0], ids[1], ids[2]}), (Bytes{0, 0, 0}));
    EXPECT_NE((Bytes{ids[3], ids[4], ids[5]}), (Bytes{255, 255, 255}));
    const ProgramResult result = run({"view", "a.exr", "-o", "out.png", "--layer", "depth", "--view", "Raw"});
    EXPECT_TRUE(contains(result.err, "depth: numbers, 2 to 6 as black to white; display, view")) << result.err;
    EXPECT_EQ(run({"view", "a.exr", "-o", "out.png", "--layer", "depth", "--quiet"}).err, "");
}

TEST_F(View, ListsWhatThereIs) {
    exr("a.exr", {"R", "G", "B", "N.X", "N.Y", "N.Z"}, {1, 1, 1, 0, 0, 1});
    const ProgramResult text = run({"view", "a.exr", "--list"});
    EXPECT_EQ(text.exit_code, 0) << text.err;
    for (const char* part :
         {"config: built-in", "  sRGB - Display *", "    ACES 1.0 - SDR Video *", "  Display P3 - Display\n",
          "  ACES 1.3 Reference Gamut Compression", "layers of a.exr (Linear Rec.709 (sRGB)",
          "  (main) *: colour R G B, 1x1", "  N: vector N.X N.Y N.Z"})
        EXPECT_TRUE(contains(text.out, part)) << part << " in\n" << text.out;
    const json listed = json::parse(run({"view", "a.exr", "--list", "--json"}).out);
    EXPECT_EQ(listed["displays"][0]["name"], "sRGB - Display");
    EXPECT_EQ(listed["displays"][0]["default_view"], "ACES 1.0 - SDR Video");
    EXPECT_EQ(listed["looks"][0], "ACES 1.3 Reference Gamut Compression");
    EXPECT_EQ(listed["file"]["layers"][1]["name"], "N");
    EXPECT_EQ(listed["file"]["default_layer"], "");
    EXPECT_TRUE(json::parse(run({"view", "--list", "--json"}).out)["file"].is_null());
}

TEST_F(View, TheNameOfTheConfigBeginsNoLine) {
    const fs::path config = work_ / "c\nerror: fake.ocio";
    write_file(config,
               "ocio_profile_version: 2\nsearch_path: .\nroles: {scene_linear: ref, default: ref}\n"
               "file_rules:\n  - !<Rule> {name: Default, colorspace: ref}\n"
               "displays:\n  d:\n    - !<View> {name: v, colorspace: ref}\n"
               "colorspaces:\n  - !<ColorSpace> {name: ref}\n");
    ::setenv("OCIO", config.c_str(), 1);
    const ProgramResult result = run({"view", "--list"});
    ::unsetenv("OCIO");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "c\\x0aerror: fake.ocio\n")) << result.out;
}

TEST_F(View, SaysWhatIsWrong) {
    exr("a.exr", {"R", "G", "B"}, {1, 1, 1});
    exr("odd.exr", {"R", "G", "B"}, {1, 1, 1}, {{"oiio:ColorSpace", std::string("my camera")}});
    exr("flat.exr", {"R", "G", "B"}, {1, 1, 1}, {{"chromaticities", std::vector<float>(8, 0.0f)}});
    write_image(work_ / "a.png", ImageF(1, 1, 3), {.depth = PixelDepth::UInt8});
    write_file(work_ / "broken.exr", "v/1\x01 no");
    expect_refused({"view", "a.exr", "-o", "b.png", "--display", "sRGB"}, 3, "--display: there is no display 'sRGB'");
    expect_refused({"view", "a.exr", "-o", "b.png", "--view", "ACES"}, 3, "--view: there is no view of display");
    expect_refused({"view", "a.exr", "-o", "b.png", "--look", "Warm"}, 3, "--look: there is no look 'Warm'");
    expect_refused({"view", "a.exr", "-o", "b.png", "--input-space", "ACESgc"}, 3, "did you mean 'ACEScg'");
    expect_refused({"view", "a.exr", "-o", "b.png", "--layer", "N"}, 3,
                   "no layer and no channel 'N'; there are (main)");
    expect_refused({"view", "odd.exr", "-o", "b.png"}, 3,
                   "'my camera', which the OpenColorIO config built-in does not have");
    expect_refused({"view", "flat.exr", "-o", "b.png"}, 3, "are no primaries");
    expect_refused({"view", "a.png", "-o", "b.png"}, 3, "encoded already");
    expect_refused({"view", "broken.exr", "-o", "b.png"}, 3, "broken.exr");
    expect_refused({"view", "missing.exr", "-o", "b.png"}, 3, "missing.exr");
    expect_refused({"view", "a.exr", "-o", "a.exr/b.png"}, 1, "there is no directory");
    expect_refused({"view", "a.exr", "-o", "b.jpg"}, 2, "must end in .png");
    expect_refused({"view", "a.exr"}, 2, "--output is missing: the PNG to write, such as -o a.view.png");
    expect_refused({"view", "-o", "b.png"}, 2, "there is no file");
    expect_refused({"view", "a.exr", "-o", "b.png", "--json"}, 2, "--json");
    expect_refused({"view", "a.exr", "-o", "b.png", "--bits", "12"}, 2, "--bits");
    expect_refused({"view", "a.exr", "-o", "b.png", "--range", "3:3"}, 2, "LOW < HIGH");
    expect_refused({"view", "a.exr", "-o", "b.png", "--exposure", "nan"}, 2, "--exposure");
}

// ---- Of render.

TEST_F(View, RenderTakesDisplayLookAndSpace) {
    write_scene(work_ / "s", R"("color": {"display": "Display P3 - Display", "view": "Un-tone-mapped",
                                          "look": "ACES 1.3 Reference Gamut Compression", "output_space": "lin_ap0"},)");
    ASSERT_EQ(run({"render", "s", "-o", "a.exr", "--quiet"}).exit_code, 0);
    EXPECT_EQ(read_image_info(work_ / "a.exr").color_space, "ACES2065-1");
    EXPECT_EQ(run({"render", "s", "-o", "b.exr", "--quiet", "--display", "sRGB - Display", "--look", "none",
                   "--exr-space", "lin_rec709"})
                  .exit_code,
              0);
    EXPECT_EQ(read_image_info(work_ / "b.exr").color_space, "Linear Rec.709 (sRGB)");
    expect_refused({"render", "s", "-o", "c.exr", "--display", "x"}, 3, "--display: there is no display 'x'");
    expect_refused({"render", "s", "-o", "c.exr", "--look", "x"}, 3, "--look: there is no look 'x'");
    expect_refused({"render", "s", "-o", "c.exr", "--exr-space", "srgb_tx"}, 3, "--exr-space");
    expect_refused({"render", "s", "-o", "c.exr", "--exr-space", "x"}, 3, "--exr-space: there is no colour space 'x'");
}

TEST_F(View, RenderWritesAcesContainers) {
    write_scene(work_ / "s", R"("color": {"aces_container": true},)");
    ASSERT_EQ(run({"render", "s", "-o", "a.exr", "--quiet", "--crop", "2,3,9,8"}).exit_code, 0);
    const std::vector<std::byte> file = read_all(work_ / "a.exr");
    EXPECT_EQ(AcesContainerCheck::violations(file), std::vector<std::string>());
    const auto comment = AcesContainerCheck::attributes(file).at("comments").value;
    const std::string text(reinterpret_cast<const char*>(comment.data()), comment.size());
    EXPECT_TRUE(contains(text, "Etendue ") && contains(text, "integrator path") &&
                contains(text, "2 samples per pixel"))
        << text;
    expect_refused({"render", "s", "-o", "b.exr", "--float"}, 3,
                   "render.json#/color/aces_container: an ACES container");
    expect_refused({"render", "s", "-o", "b.exr", "--exr-space", "ACEScg"}, 3, "is in ACES2065-1, not in 'ACEScg'");
}

TEST_F(View, MergedPartsAreWrittenAsTheRenderWasToBe) {
    write_scene(work_ / "s");
    for (const char* samples : {"0:1", "1:2"})
        ASSERT_EQ(run({"render", "s", "--samples", samples, "-o", std::string("p") + samples[0] + ".partial", "--quiet",
                       "--aces-container", "--look", "none"})
                      .exit_code,
                  0);
    ASSERT_EQ(run({"merge", "p0.partial", "p1.partial", "-o", "m.exr", "--quiet"}).exit_code, 0);
    EXPECT_EQ(AcesContainerCheck::violations(read_all(work_ / "m.exr")), std::vector<std::string>());
    expect_refused({"merge", "p0.partial", "p1.partial", "-o", "n.exr", "--float"}, 2, "holds 16-bit floats");
}

}  // namespace

}  // namespace etendue::test
