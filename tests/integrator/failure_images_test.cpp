// What a failure of agreement leaves to be looked at.
#include "integrator/failure_images.h"

#include "image/read.h"
#include "integrator/bdpt/render_bdpt.h"
#include "world/test_scene.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(FailureImages, AreThoseOfThePairTheirDifferenceAndThePyramid) {
    AgreementCase room = agreement_case("LampDiffuse");
    room.name = "lamp/rough glass";
    room.lengths = {.max_depth = 3};
    room.spp = 1;
    const std::filesystem::path directory = temporary_file("etendue-failure-images");
    ImageF two(kAgreementWidth, kAgreementHeight, 3);
    ImageF three = two;
    std::ranges::fill(two.pixels, 2.0f);
    std::ranges::fill(three.pixels, 3.0f);
    const World world = agreement_world(room);
    const auto written = [&](const char* other) {
        std::filesystem::remove_all(directory);
        const Disagreement pair{{"path", &three}, {other, &two}};
        const std::filesystem::path folder = write_failure_images(directory, room, world, {&pair, 1});
        EXPECT_EQ(folder, directory / "lamp_rough-glass");
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            names.push_back(entry.path().filename().string());
        std::ranges::sort(names);
        return names;
    };
    EXPECT_EQ(written("light"), (std::vector<std::string>{"light.exr", "path-light.exr", "path.exr"}));
    EXPECT_EQ(written("bdpt"),
              (std::vector<std::string>{"bdpt-strategies.exr", "bdpt.exr", "path-bdpt.exr", "path.exr"}));
    const ImageF difference = read_image_float({directory / "lamp_rough-glass/path-bdpt.exr"});
    EXPECT_TRUE(std::ranges::all_of(difference.pixels, [](float value) { return value == 1.0f; }));
    std::ifstream file(directory / "lamp_rough-glass/bdpt-strategies.exr", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    for (const char* part : {"s0t2", "s1t2", "s2t1", "s3t1"}) EXPECT_NE(bytes.find(part), std::string::npos) << part;
    std::filesystem::remove_all(directory);
}

}  // namespace

}  // namespace etendue::test
