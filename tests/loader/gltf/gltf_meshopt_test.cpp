#include "loader/gltf/gltf_builder.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <meshoptimizer.h>

namespace etendue {
namespace {

using Bytes = std::vector<unsigned char>;

const std::vector<float> kPositions{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5f};
const std::vector<std::uint32_t> kIndices{0, 1, 2, 2, 1, 3};

Bytes encode_vertices(const void* vertices, std::size_t count, std::size_t stride) {
    Bytes bytes(meshopt_encodeVertexBufferBound(count, stride));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), vertices, count, stride));
    return bytes;
}

Bytes encode_triangles(const std::vector<std::uint32_t>& indices) {
    Bytes bytes(meshopt_encodeIndexBufferBound(indices.size(), 4));
    bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return bytes;
}

/// A view that lies in a buffer without bytes and whose content is `compressed`.
int compressed_view(GltfBuilder& builder, const Bytes& compressed, std::size_t count, std::size_t stride,
                    const char* mode, const char* filter = nullptr) {
    const int source = builder.view(compressed);
    const nlohmann::json from = builder.json["bufferViews"][static_cast<std::size_t>(source)];
    nlohmann::json extension = {{"buffer", 0},
                                {"byteOffset", from["byteOffset"]},
                                {"byteLength", from["byteLength"]},
                                {"byteStride", stride},
                                {"count", count},
                                {"mode", mode}};
    if (filter != nullptr) extension["filter"] = filter;
    builder.json["bufferViews"].push_back(
        {{"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", extension}}}});
    return static_cast<int>(builder.json["bufferViews"].size()) - 1;
}

/// Two triangles whose positions and indices are compressed.
GltfBuilder meshopt_mesh() {
    GltfBuilder builder;
    const int positions = compressed_view(builder, encode_vertices(kPositions.data(), 4, 12), 4, 12, "ATTRIBUTES");
    const int indices = compressed_view(builder, encode_triangles(kIndices), 6, 4, "TRIANGLES");
    builder.add_mesh({{"POSITION", builder.accessor_of_view(positions, "VEC3", 5126, 4)}})["indices"] =
        builder.accessor_of_view(indices, "SCALAR", 5125, 6);
    builder.json["extensionsUsed"] = {"EXT_meshopt_compression"};
    builder.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    builder.json["buffers"] = {
        {{"byteLength", builder.bin.size()}, {"uri", "scene.bin"}},
        {{"byteLength", 1 << 20}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    return builder;
}

nlohmann::json& extension(GltfBuilder& builder, std::size_t compressed) {
    return builder.json["bufferViews"][2 * compressed + 1]["extensions"]["EXT_meshopt_compression"];
}

/// `builder` with the ratified extension's name in place of its predecessor's.
GltfBuilder renamed(const GltfBuilder& builder) {
    GltfBuilder result = builder;
    std::string text = builder.json.dump();
    for (std::size_t at = 0; (at = text.find("EXT_meshopt", at)) != std::string::npos;) text.replace(at, 3, "KHR");
    result.json = nlohmann::json::parse(text);
    return result;
}

TEST(Meshopt, BothExtensionsAreRead) {
    const LoadedScene loaded = renamed(meshopt_mesh()).load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(first_primitive(loaded).positions, first_primitive(meshopt_mesh().load()).positions);
    EXPECT_EQ(loaded.scene.extensions_used, (std::vector<std::string>{"KHR_meshopt_compression"}));
}

// Version 1, all of it literal: the first vertex is the element before it, then each adds to the last.
TEST(Meshopt, AttributesOfVersion1AreRead) {
    GltfBuilder builder;
    Bytes bytes{0xa1, 0xff, 0xff, 0xff};
    for (std::size_t k = 0; k < 12; ++k)
        for (std::size_t i = 0; i < 4; ++i) {
            const auto* values = reinterpret_cast<const unsigned char*>(kPositions.data());
            const int delta = values[12 * i + k] - (i > 0 ? values[12 * (i - 1) + k] : 0);
            const auto signed_delta = static_cast<signed char>(delta);
            bytes.push_back(static_cast<unsigned char>((signed_delta << 1) ^ (signed_delta >> 7)));
        }
    bytes.resize(bytes.size() + 24);
    const int positions = compressed_view(builder, bytes, 4, 12, "ATTRIBUTES");
    builder.add_mesh({{"POSITION", builder.accessor_of_view(positions, "VEC3", 5126, 4)}})["indices"] =
        builder.indices(kIndices);
    builder.json["extensionsUsed"] = {"EXT_meshopt_compression"};
    builder.json["buffers"] = {{{"byteLength", builder.bin.size()}, {"uri", "scene.bin"}}, {{"byteLength", 48}}};
    const LoadedScene loaded = renamed(builder).load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(first_primitive(loaded).positions.at(3), Vec3f(1, 1, 0.5f));
}

TEST(Meshopt, TheBufferInItsPlaceMayBeAbsentAndNeedNotSaySo) {
    GltfBuilder builder = meshopt_mesh();
    builder.json["buffers"][1].erase("extensions");
    EXPECT_EQ(first_primitive(builder.load()).positions.size(), 4u);
    builder.json["buffers"][1]["uri"] = "missing.bin";
    EXPECT_EQ(first_primitive(builder.load()).positions.size(), 4u);
}

TEST(Meshopt, AnAbsentBufferOfCompressedBytesIsAnError) {
    GltfBuilder builder = meshopt_mesh();
    builder.json["buffers"][0]["uri"] = "missing.bin";
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "'missing.bin': the file does not exist",
                            "/EXT_meshopt_compression"));
}

