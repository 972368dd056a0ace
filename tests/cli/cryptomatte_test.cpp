// Cryptomattes from the command line to the file, read as other programs read them.
#include "image/layers.h"
#include "image/read_channels.h"
#include "program/run_program.h"
#include "program/small_files.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

/// Two triangles of one mesh below a node of their own, one before the other, of 50 % alpha.
void write_mattes_scene(const fs::path& directory) {
    write_scene(directory);
    write_file(directory / "scene.gltf", R"({
  "asset": {"version": "2.0"},
  "scene": 0,
  "scenes": [{"nodes": [0, 1]}],
  "nodes": [{"name": "group", "children": [2, 3]}, {"name": "main", "camera": 0},
            {"name": "near", "mesh": 0}, {"name": "far \"one\"", "mesh": 0, "translation": [0.3, 0, -1]}],
  "cameras": [{"name": "main", "type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
  "materials": [{"name": "card", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, -2],
                 "max": [1, 1, -2]}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"uri": "triangle.bin", "byteLength": 36}]
})");
    write_file(directory / "render.json",
               R"({"size": [16, 12], "camera": "main", "environment": {"visible_to_camera": false}})");
}

class Cryptomatte : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_mattes_scene(folder_ / "cards");
    }
    [[nodiscard]] ProgramResult render(const std::string& output, const Arguments& more,
                                       const std::function<void(int pid)>& while_running = {}) const {
        Arguments arguments{"render", (folder_ / "cards").string(), "--quiet", "-o", output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        if (std::ranges::find(more, "--spp") == more.end()) arguments.insert(arguments.end(), {"--spp", "16"});
        return run_etendue(arguments, work_, while_running);
    }
    /// The text of an attribute, "" if there is none.
    [[nodiscard]] static std::string text(const ChannelImage& image, const std::string& name) {
        const ImageAttribute* const found = image.find(name);
        const auto* const value = found != nullptr ? std::get_if<std::string>(&found->value) : nullptr;
        return value != nullptr ? *value : "";
    }
    /// What a program that extracts mattes does: the coverage of `name` in each pixel.
    [[nodiscard]] static std::vector<double> extract(const ChannelImage& image, const std::string& layer,
                                                     const std::string& key, const std::string& name) {
        const auto manifest = nlohmann::json::parse(text(image, "cryptomatte/" + key + "/manifest"));
        const auto id = static_cast<std::uint32_t>(std::stoul(manifest.at(name).get<std::string>(), nullptr, 16));
        const std::size_t channels = image.channel_names.size();
        std::vector<double> matte(image.pixels.pixels.size() / channels, 0.0);
        const auto channel = [&](const std::string& each) {
            return static_cast<std::size_t>(std::ranges::find(image.channel_names, each) - image.channel_names.begin());
        };
        for (int level = 0; level < 3; ++level)
            for (const std::string pair : {"RG", "BA"}) {
                const std::string prefix = fmt::format("{}{:02}.", layer, level);
                const std::size_t ids = channel(prefix + pair[0]);
                const std::size_t coverages = channel(prefix + pair[1]);
                EXPECT_LT(std::max(ids, coverages), channels) << prefix;
                for (std::size_t p = 0; p < matte.size(); ++p)
                    if (std::bit_cast<std::uint32_t>(image.pixels.pixels[p * channels + ids]) == id)
                        matte[p] += static_cast<double>(image.pixels.pixels[p * channels + coverages]);
            }
        return matte;
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

// Half floats are asked for the image; ids have 32 bits all the same.
TEST_F(Cryptomatte, ExtractsWithNamesAndCoverage) {
    const ProgramResult result = render("a.exr", {"--aov", "cryptomatte", "--half", "--spp", "256"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ChannelImage image = read_channels(work_ / "a.exr");
    EXPECT_EQ(text(image, "cryptomatte/3ae39a5/name"), "CryptoObject");
    EXPECT_EQ(text(image, "cryptomatte/3ae39a5/hash"), "MurmurHash3_32");
    EXPECT_EQ(text(image, "cryptomatte/3ae39a5/conversion"), "uint32_to_float32");
    EXPECT_EQ(text(image, "cryptomatte/be359d6/name"), "CryptoMaterial");
    EXPECT_EQ(text(image, "cryptomatte/f42029d/name"), "CryptoAsset");
    const auto objects = nlohmann::json::parse(text(image, "cryptomatte/3ae39a5/manifest"));
    EXPECT_EQ(objects.size(), 2u);
    const std::vector<double> near = extract(image, "CryptoObject", "3ae39a5", "near");
    const std::vector<double> far = extract(image, "CryptoObject", "3ae39a5", "far \"one\"");
    const std::vector<double> group = extract(image, "CryptoAsset", "f42029d", "group");
    const std::vector<double> card = extract(image, "CryptoMaterial", "be359d6", "card");
    const std::size_t channels = image.channel_names.size();
    const auto alpha =
        static_cast<std::size_t>(std::ranges::find(image.channel_names, "A") - image.channel_names.begin());
    int both = 0;
    for (std::size_t p = 0; p < near.size(); ++p) {
        const auto expected = static_cast<double>(image.pixels.pixels[p * channels + alpha]);
        EXPECT_NEAR(near[p] + far[p], expected, 1e-3) << "alpha is in half floats";
        EXPECT_NEAR(group[p], near[p] + far[p], 1e-6);
        EXPECT_NEAR(card[p], near[p] + far[p], 1e-6);
        if (near[p] > 0.45 && far[p] > 0.2) {
            ++both;
            EXPECT_NEAR(near[p], 0.5, 0.07);
            EXPECT_NEAR(far[p], 0.25, 0.07) << "half of what the first lets through";
        }
    }
    EXPECT_GT(both, 5);
}

TEST_F(Cryptomatte, HasItsMetadataWhereItsChannelsAre) {
    ASSERT_EQ(render("p.exr", {"--aov", "cryptomatte", "--aov", "depth", "--aov-layout", "parts"}).exit_code, 0);
    const LayeredImage parts = read_layers(work_ / "p.exr");
    ASSERT_EQ(parts.parts.size(), 5u);
    const std::string header = read_file(work_ / "p.exr");
    EXPECT_NE(header.find("cryptomatte/3ae39a5/manifest"), std::string::npos);
    EXPECT_NE(header.find("cryptomatte/3ae39a5/name"), header.rfind("cryptomatte/3ae39a5/name"))
        << "in its part, and in the first, where Blender looks";
    ASSERT_EQ(render("f.exr", {"--aov", "cryptomatte", "--aov-layout", "files"}).exit_code, 0);
    const ChannelImage file = read_channels(work_ / "f.CryptoMaterial.exr");
    EXPECT_EQ(text(file, "cryptomatte/be359d6/name"), "CryptoMaterial");
    EXPECT_EQ(text(file, "cryptomatte/3ae39a5/name"), "");
    std::vector<std::string> names = file.channel_names;
    std::ranges::sort(names);
    ASSERT_EQ(names.size(), 12u);
    EXPECT_EQ(names.front(), "CryptoMaterial00.A");
    EXPECT_EQ(text(read_channels(work_ / "f.exr"), "cryptomatte/be359d6/name"), "");
}

TEST_F(Cryptomatte, HasAsManyRanksAsAreAskedFor) {
    ASSERT_EQ(render("r.exr", {"--aov", "ids=cryptomatte_object:3"}).exit_code, 0);
    const ChannelImage image = read_channels(work_ / "r.exr");
    const auto has = [&](const std::string& name) {
        return std::ranges::find(image.channel_names, name) != image.channel_names.end();
    };
    EXPECT_TRUE(has("ids01.A"));
    EXPECT_FALSE(has("ids02.R"));
}

TEST_F(Cryptomatte, OfRendersThatWereStoppedIsThatOfTheWhole) {
    const Arguments settings{"--aov", "cryptomatte", "--aov",  "denoising", "--deep",
                             "--spp", "1500",        "--size", "40x30",     "--float"};
    const auto with = [&](const Arguments& more) {
        Arguments all = settings;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    ASSERT_EQ(render("whole.exr", settings).exit_code, 0);
    const ProgramResult stopped = render("a.exr", with({"--checkpoint-every", "0.0003"}), [&](int pid) {
        EXPECT_TRUE(wait_until([&] { return fs::exists(work_ / "a.checkpoint"); }));
        kill(pid, SIGINT);
    });
    ASSERT_EQ(stopped.exit_code, 130) << stopped.err;
    ASSERT_TRUE(fs::exists(work_ / "a.checkpoint")) << "it was not stopped in the middle";
    ASSERT_EQ(render("a.exr", with({"--resume"})).exit_code, 0);
    const ChannelImage whole = read_channels(work_ / "whole.exr");
    const ChannelImage resumed = read_channels(work_ / "a.exr");
    ASSERT_EQ(resumed.channel_names, whole.channel_names);
    const auto bits = [](const ChannelImage& image) {
        std::vector<std::uint32_t> all;
        for (const float value : image.pixels.pixels) all.push_back(std::bit_cast<std::uint32_t>(value));
        return all;
    };
    EXPECT_EQ(bits(resumed), bits(whole));
}

TEST_F(Cryptomatte, OfAdaptiveRendersAddUpToAlpha) {
    ASSERT_EQ(render("e.exr", {"--aov", "cryptomatte", "--spp", "512", "--float", "--error", "0.05"}).exit_code, 0);
    const nlohmann::json statistics = nlohmann::json::parse(read_file(work_ / "e.json"));
    const ChannelImage image = read_channels(work_ / "e.exr");
    const std::vector<double> near = extract(image, "CryptoObject", "3ae39a5", "near");
    const std::vector<double> far = extract(image, "CryptoObject", "3ae39a5", "far \"one\"");
    const std::size_t channels = image.channel_names.size();
    const auto alpha =
        static_cast<std::size_t>(std::ranges::find(image.channel_names, "A") - image.channel_names.begin());
    double sum = 0.0;
    for (std::size_t p = 0; p < near.size(); ++p) {
        EXPECT_NEAR(near[p] + far[p], static_cast<double>(image.pixels.pixels[p * channels + alpha]), 1e-5) << p;
        sum += near[p];
    }
    EXPECT_GT(sum, 5.0);
    EXPECT_LT(statistics["adaptive"]["least"], statistics["adaptive"]["most"]);
}

TEST_F(Cryptomatte, OfPartsIsThatOfTheWhole) {
    for (const char* integrator : {"path", "bdpt"}) {
        const auto with = [&](const Arguments& more) {
            Arguments all{"--aov", "cryptomatte", "--aov",   "denoising",    "--deep",
                          "--spp", "32",          "--float", "--integrator", integrator};
            all.insert(all.end(), more.begin(), more.end());
            return all;
        };
        ASSERT_EQ(render("whole.exr", with({})).exit_code, 0);
        ASSERT_EQ(render("a.partial", with({"--samples", "0:16"})).exit_code, 0);
        ASSERT_EQ(render("b.partial", with({"--samples", "16:32"})).exit_code, 0);
        const ProgramResult merged =
            run_etendue({"merge", "a.partial", "b.partial", "-o", "merged.exr", "--float", "--quiet"}, work_);
        ASSERT_EQ(merged.exit_code, 0) << merged.err;
        const ChannelImage whole = read_channels(work_ / "whole.exr");
        const ChannelImage sum = read_channels(work_ / "merged.exr");
        EXPECT_EQ(text(sum, "cryptomatte/3ae39a5/manifest"), text(whole, "cryptomatte/3ae39a5/manifest"));
        for (const char* name : {"near", "far \"one\""}) {
            const std::vector<double> a = extract(whole, "CryptoObject", "3ae39a5", name);
            const std::vector<double> b = extract(sum, "CryptoObject", "3ae39a5", name);
            for (std::size_t p = 0; p < a.size(); ++p) EXPECT_NEAR(a[p], b[p], 1e-6) << integrator;
        }
    }
}

TEST_F(Cryptomatte, WhatIsWrongIsSaid) {
    const auto error = [&](const std::string& aov, int exit_code) {
        const ProgramResult result = render("e.exr", {"--aov", aov});
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return result.err;
    };
    EXPECT_NE(error("cryptomatte:half", 3).find("32-bit"), std::string::npos);
    EXPECT_NE(error("cryptomatte_object:99", 3).find("1 to 32 ranks"), std::string::npos);
    EXPECT_NE(error("cryptomatte_object:six", 2).find("--aov"), std::string::npos);
    EXPECT_NE(error("cryptomatte_objects", 3).find("did you mean 'cryptomatte_object'"), std::string::npos);
}

// One of both would be gone from the file, or be read as ranks of a matte.
TEST_F(Cryptomatte, ItsChannelsAreNoOtherLayers) {
    for (const char* layout : {"layers", "parts", "files"})
        for (const Arguments& layers : {Arguments{"CryptoObject00=albedo", "cryptomatte_object"},
                                        {"cryptomatte", "CryptoObject02=albedo"},
                                        {"CryptoObject00=depth", "cryptomatte"},
                                        {"cryptomatte_object", "CryptoObject03=albedo"},
                                        {"ids=cryptomatte_object", "ids1=N"},
                                        {"ids00=cryptomatte_material", "ids=cryptomatte_object"}}) {
            const ProgramResult result =
                render("e.exr", {"--aov", layers[0], "--aov", layers[1], "--aov-layout", layout});
            EXPECT_EQ(result.exit_code, 3) << layers[0];
            EXPECT_NE(result.err.find("a part of the Cryptomatte '"), std::string::npos) << result.err;
        }
    EXPECT_EQ(render("e.exr", {"--aov", "CryptoObject_3=albedo", "--aov", "cryptomatte_object"}).exit_code, 0);
}

TEST_F(Cryptomatte, NothingElseHasItsName) {
    for (const char* layer : {"CryptoObject00=depth", "CryptoMaterial01=N", "CryptoAsset=albedo"}) {
        const ProgramResult result = render("e.exr", {"--aov", layer});
        EXPECT_EQ(result.exit_code, 3) << layer;
        EXPECT_NE(result.err.find("a part of a Cryptomatte"), std::string::npos) << result.err;
    }
    EXPECT_EQ(render("e.exr", {"--aov", "CryptoObject=cryptomatte_object"}).exit_code, 0);
    EXPECT_EQ(render("e.exr", {"--aov", "Crypto00=depth"}).exit_code, 0);
}

/// True if `command` succeeds; what it prints goes to `output`.
bool succeeds(const std::string& command, const fs::path& output) {
    return std::system(fmt::format("{} > '{}' 2>&1", command, output.string()).c_str()) == 0;
}

TEST_F(Cryptomatte, IsReadByOpenExrsOwnTools) {
    const fs::path text = work_ / "said.txt";
    if (!succeeds("command -v exrheader", text)) GTEST_SKIP() << "there is no exrheader (Debian: openexr)";
    ASSERT_EQ(render("h.exr", {"--aov", "cryptomatte_asset"}).exit_code, 0);
    ASSERT_TRUE(succeeds(fmt::format("exrheader '{}'", (work_ / "h.exr").string()), text));
    const std::string header = read_file(text);
    EXPECT_NE(header.find("CryptoAsset00.R, 32-bit floating-point"), std::string::npos) << header;
    EXPECT_NE(header.find("cryptomatte/f42029d/manifest"), std::string::npos) << header;
    EXPECT_NE(header.find("zip"), std::string::npos) << header;
}

// By what the metadata say, whatever the layer is called.
TEST_F(Cryptomatte, IsViewedByItsName) {
    for (const char* layout : {"layers", "parts"}) {
        ASSERT_EQ(
            render("v.exr", {"--aov", "ids=cryptomatte_object", "--aov", "albedo", "--aov-layout", layout}).exit_code,
            0);
        const ProgramResult viewed = run_etendue({"view", "v.exr", "-o", "ids.png", "--layer", "ids"}, work_);
        ASSERT_EQ(viewed.exit_code, 0) << viewed.err;
        EXPECT_NE(viewed.err.find("ids00: numbers"), std::string::npos) << viewed.err;
    }
    const ProgramResult none = run_etendue({"view", "v.exr", "-o", "ids.png", "--layer", "idx"}, work_);
    EXPECT_EQ(none.exit_code, 3) << none.err;
}

// A reader that shares no code with the program.
TEST_F(Cryptomatte, IsReadByThePythonTool) {
    const fs::path text = work_ / "said.txt";
    if (!succeeds("command -v python3", text)) GTEST_SKIP() << "there is no python3";
    ASSERT_EQ(render("t.exr", {"--aov", "cryptomatte"}).exit_code, 0);
    const std::string tool =
        fmt::format("python3 '{}/tools/extract_matte' '{}'", ETENDUE_SOURCE_DIR, (work_ / "t.exr").string());
    ASSERT_TRUE(succeeds(tool, text)) << read_file(text);
    const std::vector<double> near = extract(read_channels(work_ / "t.exr"), "CryptoObject", "3ae39a5", "near");
    const double mean = std::accumulate(near.begin(), near.end(), 0.0) / static_cast<double>(near.size());
    EXPECT_NE(read_file(text).find(fmt::format("{:9.6f}  near", mean)), std::string::npos) << read_file(text);
    ASSERT_TRUE(succeeds(fmt::format("{} CryptoObject near '{}'", tool, (work_ / "near.png").string()), text))
        << read_file(text);
    const auto refused = [&](const std::string& command, const std::string& words) {
        EXPECT_FALSE(succeeds(command, text));
        EXPECT_NE(read_file(text).find(words), std::string::npos) << read_file(text);
    };
    refused(tool + " CryptoObjects near n.png", "there is no matte 'CryptoObjects'; there are Crypto");
    refused(tool + " CryptoObject neat n.png", "'CryptoObject' has no name 'neat', of 2; did you mean 'near'?");
    ASSERT_EQ(render("t.exr", {}).exit_code, 0);
    refused(tool, "has no Cryptomatte");
}

}  // namespace

}  // namespace etendue::test
