#include "program/small_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace etendue::test {

namespace fs = std::filesystem;

TestFolder::TestFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ =
        fs::temp_directory_path() / fmt::format("etendue-{}-{}-{}", test->test_suite_name(), test->name(), ::getpid());
    fs::remove_all(path_);
    fs::create_directories(path_);
}

TestFolder::~TestFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::vector<std::string> list(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        names.push_back(entry.path().lexically_relative(folder).string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string read_file(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    EXPECT_TRUE(stream) << file;
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const fs::path& file, const std::string& text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    EXPECT_TRUE(stream.flush()) << file;
}

void write_scene(const fs::path& directory, const std::string& extra) {
    fs::create_directories(directory);
    constexpr std::array<float, 9> kPositions = {-1, -1, -2, 1, -1, -2, 0, 1, -2};
    write_file(directory / "triangle.bin",
               std::string(reinterpret_cast<const char*>(kPositions.data()), sizeof kPositions));
    write_file(directory / "scene.gltf", R"({
  "asset": {"version": "2.0"},
  "scene": 0,
  "scenes": [{"nodes": [0, 1]}],
  "nodes": [{"mesh": 0}, {"name": "main", "camera": 0}],
  "cameras": [{"name": "main", "type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, -2],
                 "max": [1, 1, -2]}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"uri": "triangle.bin", "byteLength": 36}]
})");
    write_file(directory / "render.json",
               "{" + extra + R"("size": [16, 12], "spp": 2, "camera": "main", "environment": {}})");
}

void name_missing_texture(const fs::path& directory) {
    std::string text = read_file(directory / "scene.gltf");
    constexpr std::string_view kPrimitive = R"({"attributes": {"POSITION": 0}})";
    text.replace(text.find(kPrimitive), kPrimitive.size(), R"({"material": 0, "attributes": {"POSITION": 0}})");
    text.insert(text.rfind('}'), R"(, "images": [{"uri": "missing.hdr"}], "textures": [{"source": 0}],
  "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
)");
    write_file(directory / "scene.gltf", text);
}

std::string hdr_bytes() {
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string(4, '\1');
}

std::string animated_scene(const std::string& directory) {
    std::string text = read_file(directory + "/scene.gltf");
    const auto replace = [&text](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    const std::array<float, 8> keys = {0, 1, 0, 0, 0, 20, 0, 0};
    write_file(directory + "/keys.bin", std::string(reinterpret_cast<const char*>(keys.data()), sizeof keys));
    replace(R"("max": [1, 1, -2]})", R"("max": [1, 1, -2]},
                {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"})");
    replace(R"("byteLength": 36}],)", R"("byteLength": 36}, {"buffer": 1, "byteLength": 8},
                  {"buffer": 1, "byteOffset": 8, "byteLength": 24}],
  "animations": [{"name": "slide", "samplers": [{"input": 1, "output": 2}],
                  "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],)");
    replace(R"("byteLength": 36}])", R"("byteLength": 36}, {"uri": "keys.bin", "byteLength": 32}])");
    write_file(directory + "/scene.gltf", text);
    return directory;
}

}  // namespace etendue::test