TEST(Meshopt, WhatNothingReadsStaysCompressed) {
    GltfBuilder builder = meshopt_mesh();
    for (const Bytes& bytes : {Bytes(8, 0xff), encode_vertices(kPositions.data(), 4, 12)})
        compressed_view(builder, bytes, 4, 12, "ATTRIBUTES");
    builder.json["bufferViews"].back()["extensions"]["EXT_meshopt_compression"]["count"] = 0;
    builder.json["buffers"][0]["byteLength"] = builder.bin.size();
    EXPECT_FALSE(builder.load().problems.has_errors()) << listing(builder.load().problems);
    builder.accessor_of_view(5, "VEC3", 5126, 4);
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "damaged", "/EXT_meshopt_compression"))
        << "an accessor reads it";
}

TEST(Meshopt, ImagesAreRead) {
    GltfBuilder builder = meshopt_mesh();
    // Two elements of 36 bytes.
    std::string png = png_bytes();
    png.resize(72);
    const int pixels = compressed_view(builder, encode_vertices(png.data(), 2, 36), 2, 36, "ATTRIBUTES");
    builder.json["buffers"][0]["byteLength"] = builder.bin.size();
    builder.json["images"] = {{{"bufferView", pixels}, {"mimeType", "image/png"}}};
    builder.json["textures"] = {{{"source", 0}}};
    builder.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
    const LoadedScene loaded = builder.load();
    ASSERT_EQ(loaded.scene.images.size(), 1u) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.images[0].width, 1);
}

// The densest code claims 1.28 GB for 1.25 MB, of which none is taken before it is known that this is too much.
TEST(Meshopt, CountsWithAllThatIsDecoded) {
    GltfBuilder builder = meshopt_mesh();
    Bytes bytes(1'250'000);
    bytes[0] = 0xa1;
    const int claim = compressed_view(builder, bytes, 5'000'000, 256, "ATTRIBUTES");
    builder.json["buffers"][0]["byteLength"] = builder.bin.size();
    EXPECT_FALSE(builder.load().problems.has_errors()) << listing(builder.load().problems);
    builder.accessor_of_view(claim, "VEC3", 5126, 3);
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "would take too much memory",
                            "/bufferViews/5/extensions/EXT_meshopt_compression"))
        << listing(builder.load().problems);
}

TEST(Meshopt, PositionsAndIndicesComeOutAsTheyWentIn) {
    const LoadedScene loaded = meshopt_mesh().load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const PrimitiveDesc& p = loaded.scene.meshes.at(0).primitives.at(0);
    ASSERT_EQ(p.positions.size(), 4u);
    EXPECT_EQ(p.positions[3], Vec3f(1, 1, 0.5f));
    ASSERT_EQ(p.triangles.size(), 2u);
    // The codec may turn a triangle around its corners, not over.
    EXPECT_NEAR(cross(p.positions[p.triangles[0][1]] - p.positions[p.triangles[0][0]],
                      p.positions[p.triangles[0][2]] - p.positions[p.triangles[0][0]])
                    .z,
                1.0f, 1e-6f);
}

