// etendue denoise from outside: what it reads, refuses and writes.
#include "denoise/layers.h"
#include "image/read_channels.h"
#include "image/write.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "support/text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

constexpr float kTruth = 0.5f;

/// Channels and their halves, with noise around kTruth in those of light and none in features.
struct TestImage {
    explicit TestImage(const Names& layers, int width = 40, int height = 24) {
        names = layers;
        for (const std::string& layer : layers)
            if (layer != "A" && layer != "id") names.push_back(half_channel(layer));
        pixels = ImageF(width, height, static_cast<int>(names.size()));
        std::mt19937 generator(1);
        std::normal_distribution<float> normal;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (std::size_t i = 0; i < layers.size(); ++i) {
                    const bool is_feature = layers[i].starts_with("N.") || layers[i] == "A" || layers[i] == "id";
                    const float a = kTruth + (is_feature ? 0.0f : 0.1f * normal(generator));
                    const float b = kTruth + (is_feature ? 0.0f : 0.1f * normal(generator));
                    at(layers[i], x, y) = 0.5f * (a + b);
                    if (std::ranges::find(names, half_channel(layers[i])) != names.end())
                        at(half_channel(layers[i]), x, y) = a;
                }
    }
    float& at(const std::string& name, int x, int y) {
        const auto place = std::ranges::find(names, name) - names.begin();
        return pixels.pixel(x, y)[static_cast<std::size_t>(place)];
    }
    Names names;
    ImageF pixels;
};

class Denoise : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(work_); }
    [[nodiscard]] ProgramResult denoise(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "denoise");
        return run_etendue(arguments, work_);
    }
    std::string write(const std::string& name, const TestImage& image, std::vector<ImageAttribute> attributes,
                      PixelDepth depth = PixelDepth::Float) const {
        ImageWriteOptions options{.depth = depth, .channel_names = image.names, .attributes = std::move(attributes)};
        options.offset_x = 8;
        options.full_x = -3;
        options.full_y = 5;
        options.full_width = 100;
        options.full_height = 50;
        write_image(folder_ / name, image.pixels, options);
        return "../" + name;
    }
    std::string write(const std::string& name, const TestImage& image) const {
        return write(name, image, {{"etendue:halfShare", 0.5f}, {"etendue:scene", std::string("box")}});
    }
    [[nodiscard]] ChannelImage read(const std::string& name) const { return read_channels(work_ / name); }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

std::vector<float> channel(const ChannelImage& image, const std::string& name) {
    std::vector<float> values;
    const auto place = std::ranges::find(image.channel_names, name) - image.channel_names.begin();
    for (std::size_t i = static_cast<std::size_t>(place); i < image.pixels.pixels.size();
         i += image.channel_names.size())
        values.push_back(image.pixels.pixels[i]);
    return values;
}

double error_of(const std::vector<float>& values) {
    double sum = 0.0;
    for (const float value : values) sum += std::pow(double(value) - double(kTruth), 2.0);
    return sum / double(values.size());
}

const Names kLayers{"R", "G", "B", "A", "N.X", "N.Y", "N.Z", "caustics.R", "caustics.G", "caustics.B", "id"};

