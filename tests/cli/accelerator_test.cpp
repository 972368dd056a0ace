// Accelerators from outside: profiles that compare them, and renders with each.
#include "image/read_channels.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "report/profile_report.h"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Accelerators : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_scene(folder_ / "box");
    }
    [[nodiscard]] ProgramResult run(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin() + 1, (folder_ / "box").string());
        return run_etendue(arguments, work_);
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(Accelerators, TraceTheRaysOfAProfile) {
    const ProgramResult result =
        run({"profile", "-o", "out", "--spp", "4", "--repeat", "1", "--threads", "1", "--integrators", "path",
             "--accelerators", "brute,kdtree,embree", "--growth", "1000"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("triangles/ray"), std::string::npos) << result.out;
    const json accelerators = json::parse(read_file(work_ / "out/profile.json"))["accelerators"];
    ASSERT_EQ(accelerators["measures"].size(), 3u);
    std::vector<std::string> names;
    for (const json& measure : accelerators["measures"]) {
        names.push_back(measure["name"]);
        ASSERT_FALSE(measure["kinds"].empty());
        for (const json& kind : measure["kinds"]) {
            EXPECT_EQ(kind["differ"], 0) << measure;
            EXPECT_GT(kind["rays"], 100);
            EXPECT_GT(kind["rays_per_second"], 0.0);
            EXPECT_EQ(kind["triangles_per_ray"].is_null(), measure["name"] == "embree");
            if (measure["name"] == "brute") {
                EXPECT_EQ(kind["triangles_per_ray"], measure["triangles"]);
            }
        }
    }
    EXPECT_EQ(names, (std::vector<std::string>{"embree", "kdtree", "brute"}));
    EXPECT_EQ(accelerators["growth"].size(), 6u) << "100 and 1000 triangles";
    for (const json& point : accelerators["growth"]) EXPECT_GE(point["rays"], 64) << point;
    const ChannelImage visits = read_channels(work_ / "out/visits-kdtree.exr");
    EXPECT_EQ(visits.channel_names, (std::vector<std::string>{"nodes", "triangles"}));
    EXPECT_EQ(visits.pixels.width, 16);
}

TEST_F(Accelerators, RenderTheImageOfEmbree) {
    const auto image = [&](const std::string& name) {
        const ProgramResult result =
            run({"render", "--spp", "16", "--accelerator", name, "-o", name + ".exr", "--quiet", "--float"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_channels(work_ / (name + ".exr")).pixels;
    };
    const ImageF expected = image("embree");
    for (const char* name : {"bvh", "bvh-middle", "bvh-counts", "kdtree", "grid", "brute"}) {
        const ImageF pixels = image(name);
        ASSERT_EQ(pixels.pixels.size(), expected.pixels.size());
        double difference = 0.0;
        double sum = 0.0;
        for (std::size_t i = 0; i < pixels.pixels.size(); ++i) {
            difference += std::abs(static_cast<double>(pixels.pixels[i] - expected.pixels[i]));
            sum += static_cast<double>(expected.pixels[i]);
        }
        EXPECT_LT(difference, 1e-3 * sum) << name << ": the same paths but for rounding";
    }
}

}  // namespace

}  // namespace etendue::test