TEST(Meshopt, FiltersAreApplied) {
    GltfBuilder builder = meshopt_mesh();
    // Octahedral normals of eight bits: x, y, one, padding. (0, 0) is +z, (127, 0) is +x.
    const std::vector<std::int8_t> octahedral{0, 0, 127, 0, 127, 0, 127, 0, 0, 127, 127, 0, 0, 0, 127, 0};
    const int normals =
        compressed_view(builder, encode_vertices(octahedral.data(), 4, 4), 4, 4, "ATTRIBUTES", "OCTAHEDRAL");
    builder.json["buffers"][0]["byteLength"] = builder.bin.size();
    builder.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        builder.accessor_of_view(normals, "VEC3", 5120, 4, true);
    builder.json["extensionsUsed"].push_back("KHR_mesh_quantization");
    const LoadedScene loaded = builder.load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const PrimitiveDesc& p = loaded.scene.meshes.at(0).primitives.at(0);
    EXPECT_LT(length(p.normals[0] - Vec3f(0, 0, 1)), 0.02f) << p.normals[0];
    EXPECT_LT(length(p.normals[1] - Vec3f(1, 0, 0)), 0.02f) << p.normals[1];
    EXPECT_LT(length(p.normals[2] - Vec3f(0, 1, 0)), 0.02f) << p.normals[2];
}

struct BadView {
    const char* name;
    const char* message;
    std::function<void(GltfBuilder&)> spoil;
};

const BadView kBadViews[] = {
    {"OutsideItsBuffer", "the buffer has", [](GltfBuilder& b) { extension(b, 0)["byteLength"] = 100000; }},
    {"OffsetHuge", "the buffer has", [](GltfBuilder& b) { extension(b, 0)["byteOffset"] = 9007199254740992; }},
    {"TooManyForItsBytes", "cannot come out of", [](GltfBuilder& b) { extension(b, 0)["count"] = 4294967290; }},
    {"NoElements", "no elements", [](GltfBuilder& b) { extension(b, 0)["count"] = 0; }},
    {"MoreThanItHolds", "damaged", [](GltfBuilder& b) { extension(b, 0)["count"] = 300; }},
    {"Cut", "damaged", [](GltfBuilder& b) { extension(b, 1)["byteLength"] = 3; }},
    {"NotTriangles", "no whole triangles", [](GltfBuilder& b) { extension(b, 1)["count"] = 5; }},
    {"OddStride", "multiple of 4", [](GltfBuilder& b) { extension(b, 0)["byteStride"] = 10; }},
    {"IndexStride", "stride of 2 or 4", [](GltfBuilder& b) { extension(b, 1)["byteStride"] = 12; }},
    {"FilterOnIndices", "only attributes", [](GltfBuilder& b) { extension(b, 1)["filter"] = "EXPONENTIAL"; }},
    {"FilterStride", "octahedral filter", [](GltfBuilder& b) { extension(b, 0)["filter"] = "OCTAHEDRAL"; }},
    {"UnknownMode", "must be one of", [](GltfBuilder& b) { extension(b, 0)["mode"] = "POINTS"; }},
    {"Garbage", "damaged", [](GltfBuilder& b) { b.bin[0] ^= 0xff; }},
};

class BadMeshopt : public testing::TestWithParam<BadView> {};

TEST_P(BadMeshopt, IsAnError) {
    GltfBuilder builder = meshopt_mesh();
    GetParam().spoil(builder);
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, GetParam().message)) << listing(loaded.problems);
}

INSTANTIATE_TEST_SUITE_P(Meshopt, BadMeshopt, testing::ValuesIn(kBadViews), [](const auto& i) { return i.param.name; });

TEST(Meshopt, PlainViewsOfTheFallbackBufferAreErrors) {
    GltfBuilder builder = meshopt_mesh();
    builder.json["bufferViews"][1].erase("extensions");
    EXPECT_TRUE(
        has_problem(builder.load().problems, Severity::Error, "neither a URI nor a binary chunk", "/buffers/1"));
}

}  // namespace
}  // namespace etendue
