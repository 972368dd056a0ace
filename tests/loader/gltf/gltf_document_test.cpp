// The document as a whole: types, references, extensions, buffers.

#include "loader/gltf/gltf_builder.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

GltfBuilder triangle() {
    GltfBuilder builder;
    builder.add_triangle();
    return builder;
}

TEST(GltfDocument, LoadsATriangle) {
    const LoadedScene loaded = triangle().load();
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.instances.size(), 1u);
    EXPECT_EQ(loaded.scene.meshes.at(0).primitives.at(0).triangles.size(), 1u);
    EXPECT_EQ(loaded.scene.materials.size(), 1u);  // the default one
    EXPECT_EQ(loaded.scene.inputs.size(), 2u);
}

struct BadDocument {
    const char* name;
    const char* patch;  ///< JSON merge patch on the triangle
    const char* expected;
    const char* pointer;
};

class BadDocumentTest : public testing::TestWithParam<BadDocument> {};

TEST_P(BadDocumentTest, IsAnErrorWithItsPlace) {
    GltfBuilder builder = triangle();
    builder.json.merge_patch(nlohmann::json::parse(GetParam().patch));
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, GetParam().expected, GetParam().pointer))
        << listing(loaded.problems);
}

const BadDocument kBadDocuments[] = {
    {"NoAsset", R"({"asset": null})", "'asset' is missing", ""},
    {"NoVersion", R"({"asset": {"version": null}})", "'version' is missing", "/asset"},
    {"NewerNeeded", R"({"asset": {"version": "2.1", "minVersion": "2.1"}})", "needs glTF 2.1", "/asset/minVersion"},
    {"OldVersion", R"({"asset": {"version": "1.0"}})", "glTF 1.0 is not supported", "/asset/version"},
    {"NodesObject", R"({"nodes": {}})", "must be an array, but is an object", "/nodes"},
    {"NodeNumber", R"({"nodes": [3]})", "must be an object, but is a number", "/nodes/0"},
    {"MeshString", R"({"nodes": [{"mesh": "0"}]})", "must be an integer, but is a string", "/nodes/0/mesh"},
    {"MeshMissing", R"({"nodes": [{"mesh": 1}]})", "refers to number 1 of /meshes, but there are 1", "/nodes/0/mesh"},
    {"MatrixShort", R"({"nodes": [{"mesh": 0, "matrix": [1, 2, 3]}]})", "must have 16 elements", "/nodes/0/matrix"},
    {"MatrixText", R"({"nodes": [{"mesh": 0, "translation": [0, "1", 0]}]})", "must be a number",
     "/nodes/0/translation/1"},
    {"NumberBeyondFloat", R"({"nodes": [{"mesh": 0, "translation": [0, 1e300, 0]}]})", "must be a number in",
     "/nodes/0/translation/1"},
    {"ChildMissing", R"({"nodes": [{"mesh": 0, "children": [5]}]})", "refers to number 5", "/nodes/0/children/0"},
    {"CameraMissing", R"({"nodes": [{"camera": 0}]})", "there are 0", "/nodes/0/camera"},
    {"SkinMissing", R"({"nodes": [{"mesh": 0, "skin": 0}]})", "there are 0", "/nodes/0/skin"},
    {"LightMissing", R"({"nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}}]})", "there are 0", "/light"},
    {"SceneMissing", R"({"scene": 4})", "there are 1", "/scene"},
    {"SceneFraction", R"({"scene": 0.5})", "must be an integer", "/scene"},
    {"SceneNodeNegative", R"({"scenes": [{"nodes": [-1]}]})", "refers to number -1", "/scenes/0/nodes/0"},
    {"ModeUnknown", R"({"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 7}]}]})", "in [0, 6]",
     "/mode"},
    {"NoAttributes", R"({"meshes": [{"primitives": [{}]}]})", "'attributes' is missing", "/meshes/0/primitives/0"},
    {"MaterialMissing", R"({"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}]})",
     "there are 0", "/material"},
    {"TextureMissing", R"({"materials": [{"emissiveTexture": {"index": 0}}]})", "there are 0",
     "/emissiveTexture/index"},
    {"SamplerMissing", R"({"textures": [{"sampler": 2}]})", "there are 0", "/textures/0/sampler"},
    {"SourceMissing", R"({"textures": [{"source": 2}]})", "there are 0", "/textures/0/source"},
    {"WrapUnknown", R"({"samplers": [{"wrapS": 1}]})", "must be one of 33071", "/samplers/0/wrapS"},
    {"AlphaModeUnknown", R"({"materials": [{"alphaMode": "GLASS"}]})", "must be one of OPAQUE", "/alphaMode"},
    {"DoubleSidedNumber", R"({"materials": [{"doubleSided": 1}]})", "must be true or false", "/doubleSided"},
    {"ImageViewMissing", R"({"images": [{"bufferView": 12}]})", "refers to number 12", "/images/0/bufferView"},
    {"CameraTypeUnknown", R"({"cameras": [{"type": "fisheye"}]})", "must be one of perspective", "/cameras/0/type"},
    {"LightTypeUnknown", R"({"extensions": {"KHR_lights_punctual": {"lights": [{"type": "area"}]}}})", "must be one of",
     "/lights/0/type"},
    {"BufferOutside", R"({"buffers": [{"byteLength": 36, "uri": "../scene.bin"}]})", "'..'", "/buffers/0"},
    {"BufferAbsolute", R"({"buffers": [{"byteLength": 36, "uri": "/etc/passwd"}]})", "absolute", "/buffers/0"},
    {"BufferHttp", R"({"buffers": [{"byteLength": 36, "uri": "http://localhost/x"}]})", "other URIs", "/buffers/0"},
    {"BufferEncoded", R"({"buffers": [{"byteLength": 36, "uri": "%2e%2e/scene.bin"}]})", "'..'", "/buffers/0"},
    {"BufferMissing", R"({"buffers": [{"byteLength": 36, "uri": "other.bin"}]})", "does not exist", "/buffers/0"},
    {"BufferShort", R"({"buffers": [{"byteLength": 40, "uri": "scene.bin"}]})", "40 are needed", "/buffers/0"},
    {"BufferHuge", R"({"buffers": [{"byteLength": 9007199254740992, "uri": "scene.bin"}]})", "are needed",
     "/buffers/0"},
    {"BufferEmpty", R"({"buffers": [{"byteLength": 0, "uri": "scene.bin"}]})", "no bytes", "/buffers/0"},
    {"BufferWithoutUri", R"({"buffers": [{"byteLength": 36}]})", "neither a URI", "/buffers/0"},
    {"DataUriNotBase64", R"({"buffers": [{"byteLength": 3, "uri": "data:text/plain,abc"}]})", "base64", "/buffers/0"},
    {"DataUriBroken", R"({"buffers": [{"byteLength": 3, "uri": "data:;base64,AB*D"}]})", "base64", "/buffers/0"},
    {"DataUriShort", R"({"buffers": [{"byteLength": 36, "uri": "data:;base64,AAAA"}]})", "data URI has 3",
     "/buffers/0"},
};

