// What is said of a scene that lies far from the world's origin is said of the world.
#include "image/read_channels.h"
#include "program/run_program.h"
#include "program/small_files.h"

#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

class FarScene : public testing::Test {
  protected:
    void SetUp() override {
        write_scene(folder_ / "box");
        std::string text = read_file(folder_ / "box" / "scene.gltf");
        const auto replace = [&text](const std::string& from, const std::string& to) {
            text.replace(text.find(from), from.size(), to);
        };
        replace(R"({"nodes": [0, 1]})", R"({"nodes": [2]})");
        replace(R"("camera": 0}])",
                R"("camera": 0}, {"children": [0, 1], "translation": [5000000, 400000.25, -1000000]}])");
        write_file(folder_ / "box" / "scene.gltf", text);
    }

    [[nodiscard]] std::string run(const std::vector<std::string>& arguments) const {
        const ProgramResult result = run_etendue(arguments, folder_.path());
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.out;
    }

    TestFolder folder_;
};

TEST_F(FarScene, IsInspectedWhereItIs) {
    const std::string text = run({"inspect", "box"});
    EXPECT_NE(text.find("bounds: (4999999 399999.25 -1000002) to (5000001 400001.25 -1000002) metres"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("origin (5000000 400000.25 -1000000)"), std::string::npos) << text;
    const auto bounds = nlohmann::json::parse(run({"inspect", "box", "--json"})).at("bounds");
    EXPECT_EQ(bounds.at("min"), (nlohmann::json{4999999.0, 399999.25, -1000002.0}));
    EXPECT_EQ(bounds.at("max"), (nlohmann::json{5000001.0, 400001.25, -1000002.0}));
}

/// Where the matrix, whose vectors are rows, takes a point of the world, in double precision.
std::vector<double> project(const Mat4f& m, const std::vector<double>& point) {
    std::vector<double> result(4);
    for (int column = 0; column < 4; ++column) {
        result[static_cast<std::size_t>(column)] = static_cast<double>(m[3][column]);
        for (int row = 0; row < 3; ++row)
            result[static_cast<std::size_t>(column)] +=
                point[static_cast<std::size_t>(row)] * static_cast<double>(m[row][column]);
    }
    return result;
}

TEST_F(FarScene, HasMatricesOfTheWorldInItsFile) {
    (void)run({"render", "box", "--quiet", "-o", "box.exr"});
    const ChannelImage image = read_channels(folder_ / "box.exr");
    const auto matrix = [&](const std::string& name) { return std::get<Mat4f>(image.find(name)->value); };
    // A metre to the right of the camera and two before it. All of these numbers have few bits.
    const std::vector<double> point{5000001.0, 400000.25, -1000002.0};
    const std::vector<double> in_camera = project(matrix("worldToCamera"), point);
    EXPECT_EQ(in_camera, (std::vector<double>{1.0, 0.0, 2.0, 1.0}));
    const std::vector<double> centre{5000000.0, 400000.25, -1000002.0};
    // Single precision leaves steps of half a metre there.
    const std::vector<double> on_screen = project(matrix("worldToNDC"), centre);
    EXPECT_NEAR(on_screen[0] / on_screen[3], 0.5, 0.3);
    EXPECT_NEAR(on_screen[3], 2.0, 0.1);
}

}  // namespace

}  // namespace etendue::test
