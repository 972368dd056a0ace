// etendue diff from outside: what it compares, refuses, prints and writes.
#include "image/read.h"
#include "image/write.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "support/text.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Names = std::vector<std::string>;

ImageF ramp(int width, int height, float step) {
    ImageF image(width, height, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = step * static_cast<float>(i % 31);
    return image;
}

class Diff : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(work_); }
    /// `etendue diff ...` in the working directory, beside which the images lie.
    [[nodiscard]] ProgramResult diff(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "diff");
        return run_etendue(arguments, work_);
    }
    [[nodiscard]] json diff_json(std::vector<std::string> arguments, int exit_code = 0) const {
        arguments.emplace_back("--json");
        const ProgramResult result = diff(std::move(arguments));
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return json::parse(result.out);
    }
    /// Floats, in `space` unless that is empty.
    std::string exr(const std::string& name, const ImageF& image, const std::string& space = "ACEScg") const {
        ImageWriteOptions options{.depth = PixelDepth::Float};
        if (!space.empty()) options.attributes = {{"oiio:ColorSpace", space}};
        write_image(folder_ / (name + ".exr"), image, options);
        return "../" + name + ".exr";
    }
    std::string png(const std::string& name, const ImageF& image) const {
        write_image(folder_ / (name + ".png"), image, {.depth = PixelDepth::UInt8});
        return "../" + name + ".png";
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(Diff, ReportsEveryMeasureWithItsFormula) {
    const std::string a = exr("a", ramp(20, 10, 0.1f));
    const std::string b = exr("b", ramp(20, 10, 0.11f));
    const ProgramResult result = diff({a, b});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    for (const char* part : {"ACEScg", "200 pixels, 20x10 from 0,0", "relmse ", "(v - r)^2 / (r^2 + 0.01)",
                             "relmse-trimmed", "0.1% of", "mse ", "mae ", "smape ", "|v - r| / (|v| + |r| + 0.01)",
                             "hdr-flip ", "67.02 pixels per degree", "ACES", "exposures from"})
        EXPECT_TRUE(contains(result.out, part)) << part << " in\n" << result.out;
    EXPECT_TRUE(list(work_).empty());
}

TEST_F(Diff, FindsNoErrorInEqualImages) {
    const json result = diff_json({exr("a", ramp(20, 10, 0.1f)), exr("b", ramp(20, 10, 0.1f))});
    ASSERT_EQ(result["measures"].size(), 6u);
    for (const auto& [name, measure] : result["measures"].items()) EXPECT_EQ(measure["value"], 0.0) << name;
    EXPECT_EQ(result["passed"], true);
}

TEST_F(Diff, TheSecondImageIsTheReference) {
    ImageF one(4, 4, 3);
    one.pixels.assign(one.pixels.size(), 1.0f);
    const std::string white = exr("white", one);
    const std::string black = exr("black", ImageF(4, 4, 3));
    const auto relmse = [&](const std::string& image, const std::string& reference) {
        return diff_json({image, reference, "--metric", "relmse"})["measures"]["relmse"]["value"].get<double>();
    };
    EXPECT_NEAR(relmse(white, black), 1.0 / 0.01, 1e-9);
    EXPECT_NEAR(relmse(black, white), 1.0 / 1.01, 1e-9);
}

TEST_F(Diff, JsonSaysWhatWasMeasuredAndHow) {
    const json result = diff_json({exr("a", ramp(20, 10, 0.1f)), exr("b", ramp(20, 10, 0.2f)), "--metric", "SMAPE,flip",
                                   "--ppd", "30", "--exposures", "-2:1.5", "--crop", "5,0,15,4"});
    EXPECT_EQ(result["image"]["file"], "../a.exr");
    EXPECT_EQ(result["image"]["size"], (json{20, 10}));
    EXPECT_EQ(result["reference"]["color_space"], "ACEScg");
    EXPECT_EQ(result["region"], (json{5, 0, 15, 4}));
    EXPECT_EQ(result["pixels"], 40);
    EXPECT_EQ(result["measures"].size(), 2u);
    EXPECT_EQ(result["measures"]["smape"]["epsilon"], 0.01);
    const json& flip = result["measures"]["hdr-flip"];
    EXPECT_EQ(flip["pixels_per_degree"], 30.0);
    EXPECT_EQ(flip["exposures"], (json{{"start", -2.0}, {"stop", 1.5}, {"count", 4}}));
    EXPECT_TRUE(contains(flip["tone_mapper"], "ACES"));
    EXPECT_EQ(result["map"], nullptr);
}

TEST_F(Diff, LimitsDecideTheExitCode) {
    const std::string a = exr("a", ramp(20, 10, 0.1f));
    const std::string b = exr("b", ramp(20, 10, 0.11f));
    const ProgramResult good = diff({a, b, "--fail-above", "relmse=1,flip=0.9", "--quiet"});
    EXPECT_EQ(good.exit_code, 0);
    EXPECT_EQ(good.out + good.err, "");
    const ProgramResult bad = diff({a, b, "--fail-above", "flip=0.001", "--fail-above", "mse=0", "--quiet"});
    EXPECT_EQ(bad.exit_code, 1);
    EXPECT_EQ(bad.out, "");
    EXPECT_TRUE(contains(bad.err, "hdr-flip is")) << bad.err;
    EXPECT_TRUE(contains(bad.err, "mse is")) << bad.err;
    EXPECT_EQ(diff({a, a, "--fail-above", "mse=0"}).exit_code, 0) << "a limit may be reached";
    const json result = diff_json({a, b, "--metric", "mae", "--fail-above", "mse=1e-9"}, 1);
    EXPECT_EQ(result["measures"].size(), 2u) << "what has a limit is measured";
    EXPECT_EQ(result["measures"]["mse"]["exceeded"], true);
    EXPECT_EQ(result["measures"]["mae"]["limit"], nullptr);
    EXPECT_EQ(result["passed"], false);
}

TEST_F(Diff, PixelsThatAreNotFiniteAreFoundAndLeftOut) {
    ImageF image = ramp(20, 10, 0.1f);
    const std::string b = exr("b", image);
    image.pixel(7, 3)[1] = std::numeric_limits<float>::quiet_NaN();
    image.pixel(9, 4)[0] = std::numeric_limits<float>::infinity();
    const std::string a = exr("a", image);
    const ProgramResult result = diff({a, b});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(contains(result.err, "a.exr: 1 pixels with NaN and 1 with infinity, within 7,3,10,5: (7, 3) (9, 4)"))
        << result.err;
    EXPECT_TRUE(contains(result.out, "198 pixels")) << result.out;
    const json measured = diff_json({b, a, "--map", "map.png"}, 1);
    EXPECT_EQ(measured["left_out"], 2);
    EXPECT_EQ(measured["image"]["not_finite"]["nan"], 0);
    EXPECT_EQ(measured["reference"]["not_finite"]["nan"], 1);
    EXPECT_EQ(measured["reference"]["not_finite"]["first"], (json{{7, 3}, {9, 4}}));
    for (const auto& [name, measure] : measured["measures"].items()) EXPECT_EQ(measure["value"], 0.0) << name;
    const Image8 map = read_image_8bit(work_ / "map.png");
    EXPECT_EQ(map.pixel(7, 3)[1], 200) << "in a colour of their own";
    EXPECT_EQ(map.pixel(8, 3)[1], 0);
    // FLIP's filters carry differences between neighbours.
    image.pixel(8, 3)[0] += 0.5f;
    (void)diff_json({b, exr("c", image), "--metric", "flip", "--map", "map.exr"}, 1);
    const ImageF numbers = read_image_float(work_ / "map.exr");
    EXPECT_GT(numbers.pixel(8, 3)[0], 0.0f);
    EXPECT_EQ(numbers.pixel(7, 3)[0], 0.0f) << "left out";
}

TEST_F(Diff, NothingLeftToMeasureIsNoSuccess) {
    ImageF image(4, 4, 3);
    image.pixels.assign(image.pixels.size(), std::numeric_limits<float>::quiet_NaN());
    const json result = diff_json({exr("a", image), exr("b", ramp(4, 4, 0.1f))}, 1);
    EXPECT_EQ(result["pixels"], 0);
    EXPECT_EQ(result["measures"]["mse"]["value"], nullptr);
    EXPECT_EQ(result["measures"]["hdr-flip"]["value"], nullptr);
}

TEST_F(Diff, MapsAreOfTheFirstMeasure) {
    ImageF image = ramp(20, 10, 0.1f);
    const std::string b = exr("b", image);
    image.pixel(4, 2)[0] += 3.0f;
    const std::string a = exr("a", image);
    const ProgramResult result = diff({a, b, "--metric", "mae", "--metric", "mse", "--map", "mae.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "mae.exr: mae from 0")) << result.out;
    const ImageF values = read_image_float(work_ / "mae.exr");
    EXPECT_EQ(values.channels, 1);
    EXPECT_NEAR(values.pixel(4, 2)[0], 1.0f, 1e-6f) << "3 in one of three channels";
    EXPECT_EQ(values.pixel(5, 2)[0], 0.0f);
    EXPECT_EQ(diff({a, b, "--metric", "mae", "--map", "mae.png", "--map-max", "2"}).exit_code, 0);
    const Image8 colors = read_image_8bit(work_ / "mae.png");
    EXPECT_EQ(colors.pixel(4, 2)[0], 183) << "the middle of magma";
    EXPECT_EQ(colors.pixel(0, 0)[2], 4);
    EXPECT_EQ(diff_json({a, b, "--metric", "flip", "--map", "flip.png"})["map"]["largest"], 1.0);
    EXPECT_EQ(list(work_), (Names{"flip.png", "mae.exr", "mae.png"}));
}

TEST_F(Diff, ImagesForDisplaysAreDecodedForFlipOnly) {
    ImageF half(6, 6, 3);
    half.pixels.assign(half.pixels.size(), 128.0f / 255.0f);
    const std::string grey = png("grey", half);
    const std::string black = png("black", ImageF(6, 6, 3));
    const json measures = diff_json({grey, black})["measures"];
    EXPECT_NEAR(measures["mae"]["value"], 128.0 / 255.0, 1e-6);
    // L* of sRGB 128 is 53.585: 0.95 / (0.4 * 41.2761) * 53.585^0.7, below the knee of FLIP's errors.
    EXPECT_NEAR(measures["ldr-flip"]["value"], 0.95 / (0.4 * 41.2761) * std::pow(53.585, 0.7), 1e-4);
    EXPECT_FALSE(measures.contains("hdr-flip"));
    const ProgramResult hdr = diff({grey, black, "--metric", "hdr-flip"});
    EXPECT_EQ(hdr.exit_code, 2);
    EXPECT_TRUE(contains(hdr.err, "ldr-flip")) << hdr.err;
}

TEST_F(Diff, FlipIsTheSameInEveryWorkingSpace) {
    // The same colours in linear Rec.709 and, by its published matrix, in ACEScg.
    const ImageF image = ramp(12, 12, 0.05f);
    const auto to_acescg = [](const ImageF& rec709) {
        ImageF acescg = rec709;
        for (std::size_t i = 0; i < rec709.pixels.size(); i += 3) {
            const float r = rec709.pixels[i];
            const float g = rec709.pixels[i + 1];
            const float b = rec709.pixels[i + 2];
            acescg.pixels[i] = 0.613097f * r + 0.339523f * g + 0.047379f * b;
            acescg.pixels[i + 1] = 0.070194f * r + 0.916354f * g + 0.013452f * b;
            acescg.pixels[i + 2] = 0.020616f * r + 0.109570f * g + 0.869815f * b;
        }
        return acescg;
    };
    const ImageF other = ramp(12, 12, 0.06f);
    const auto flip = [&](const std::string& a, const std::string& b) {
        return diff_json({a, b, "--metric", "flip"})["measures"]["hdr-flip"]["value"].get<double>();
    };
    const double in_rec709 = flip(exr("a", image, "lin_rec709"), exr("b", other, "Linear Rec.709 (sRGB)"));
    const double in_acescg = flip(exr("c", to_acescg(image)), exr("d", to_acescg(other)));
    EXPECT_GT(in_rec709, 0.01);
    EXPECT_NEAR(in_acescg, in_rec709, 1e-4);
}

TEST_F(Diff, ColorSpacesMustAgreeIfTheyAreSaid) {
    const ImageF image = ramp(8, 8, 0.1f);
    const std::string acescg = exr("acescg", image);
    const std::string alias = exr("alias", image, "lin_ap1");
    const std::string rec709 = exr("rec709", image, "Linear Rec.709 (sRGB)");
    const std::string unsaid = exr("unsaid", image, "");
    const ProgramResult differ = diff({acescg, rec709});
    EXPECT_EQ(differ.exit_code, 3);
    for (const char* part : {"'ACEScg'", "'Linear Rec.709 (sRGB)'", "--working-space"})
        EXPECT_TRUE(contains(differ.err, part)) << differ.err;
    EXPECT_EQ(diff({acescg, alias}).err, "");
    const ProgramResult half_said = diff({unsaid, acescg});
    EXPECT_EQ(half_said.exit_code, 0);
    EXPECT_TRUE(contains(half_said.err, "unsaid.exr' does not say its colour space")) << half_said.err;
    const ProgramResult none_said = diff({unsaid, unsaid});
    EXPECT_TRUE(contains(none_said.err, "neither file says")) << none_said.err;
    EXPECT_TRUE(contains(none_said.err, "FLIP takes the images to be linear Rec.709")) << none_said.err;
    EXPECT_EQ(diff({unsaid, unsaid, "--quiet"}).err, "");
}

TEST_F(Diff, ChromaticitiesSayTheSpaceToo) {
    const ImageF image = ramp(8, 8, 0.1f);
    const auto with_primaries = [&](const std::string& name, const std::vector<float>& chromaticities) {
        write_image(folder_ / name, image,
                    {.depth = PixelDepth::Float, .attributes = {{"chromaticities", chromaticities}}});
        return "../" + name;
    };
    const std::string ap1 =
        with_primaries("ap1.exr", {0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f});
    const std::string odd = with_primaries("odd.exr", {0.7f, 0.3f, 0.2f, 0.7f, 0.1f, 0.1f, 0.3f, 0.3f});
    EXPECT_EQ(diff_json({ap1, exr("acescg", image)})["color_space"], "ACEScg");
    const ProgramResult differ = diff({odd, ap1});
    EXPECT_EQ(differ.exit_code, 3);
    EXPECT_TRUE(contains(differ.err, "chromaticities 0.7 0.3")) << differ.err;
}

TEST_F(Diff, WhatCannotBeComparedEndsWithThree) {
    const std::string small = exr("small", ramp(8, 8, 0.1f));
    const ProgramResult sizes = diff({small, exr("large", ramp(9, 8, 0.1f))});
    EXPECT_EQ(sizes.exit_code, 3);
    EXPECT_TRUE(contains(sizes.err, "8x8") && contains(sizes.err, "9x8")) << sizes.err;
    const ProgramResult kinds = diff({small, png("small", ramp(8, 8, 0.01f))});
    EXPECT_EQ(kinds.exit_code, 3);
    EXPECT_TRUE(contains(kinds.err, "two EXRs")) << kinds.err;
    write_image(folder_ / "grey.exr", ImageF(8, 8, 1), {.depth = PixelDepth::Float});
    const ProgramResult channels = diff({small, "../grey.exr"});
    EXPECT_EQ(channels.exit_code, 3);
    EXPECT_TRUE(contains(channels.err, "grey.exr: it has 1 channel where")) << channels.err;
    const ProgramResult missing = diff({"nowhere.exr", small});
    EXPECT_EQ(missing.exit_code, 3);
    EXPECT_TRUE(contains(missing.err, "nowhere.exr")) << missing.err;
    write_file(folder_ / "text.exr", "no image");
    EXPECT_EQ(diff({small, "../text.exr"}).exit_code, 3);
}

TEST_F(Diff, TheOldNameOfCropIsNoted) {
    const std::string a = exr("a", ramp(8, 8, 0.1f));
    const ProgramResult old = diff({a, a, "--region", "0,0,2,3"});
    EXPECT_EQ(old.exit_code, 0) << old.err;
    EXPECT_EQ(old.err, "note: --region is --crop now\n");
    EXPECT_EQ(diff({a, a, "--crop", "0,0,2,3"}).out, old.out);
    EXPECT_EQ(diff({a, a, "--region", "0,0,2,3", "--quiet"}).err, "");
}

TEST_F(Diff, UsageErrorsEndWithTwo) {
    const std::string a = exr("a", ramp(8, 8, 0.1f));
    const std::vector<std::vector<std::string>> bad = {{a},
                                                       {a, a, "--metric", "psnr"},
                                                       {a, a, "--fail-above", "mse"},
                                                       {a, a, "--fail-above", "psnr=3"},
                                                       {a, a, "--fail-above", "mse=-1"},
                                                       {a, a, "--map", "map.jpg"},
                                                       {a, a, "--crop", "0,0,9,8"},
                                                       {a, a, "--crop", "4,4,4,4"},
                                                       {a, a, "--exposures", "3:1"},
                                                       {a, a, "--ppd", "0"},
                                                       {a, a, "--metric", "mse", "--ppd", "30"},
                                                       {a, a, "--metric", "mse", "--exposures", "-1:1"},
                                                       {a, a, "--map-max", "3"},
                                                       {a, a, a}};
    for (const auto& arguments : bad) {
        const ProgramResult result = diff(arguments);
        EXPECT_EQ(result.exit_code, 2) << arguments.back() << "\n" << result.err;
        EXPECT_FALSE(result.err.empty());
    }
    EXPECT_EQ(diff({a, a, "--map", "no/such/folder/map.png"}).exit_code, 1);
    EXPECT_TRUE(list(work_).empty());
}

/// A crop of a render is compared with the same pixels of the full image.
TEST_F(Diff, CropWindowsAreComparedWhereTheyOverlap) {
    write_scene(folder_ / "box");
    const auto render = [this](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render", "../box", "--quiet", "--float", "-o", "../" + name};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(run_etendue(arguments, work_).exit_code, 0);
        return "../" + name;
    };
    const std::string full = render("full.exr", {});
    const std::string left = render("left.exr", {"--crop", "2,3,9,10"});
    const std::string right = render("right.exr", {"--crop", "6,3,12,12"});
    const std::string far = render("far.exr", {"--crop", "12,0,16,2"});
    const json with_full = diff_json({left, full});
    EXPECT_EQ(with_full["region"], (json{2, 3, 9, 10}));
    EXPECT_EQ(with_full["measures"]["mse"]["value"], 0.0);
    const json two_crops = diff_json({left, right, "--metric", "mse", "--map", "map.exr"});
    EXPECT_EQ(two_crops["region"], (json{6, 3, 9, 10}));
    EXPECT_EQ(two_crops["measures"]["mse"]["value"], 0.0);
    const ImageInfo map = read_image_info(work_ / "map.exr");
    EXPECT_EQ(map.data_window, (PixelRect{6, 3, 9, 10}));
    EXPECT_EQ(map.display_window, (PixelRect{0, 0, 16, 12}));
    EXPECT_EQ(diff({left, full, "--crop", "0,0,4,4"}).exit_code, 2);
    const ProgramResult apart = diff({left, far});
    EXPECT_EQ(apart.exit_code, 3);
    EXPECT_TRUE(contains(apart.err, "no pixel in common")) << apart.err;
}

TEST_F(Diff, TheNameOfAMapBeginsNoLine) {
    const std::string a = exr("a", ramp(20, 10, 0.1f));
    const std::string b = exr("b", ramp(20, 10, 0.11f));
    const ProgramResult result = diff({a, b, "--metric", "mse", "--map", "m\nerror: fake.png"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "m\\x0aerror: fake.png: mse")) << result.out;
}

TEST_F(Diff, MeasuresAreNotLostWithAMapThatCannotBeWritten) {
    const std::string a = exr("a", ramp(20, 10, 0.1f));
    fs::create_symlink("/dev/full", work_ / "map.png");
    const ProgramResult result = diff({a, a, "--metric", "mse", "--map", "map.png"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.out.find("mse "), std::string::npos) << result.out;
    EXPECT_NE(result.err.find("map.png"), std::string::npos) << result.err;
}

}  // namespace

}  // namespace etendue::test