INSTANTIATE_TEST_SUITE_P(All, BadDocumentTest, testing::ValuesIn(kBadDocuments),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

TEST(GltfDocument, ReportsAllWrongTypesAtOnce) {
    GltfBuilder builder = triangle();
    builder.json["nodes"][0]["name"] = 1;
    builder.json["scene"] = "x";
    builder.json["meshes"][0]["name"] = false;
    EXPECT_EQ(builder.load().problems.error_count(), 3u);
}

TEST(GltfDocument, AcceptsBuffersThatAreRoundedUpAndBoundsThatAreNoNumbers) {
    for (const char* patch : {R"({"buffers": [{"byteLength": 38, "uri": "scene.bin"}]})",
                              R"({"images": [{"uri": "missing.png", "bufferView": 0}]})"}) {
        GltfBuilder builder = triangle();
        builder.json.merge_patch(nlohmann::json::parse(patch));
        const LoadedScene loaded = builder.load();
        EXPECT_FALSE(loaded.problems.has_errors()) << patch << listing(loaded.problems);
        EXPECT_EQ(loaded.scene.instances.size(), 1u) << patch;
    }
    GltfBuilder builder = triangle();
    builder.json["accessors"][0]["min"] = {nullptr, nullptr, nullptr};
    builder.json["accessors"][0]["max"] = "none";
    EXPECT_FALSE(builder.load().problems.has_errors());
}

TEST(GltfDocument, FilesOfImagesAreKeptWhetherOrNotTheyAreShown) {
    const TempDir dir;
    GltfBuilder builder = triangle();
    builder.json["images"] = {{{"uri", "unused.png"}}, {{"uri", "unused.png"}}, {{"uri", "missing.png"}}};
    builder.write(dir);
    dir.write("unused.png", "not even an image");
    const SceneDesc scene = inspect_scene(dir.path() / "scene.gltf").scene;
    EXPECT_EQ(scene.inputs.size(), 2u) << "what nothing shows is not read";
    EXPECT_EQ(scene.files_to_keep().size(), 3u);
}

TEST(GltfDocument, ArraysAndScalarsAreNoDocument) {
    const TempDir dir;
    for (const char* text : {"[]", "3", "null", "\"glTF\"", "{}", "", "glTF"}) {
        dir.write("scene.gltf", text);
        EXPECT_TRUE(inspect_scene(dir.path() / "scene.gltf").problems.has_errors()) << text;
    }
}

TEST(GltfDocument, DeepNestingIsAnError) {
    const TempDir dir;
    const std::string open(1'000'000, '[');
    const std::string close(1'000'000, ']');
    dir.write("scene.gltf", R"({"asset": {"version": "2.0"}, "extras": )" + open + close + "}");
    const LoadedScene loaded = inspect_scene(dir.path() / "scene.gltf");
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "nest deeper"));
}