TEST_F(Denoise, DenoisesEveryLayerOfLightAndKeepsTheRest) {
    TestImage image(kLayers);
    image.at("A", 3, 4) = 0.25f;
    image.at("id", 5, 6) = 7.0f;
    const ProgramResult result = denoise({write("a.exr", image), "-o", "out.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "denoised RGB, caustics; features N;")) << result.err;
    EXPECT_EQ(list(work_), (Names{"out.exr"}));

    const ChannelImage before = read_channels(folder_ / "a.exr");
    const ChannelImage after = read("out.exr");
    Names sorted = after.channel_names;
    Names expected = kLayers;
    std::ranges::sort(sorted);
    std::ranges::sort(expected);
    EXPECT_EQ(sorted, expected) << "without halves";
    for (const char* name : {"R", "G", "B", "caustics.R", "caustics.B"})
        EXPECT_LT(error_of(channel(after, name)), 0.1 * error_of(channel(before, name))) << name;
    for (const char* name : {"A", "N.X", "N.Z", "id"}) EXPECT_EQ(channel(after, name), channel(before, name)) << name;
    EXPECT_EQ(after.data_window, before.data_window);
    EXPECT_EQ(after.display_window, before.display_window);
    EXPECT_EQ(after.display_window, (PixelRect{-3, 5, 97, 55}));
    EXPECT_EQ(std::get<std::string>(after.find("etendue:scene")->value), "box");
    EXPECT_TRUE(contains(std::get<std::string>(after.find("etendue:denoised")->value), "nfor, radius 9"));
    EXPECT_FALSE(after.find("etendue:halfShare"));
    EXPECT_EQ(after.depths, std::vector(after.depths.size(), PixelDepth::Float));
}

TEST_F(Denoise, IsTheSameForEveryNumberOfThreads) {
    const std::string a = write("a.exr", TestImage(kLayers));
    EXPECT_EQ(denoise({a, "-o", "one.exr", "--threads", "1", "--quiet"}).err, "");
    EXPECT_EQ(denoise({a, "-o", "four.exr", "--threads", "4"}).exit_code, 0);
    EXPECT_EQ(read("one.exr").pixels.pixels, read("four.exr").pixels.pixels);
}

TEST_F(Denoise, WritesTheDepthsOfTheFileUnlessToldOtherwise) {
    const TestImage image({"R", "G", "B", "N.X", "N.Y", "N.Z"});
    std::vector<PixelDepth> depths(image.names.size(), PixelDepth::Half);
    for (std::size_t i = 0; i < depths.size(); ++i)
        if (image.names[i].starts_with("N.")) depths[i] = PixelDepth::Float;
    ImageWriteOptions options;
    options.attributes = {{"etendue:halfShare", 0.5f}};
    write_image_parts(
        folder_ / "a.exr",
        std::vector<ImagePart>{{.image = &image.pixels, .channel_names = image.names, .channel_depths = depths}},
        options);
    const auto depth_of = [&](const std::string& file, const std::string& channel) {
        const ChannelImage written = read(file);
        const auto place = std::ranges::find(written.channel_names, channel) - written.channel_names.begin();
        return written.depths.at(static_cast<std::size_t>(place));
    };
    EXPECT_EQ(denoise({"../a.exr", "-o", "same.exr"}).exit_code, 0);
    EXPECT_EQ(depth_of("same.exr", "G"), PixelDepth::Half);
    EXPECT_EQ(depth_of("same.exr", "N.Y"), PixelDepth::Float);
    EXPECT_EQ(denoise({"../a.exr", "-o", "float.exr", "--float"}).exit_code, 0);
    EXPECT_EQ(depth_of("float.exr", "G"), PixelDepth::Float);
    EXPECT_EQ(denoise({"../a.exr", "-o", "half.exr", "--half"}).exit_code, 0);
    EXPECT_EQ(depth_of("half.exr", "G"), PixelDepth::Half);
    EXPECT_EQ(depth_of("half.exr", "N.Y"), PixelDepth::Float) << "is no light";
}

TEST_F(Denoise, TakesFilesOfManyParts) {
    const Names layers{"R", "G", "B", "N.X", "N.Y", "N.Z"};
    const TestImage image(layers);
    const auto part = [&](const std::string& name, std::size_t first, std::size_t end, ImageF& pixels) {
        pixels = ImageF(image.pixels.width, image.pixels.height, static_cast<int>(end - first));
        for (int y = 0; y < pixels.height; ++y)
            for (int x = 0; x < pixels.width; ++x)
                for (std::size_t c = first; c < end; ++c) pixels.pixel(x, y)[c - first] = image.pixels.pixel(x, y)[c];
        return ImagePart{.name = name,
                         .image = &pixels,
                         .channel_names = Names(image.names.begin() + static_cast<std::ptrdiff_t>(first),
                                                image.names.begin() + static_cast<std::ptrdiff_t>(end))};
    };
    ImageF rgb;
    ImageF others;
    const std::vector<ImagePart> parts{part("rgba", 0, 3, rgb), part("others", 3, image.names.size(), others)};
    const ImageWriteOptions options{.depth = PixelDepth::Float, .attributes = {{"etendue:halfShare", 0.5f}}};
    write_image_parts(folder_ / "parts.exr", parts, options);
    write_image(folder_ / "one.exr", image.pixels,
                {.depth = PixelDepth::Float, .channel_names = image.names, .attributes = options.attributes});
    const ProgramResult result = denoise({"../parts.exr", "-o", "parts.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(denoise({"../one.exr", "-o", "one.exr"}).exit_code, 0);
    for (const std::string& name : layers)
        EXPECT_EQ(channel(read("parts.exr"), name), channel(read("one.exr"), name)) << name;
}

TEST_F(Denoise, CountsAndFillsPixelsThatAreNotFinite) {
    TestImage image(kLayers);
    image.at("R", 10, 10) = std::numeric_limits<float>::quiet_NaN();
    image.at("half.G", 12, 11) = std::numeric_limits<float>::infinity();
    image.at("half_N.X", 3, 3) = std::numeric_limits<float>::quiet_NaN();
    const ProgramResult result = denoise({write("a.exr", image), "-o", "out.exr"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(contains(result.err, "2 pixels of RGB are not finite")) << result.err;
    EXPECT_TRUE(contains(result.err, "1 pixels of N are")) << result.err;
    EXPECT_LT(error_of(channel(read("out.exr"), "R")), 0.01);
    for (const char* const name : {"caustics.R", "caustics.G", "caustics.B"})
        for (int y = 0; y < image.pixels.height; ++y)
            for (int x = 0; x < image.pixels.width; ++x)
                image.at(name, x, y) = image.at(half_channel(name), x, y) = 0.0f;
    image.at("caustics.G", 5, 6) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(denoise({write("black.exr", image), "-o", "black.exr"}).exit_code, 0);
    EXPECT_TRUE(std::ranges::all_of(channel(read("black.exr"), "caustics.G"), [](float v) { return v == 0.0f; }));
}

TEST_F(Denoise, RemovesFirefliesUnlessTheyAreToStay) {
    TestImage image({"R", "G", "B"});
    image.at("R", 20, 12) += 500.0f;
    image.at("half.R", 20, 12) += 1000.0f;
    const std::string a = write("a.exr", image);
    const ProgramResult result = denoise({a, "-o", "out.exr"});
    EXPECT_TRUE(contains(result.err, "1 fireflies of RGB removed, 25.8% of its light")) << result.err;
    EXPECT_LT(error_of(channel(read("out.exr"), "R")), 0.01);
    EXPECT_FALSE(contains(denoise({a, "-o", "kept.exr", "--keep-fireflies"}).err, "removed"));
    EXPECT_GT(error_of(channel(read("kept.exr"), "R")), 0.1);
}

TEST_F(Denoise, SaysWhatIsMissing) {
    const auto refuses = [&](const std::string& file, const std::string& reason, Names more = {}) {
        more.insert(more.begin(), {file, "-o", "out.exr"});
        const ProgramResult result = denoise(more);
        EXPECT_EQ(result.exit_code, 3) << result.err;
        EXPECT_TRUE(contains(result.err, reason)) << result.err;
        EXPECT_TRUE(contains(result.err, file)) << result.err;
        EXPECT_TRUE(list(work_).empty());
    };
    const std::vector<ImageAttribute> share{{"etendue:halfShare", 0.5f}};
    TestImage plain({"A"});
    plain.names = {"R", "G", "B"};
    plain.pixels = ImageF(8, 8, 3);
    refuses(write("plain.exr", plain, share), "--aov denoising");
    const TestImage rgb({"R", "G", "B"});
    refuses(write("no-share.exr", rgb, {}), "etendue:halfShare");
    for (const float value : {0.0f, 1.0f, -0.5f, std::numeric_limits<float>::quiet_NaN()})
        refuses(write("share.exr", rgb, {{"etendue:halfShare", value}}), "etendue:halfShare");
    refuses(write("text.exr", rgb, {{"etendue:halfShare", std::string("half")}}), "etendue:halfShare");
    refuses(write("twice.exr", rgb, {share[0], {"etendue:denoised", std::string("nfor")}}), "denoised already");
    refuses(write("a.exr", rgb, share), "no layer 'shadow'", {"--features", "shadow"});
    write_image(folder_ / "a.png", ImageF(8, 8, 3), {.depth = PixelDepth::UInt8});
    refuses("../a.png", "integers");
    write_file(folder_ / "text", "no image");
    refuses("../text", "not an image");
    const std::string whole = read_file(folder_ / "a.exr");
    write_file(folder_ / "cut.exr", whole.substr(0, whole.size() / 2));
    refuses("../cut.exr", "broken");
}

TEST_F(Denoise, RefusesOptionsThatItCannotFollow) {
    const std::string a = write("a.exr", TestImage({"R", "G", "B"}));
    const ProgramResult oidn = denoise({a, "-o", "out.exr", "--method", "oidn"});
    EXPECT_EQ(oidn.exit_code, 2);
    EXPECT_TRUE(contains(oidn.err, "without Intel Open Image Denoise")) << oidn.err;
    EXPECT_EQ(denoise({a, "-o", "out.png"}).exit_code, 2);
    EXPECT_EQ(denoise({a}).exit_code, 2);
    EXPECT_EQ(denoise({a, "-o", "out.exr", "--radius", "17"}).exit_code, 2);
    EXPECT_EQ(denoise({a, "-o", "out.exr", "--half", "--float"}).exit_code, 2);
    EXPECT_EQ(denoise({a, "-o", "no/such/out.exr"}).exit_code, 1);
    EXPECT_EQ(denoise({"../none.exr", "-o", "out.exr"}).exit_code, 2);
    EXPECT_TRUE(list(work_).empty());
}

}  // namespace

}  // namespace etendue::test
