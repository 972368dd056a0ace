// Systematic damage to a file that uses everything: whatever comes of it, it comes as problems. With the sanitizers
// this also shows that nothing is read outside of what is there.

#include "loader/gltf/gltf_builder.h"

#include <random>

#include <gtest/gtest.h>

namespace etendue {
namespace {

using Json = nlohmann::json;

GltfBuilder rich_scene() {
    GltfBuilder builder;
    const std::vector<float> square{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    Json& primitive = builder.add_mesh({{"POSITION", builder.floats(square, 3)}});
    Json& attributes = primitive["attributes"];
    attributes["NORMAL"] = builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    attributes["TANGENT"] = builder.floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, 4);
    attributes["TEXCOORD_0"] = builder.accessor(std::vector<std::uint16_t>(8, 9), "VEC2", 5123, 4, true);
    attributes["COLOR_0"] = builder.accessor(std::vector<std::uint8_t>(16, 200), "VEC4", 5121, 4, true);
    primitive["indices"] = builder.accessor(std::vector<std::uint8_t>{0, 1, 2, 2, 1, 3}, "SCALAR", 5121, 6);
    primitive["material"] = 0;
    builder.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices",
         {{"bufferView", builder.view(std::vector<std::uint16_t>{3})}, {"byteOffset", 0}, {"componentType", 5123}}},
        {"values", {{"bufferView", builder.view(std::vector<float>{2, 2, 0})}, {"byteOffset", 0}}}};
    const std::vector<char> png(png_bytes().begin(), png_bytes().end());
    builder.json["images"] = {{{"bufferView", builder.view(png)}, {"mimeType", "image/png"}}};
    builder.json["samplers"] = {{{"magFilter", 9728}, {"wrapS", 33071}}};
    builder.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    const Json texture = {{"index", 0},
                          {"texCoord", 0},
                          {"extensions", {{"KHR_texture_transform", {{"offset", {0, 1}}, {"rotation", 1}}}}}};
    builder.json["materials"] = {
        {{"name", "m"},
         {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}, {"baseColorTexture", texture}}},
         {"normalTexture", texture},
         {"emissiveFactor", {1, 0, 0}},
         {"alphaMode", "MASK"},
         {"extensions",
          {{"KHR_materials_ior", {{"ior", 1.4}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", texture}}},
           {"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}}}}}};
    builder.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"color", {1, 1, 1}}, {"spot", {{"outerConeAngle", 0.5}}}}};
    builder.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_ior",
                                      "KHR_materials_transmission", "KHR_texture_transform"};
    builder.json["nodes"][0]["children"] = {1};
    builder.json["nodes"].push_back({{"camera", 0},
                                     {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}},
                                     {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.json["scene"] = 0;
    builder.json["buffers"] = {{{"byteLength", builder.bin.size()}}};
    return builder;
}

/// Loads these bytes; a failure of the test unless the result is a valid scene or has errors.
void load_bytes(const TempDir& dir, const std::string& bytes) {
    dir.write("scene.glb", bytes);
    const LoadedScene loaded = inspect_scene(dir.path() / "scene.glb");
    EXPECT_TRUE(loaded.problems.has_errors() || !validate(loaded.scene).has_errors());
}

TEST(HostileFiles, TheSceneItselfIsGood) {
    const TempDir dir;
    dir.write("scene.glb", rich_scene().glb());
    const LoadedScene loaded = inspect_scene(dir.path() / "scene.glb");
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.images.size(), 1u);
    EXPECT_EQ(loaded.scene.lights.size(), 1u);
    EXPECT_EQ(loaded.scene.cameras.size(), 1u);
}

TEST(HostileFiles, EveryValueReplacedByEveryKindOfValue) {
    const Json replacements[] = {nullptr,
                                 false,
                                 -1,
                                 5,
                                 1.5,
                                 1e30,
                                 4294967296,
                                 "text",
                                 "..",
                                 Json::array(),
                                 Json::object(),
                                 2147483648u,
                                 Json::array({0, 0}),
                                 9007199254740991,
                                 18446744073709551615ull};
    const TempDir dir;
    GltfBuilder builder = rich_scene();
    const Json original = builder.json;
    const Json places = original.flatten();
    for (const auto& [pointer, value] : places.items()) {
        // Each value, and the object or array around it.
        const Json::json_pointer leaf(pointer);
        for (const Json::json_pointer& place : {leaf, leaf.parent_pointer()}) {
            for (const Json& replacement : replacements) {
                builder.json = original;
                builder.json[place] = replacement;
                if (!builder.json.is_object()) continue;
                SCOPED_TRACE(place.to_string() + " = " + replacement.dump());
                load_bytes(dir, builder.glb());
            }
        }
    }
}

TEST(HostileFiles, RandomBytes) {
    const TempDir dir;
    const std::string original = rich_scene().glb();
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        std::string bytes = original;
        for (unsigned changes = 1 + random() % 8; changes > 0; --changes) {
            bytes[random() % bytes.size()] = static_cast<char>(random());
        }
        SCOPED_TRACE(i);
        load_bytes(dir, bytes);
    }
}

}  // namespace
}  // namespace etendue
