#include "loader/gltf/gltf_builder.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>

namespace etendue {

TempDir::TempDir() {
    std::string name = (std::filesystem::temp_directory_path() / "etendue-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
    path_ = std::filesystem::canonical(name);
}

TempDir::~TempDir() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

void TempDir::write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
}

GltfBuilder::GltfBuilder() {
    json = {{"asset", {{"version", "2.0"}}}};
}

int GltfBuilder::view_bytes(const void* data, std::size_t size, int stride) {
    while (bin.size() % 4 != 0) bin.push_back(0);
    nlohmann::json view = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", size}};
    if (stride != 0) view["byteStride"] = stride;
    bin.resize(bin.size() + size);
    if (size > 0) std::memcpy(bin.data() + bin.size() - size, data, size);
    json["bufferViews"].push_back(view);
    return static_cast<int>(json["bufferViews"].size()) - 1;
}

int GltfBuilder::accessor_of_view(int view, const std::string& type, int component_type, std::size_t count,
                                  bool normalized) {
    nlohmann::json accessor = {
        {"bufferView", view}, {"type", type}, {"componentType", component_type}, {"count", count}};
    if (normalized) accessor["normalized"] = true;
    json["accessors"].push_back(accessor);
    return static_cast<int>(json["accessors"].size()) - 1;
}

int GltfBuilder::floats(const std::vector<float>& values, int components) {
    const char* const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    return accessor(values, types[components - 1], 5126, values.size() / static_cast<std::size_t>(components));
}

int GltfBuilder::indices(const std::vector<std::uint32_t>& values) {
    return accessor(values, "SCALAR", 5125, values.size());
}

nlohmann::json& GltfBuilder::add_mesh(nlohmann::json attributes) {
    if (attributes.contains("POSITION")) {
        // The bounds must be there, and nothing reads them.
        nlohmann::json& positions = json["accessors"][attributes["POSITION"].get<std::size_t>()];
        positions["min"] = {0, 0, 0};
        positions["max"] = {1, 1, 1};
    }
    json["meshes"].push_back({{"primitives", {{{"attributes", std::move(attributes)}}}}});
    json["nodes"].push_back({{"mesh", json["meshes"].size() - 1}});
    json["scenes"] = {{{"nodes", nlohmann::json::array()}}};
    for (std::size_t i = 0; i < json["nodes"].size(); ++i) json["scenes"][0]["nodes"].push_back(i);
    return json["meshes"].back()["primitives"][0];
}

nlohmann::json& GltfBuilder::add_triangle() {
    return add_mesh({{"POSITION", floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3)}});
}

nlohmann::json& GltfBuilder::add_cube_map() {
    const int pixel = view(std::vector<char>(png_bytes().begin(), png_bytes().end()));
    for (int face = 0; face < 6; ++face) json["images"].push_back({{"mimeType", "image/png"}, {"bufferView", pixel}});
    json["extensionsUsed"].push_back("EXT_lights_image_based");
    json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
    nlohmann::json& lights = json["extensions"]["EXT_lights_image_based"]["lights"];
    lights.push_back({{"irradianceCoefficients", std::vector<std::vector<float>>(9, {0, 0, 0})},
                      {"specularImageSize", 1},
                      {"specularImages", {{5, 4, 3, 2, 1, 0}}}});
    return lights.back();
}

nlohmann::json GltfBuilder::document(bool with_uri) const {
    nlohmann::json result = json;
    if (!result.contains("buffers") && !bin.empty()) {
        result["buffers"] = {{{"byteLength", bin.size()}}};
        if (with_uri) result["buffers"][0]["uri"] = "scene.bin";
    }
    return result;
}

std::string GltfBuilder::glb() const {
    std::string text = document(false).dump();
    while (text.size() % 4 != 0) text += ' ';
    std::string bytes(bin.begin(), bin.end());
    while (bytes.size() % 4 != 0) bytes += '\0';
    std::string result;
    const auto u32 = [&result](std::size_t value) {
        for (int i = 0; i < 4; ++i) result += static_cast<char>(value >> (8 * i) & 0xff);
    };
    result += "glTF";
    u32(2);
    u32(12 + 8 + text.size() + 8 + bytes.size());
    u32(text.size());
    result += "JSON" + text;
    u32(bytes.size());
    result += std::string("BIN\0", 4) + bytes;
    return result;
}

void GltfBuilder::write(const TempDir& directory) const {
    directory.write("scene.gltf", document(true).dump());
    directory.write("scene.bin", std::string(bin.begin(), bin.end()));
}

LoadedScene GltfBuilder::load(const LoadOptions& options) const {
    const TempDir directory;
    write(directory);
    return inspect_scene(directory.path() / "scene.gltf", options);
}

const std::string& png_bytes() {
    static const unsigned char bytes[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
        0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00, 0x00, 0x1f, 0x15, 0xc4, 0x89, 0x00, 0x00, 0x00,
        0x0d, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x64, 0xf8, 0xcf, 0x50, 0x0f, 0x00, 0x03, 0x86, 0x01, 0x80,
        0x5a, 0x34, 0x7d, 0x6b, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    static const std::string result(reinterpret_cast<const char*>(bytes), sizeof(bytes));
    return result;
}

const std::string& ies_bytes() {
    static const std::string result = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n100 50\n";
    return result;
}

bool has_problem(const ProblemList& problems, Severity severity, const std::string& text, const std::string& pointer) {
    for (const Problem& problem : problems.all()) {
        if (problem.severity == severity && problem.str().find(text) != std::string::npos &&
            problem.where.pointer.ends_with(pointer)) {
            return true;
        }
    }
    return false;
}

std::string listing(const ProblemList& problems) {
    std::string result;
    for (const Problem& problem : problems.all()) result += problem.str() + "\n";
    return result;
}

const PrimitiveDesc& first_primitive(const LoadedScene& loaded) {
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    return loaded.scene.meshes.at(0).primitives.at(0);
}

}  // namespace etendue