TEST(GltfDocument, ExtrasMayBeAnything) {
    GltfBuilder builder = triangle();
    builder.json["extras"] = {1, {{"a", nullptr}}};
    builder.json["nodes"][0]["extras"] = "text";
    builder.json["materials"] = {{{"extras", nullptr}, {"extensions", {{"VENDOR_x", {{"y", {1, nullptr}}}}}}}};
    EXPECT_FALSE(builder.load().problems.has_errors());
}

TEST(GltfDocument, RequiredExtensionsMustBeSupported) {
    for (const char* name : {"KHR_texture_basisu", "VENDOR_unknown", "KHR_techniques_webgl"}) {
        GltfBuilder builder = triangle();
        builder.json["extensionsUsed"] = {name};
        builder.json["extensionsRequired"] = {name};
        const LoadedScene loaded = builder.load();
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, name, "/extensionsRequired/0"));
    }
    GltfBuilder builder = triangle();
    builder.json["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_ior"};
    builder.json["extensionsRequired"] = {"KHR_texture_transform"};
    const LoadedScene loaded = builder.load();
    EXPECT_FALSE(loaded.problems.has_errors());
    EXPECT_EQ(loaded.scene.extensions_used.size(), 2u);
}

TEST(GltfDocument, UsedExtensionsAreOneWarning) {
    GltfBuilder builder = triangle();
    builder.json["extensionsUsed"] = {"VENDOR_one", "KHR_materials_unlit", "VENDOR_two"};
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(loaded.problems.all().size(), 1u);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "VENDOR_one, VENDOR_two"));
    EXPECT_EQ(loaded.scene.extensions_used, (std::vector<std::string>{"KHR_materials_unlit"}));
    EXPECT_EQ(loaded.scene.extensions_ignored, (std::vector<std::string>{"VENDOR_one", "VENDOR_two"}));
}

TEST(GltfDocument, BuffersFromLinksOutsideAreRefused) {
    const TempDir outside;
    outside.write("scene.bin", std::string(100, '\0'));
    const TempDir dir;
    triangle().write(dir);
    std::filesystem::remove(dir.path() / "scene.bin");
    std::filesystem::create_symlink(outside.path() / "scene.bin", dir.path() / "scene.bin");
    const LoadedScene loaded = inspect_scene(dir.path() / "scene.gltf");
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "link leads out", "/buffers/0"));
}

TEST(GltfDocument, BufferFilesMayBeLongerThanTheirBuffer) {
    const TempDir dir;
    triangle().write(dir);
    std::filesystem::resize_file(dir.path() / "scene.bin", 100);
    EXPECT_FALSE(inspect_scene(dir.path() / "scene.gltf").problems.has_errors());
}

TEST(GltfDocument, BuffersMayShareAFile) {
    GltfBuilder builder = triangle();
    builder.json["buffers"] = {{{"byteLength", 36}, {"uri", "scene.bin"}},
                               {{"byteLength", 12}, {"uri", "./scene.bin"}}};
    const LoadedScene loaded = builder.load();
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.meshes.at(0).primitives.at(0).positions.at(2), Vec3f(0, 1, 0));
}

TEST(GltfDocument, OneLargeFileIsNotReadAgainAndAgain) {
    GltfBuilder builder = triangle();
    builder.bin.resize(std::size_t{2} << 20);
    builder.json["buffers"] = nlohmann::json::array();
    for (int i = 0; i < 130; ++i)
        builder.json["buffers"].push_back({{"byteLength", builder.bin.size()}, {"uri", "scene.bin"}});
    builder.json["bufferViews"][0]["buffer"] = 129;
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "more than the limit", "/buffers/129"));
}

TEST(GltfDocument, BuffersThatNothingReadsMayBeAbsent) {
    GltfBuilder builder = triangle();
    builder.json["buffers"] = {{{"byteLength", 36}, {"uri", "scene.bin"}},
                               {{"byteLength", 12}},
                               {{"byteLength", 12}, {"uri", "missing.bin"}},
                               {{"byteLength", 12}, {"uri", "../outside.bin"}},
                               {{"byteLength", 12}, {"uri", "data:;base64,AAAA"}}};
    for (int buffer = 1; buffer < 5; ++buffer)
        builder.json["bufferViews"].push_back({{"buffer", buffer}, {"byteLength", 12}});
    const LoadedScene loaded = builder.load();
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.inputs.size(), 2u);
}

TEST(GltfDocument, PlaceholdersThatNothingReadsMayBeEmpty) {
    GltfBuilder builder = triangle();
    builder.json["buffers"] = {{{"byteLength", 36}, {"uri", "scene.bin"}},
                               {{"byteLength", 0}},
                               {{"byteLength", 0}, {"uri", ""}},
                               {{"byteLength", 0}, {"uri", "scene.bin"}}};
    builder.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 0}});
    builder.json["accessors"].push_back({{"componentType", 5126}, {"count", 0}, {"type", "VEC3"}});
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.instances.size(), 1u);
}

TEST(GltfDocument, AnAbsentBufferIsReportedOnceHoweverMuchReadsIt) {
    GltfBuilder builder = triangle();
    nlohmann::json& primitives = builder.json["meshes"][0]["primitives"];
    primitives.push_back(nlohmann::json(primitives[0]));
    builder.json["buffers"] = {{{"byteLength", 1000}, {"uri", "missing.bin"}}};
    EXPECT_EQ(builder.load().problems.error_count(), 1u) << listing(builder.load().problems);
}

TEST(GltfDocument, BuffersFromDataUris) {
    GltfBuilder builder = triangle();
    // The triangle's nine floats: nine zero words but for the fourth and the eighth, which are 1.0f.
    builder.json["buffers"] = {
        {{"byteLength", 36},
         {"uri", "data:application/gltf-buffer;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}};
    const LoadedScene loaded = builder.load();
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.meshes.at(0).primitives.at(0).positions.at(2), Vec3f(0, 1, 0));
}

// Schemes are the same in upper case, any character may be written as its code, and editors break lines.
TEST(GltfDocument, DataUrisAsOthersWriteThem) {
    for (const char* uri : {"DATA:;BASE64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA",
                            "data:application/octet-stream; base64 ,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA",
                            "data:;base64,AAAAAAAAAAAAAAAA%41ACAPwAAAAAAAAAAAAAAAAAAgD8AAAA%41",
                            "data:;base64,AAAAAAAAAAAAAAAAAACAPwAA\nAAAAAAAAAAAAAAAAgD8AAAAA\r\n"}) {
        GltfBuilder builder = triangle();
        builder.json["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
        const LoadedScene loaded = builder.load();
        ASSERT_FALSE(loaded.problems.has_errors()) << uri << listing(loaded.problems);
        EXPECT_EQ(loaded.scene.meshes.at(0).primitives.at(0).positions.at(2), Vec3f(0, 1, 0)) << uri;
    }
}

}  // namespace
}  // namespace etendue
