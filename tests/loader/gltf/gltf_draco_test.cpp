#include "loader/gltf/draco_decoder.h"
#include "loader/gltf/gltf_builder.h"

#include <array>
#include <functional>
#include <span>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr const char* kExtension = "KHR_draco_mesh_compression";

/// Two triangles with positions (attribute 0) and colours as normalised bytes (attribute 1), compressed without loss.
std::vector<char> encoded_square(int method = draco::MESH_EDGEBREAKER_ENCODING) {
    using Corner = std::array<float, 3>;
    const std::array<Corner, 6> corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0.5f}}};
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int colors = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
    for (std::size_t face = 0; face < 2; ++face) {
        const Corner* c = corners.data() + 3 * face;
        builder.SetAttributeValuesForFace(positions, draco::FaceIndex(static_cast<std::uint32_t>(face)), c[0].data(),
                                          c[1].data(), c[2].data());
        const std::array<std::uint8_t, 4> rgba{255, 51, 0, 255};
        builder.SetAttributeValuesForFace(colors, draco::FaceIndex(static_cast<std::uint32_t>(face)), rgba.data(),
                                          rgba.data(), rgba.data());
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return {buffer.data(), buffer.data() + buffer.size()};
}

/// Accessors without buffer views, as exporters write them.
int empty_accessor(GltfBuilder& builder, const char* type, int component_type, std::size_t count, bool normalized) {
    builder.json["accessors"].push_back(
        {{"type", type}, {"componentType", component_type}, {"count", count}, {"normalized", normalized}});
    return static_cast<int>(builder.json["accessors"].size()) - 1;
}

GltfBuilder compressed_mesh(const std::vector<char>& encoded = encoded_square()) {
    GltfBuilder builder;
    const int view = builder.view(encoded);
    const int positions = empty_accessor(builder, "VEC3", 5126, 4, false);
    const int colors = empty_accessor(builder, "VEC4", 5121, 4, true);
    nlohmann::json& primitive = builder.add_mesh({{"POSITION", positions}, {"COLOR_0", colors}});
    primitive["indices"] = empty_accessor(builder, "SCALAR", 5125, 6, false);
    primitive["extensions"][kExtension] = {{"bufferView", view}, {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}};
    builder.json["extensionsUsed"] = {kExtension};
    builder.json["extensionsRequired"] = {kExtension};
    return builder;
}

nlohmann::json& extension(GltfBuilder& builder) {
    return builder.json["meshes"][0]["primitives"][0]["extensions"][kExtension];
}

TEST(Draco, GeometryComesOutAsItWentIn) {
    const LoadedScene loaded = compressed_mesh().load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const PrimitiveDesc& p = loaded.scene.meshes.at(0).primitives.at(0);
    ASSERT_EQ(p.positions.size(), 4u);
    ASSERT_EQ(p.triangles.size(), 2u);
    for (const auto& t : p.triangles)
        EXPECT_NEAR(cross(p.positions[t[1]] - p.positions[t[0]], p.positions[t[2]] - p.positions[t[0]]).z, 1.0f, 1e-6f);
    ASSERT_EQ(p.colors.size(), 4u);
    EXPECT_EQ(p.colors[0], Vec4f(1.0f, 0.2f, 0.0f, 1.0f));
}

TEST(Draco, WhatIsDecodedSaysHowManyVerticesThereAre) {
    for (const int count : {1, 3, 5}) {
        GltfBuilder builder = compressed_mesh();
        for (nlohmann::json& accessor : builder.json["accessors"]) accessor["count"] = count;
        const LoadedScene loaded = builder.load();
        ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "the Draco data has 4 vertices",
                                "/extensions/KHR_draco_mesh_compression"));
        EXPECT_EQ(first_primitive(loaded).positions.size(), 4u);
        EXPECT_EQ(first_primitive(loaded).triangles.size(), 2u);
    }
}

struct BadPrimitive {
    const char* name;
    const char* message;
    std::function<void(GltfBuilder&)> spoil;
};

const BadPrimitive kBadPrimitives[] = {
    {"UnknownAttribute", "no attribute 7", [](GltfBuilder& b) { extension(b)["attributes"]["POSITION"] = 7; }},
    {"WrongComponents", "3 components", [](GltfBuilder& b) { extension(b)["attributes"]["COLOR_0"] = 0; }},
    {"NoView", "refers to number 9", [](GltfBuilder& b) { extension(b)["bufferView"] = 9; }},
    {"Cut", "cannot be decoded", [](GltfBuilder& b) { b.json["bufferViews"][0]["byteLength"] = 20; }},
    {"Garbage", "cannot be decoded", [](GltfBuilder& b) { b.bin[0] = 'X'; }},
    {"TypeNotAllowed", "may not have", [](GltfBuilder& b) { b.json["accessors"][1]["normalized"] = false; }},
};

class BadDraco : public testing::TestWithParam<BadPrimitive> {};

TEST_P(BadDraco, IsAnError) {
    GltfBuilder builder = compressed_mesh();
    GetParam().spoil(builder);
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, GetParam().message)) << listing(loaded.problems);
}

INSTANTIATE_TEST_SUITE_P(Draco, BadDraco, testing::ValuesIn(kBadPrimitives),
                         [](const auto& i) { return i.param.name; });

/// Returns `encoded` with `count` in place of the number of one byte at `place`.
std::vector<char> with_count(std::vector<char> encoded, std::size_t place, std::uint32_t count) {
    std::vector<char> varint;
    for (; count >= 0x80; count >>= 7) varint.push_back(static_cast<char>(count | 0x80));
    varint.push_back(static_cast<char>(count));
    encoded.erase(encoded.begin() + static_cast<std::ptrdiff_t>(place));
    encoded.insert(encoded.begin() + static_cast<std::ptrdiff_t>(place), varint.begin(), varint.end());
    return encoded;
}

// Before memory is taken: tables of 300 million faces are 7 GB.
TEST(Draco, CountsThatWouldTakeTooMuchMemoryAreRefused) {
    constexpr std::uint32_t kMany = 300'000'000;
    constexpr std::size_t kHeader = 11;
    const std::vector<char> corners = encoded_square();
    const std::vector<char> bombs[] = {
        with_count(corners, kHeader + 1, kMany),  // vertices
        with_count(corners, kHeader + 2, kMany),  // faces
        with_count(corners, kHeader + 5, kMany),  // split symbols
    };
    for (const std::vector<char>& bomb : bombs) {
        const LoadedScene loaded = compressed_mesh(bomb).load();
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "would take too much memory",
                                "/extensions/KHR_draco_mesh_compression"))
            << &bomb - bombs << listing(loaded.problems);
    }
}

// Each of the primitives claims 10 million faces, for which tables of a second are made, and has none.
TEST(Draco, BrokenDataIsNotMadeReadyForAgainAndAgain) {
    GltfBuilder builder = compressed_mesh(with_count(encoded_square(), 11 + 2, 10'000'000));
    const nlohmann::json primitive = builder.json["meshes"][0]["primitives"][0];
    for (int i = 1; i < 100; ++i) builder.json["meshes"][0]["primitives"].push_back(primitive);
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "cannot be decoded"));
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "would take too much memory"));
}

TEST(Draco, EveryMethodAsksBeforeAttributesAreDecoded) {
    // Positions of three floats and colours of four bytes, as such and as integers, and two places each.
    constexpr std::uint64_t kAttributes = 4 * (3 * (4 + 4) + 8 + 4 * (1 + 4) + 8);
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        const std::vector<char> encoded = encoded_square(method);
        const std::span bytes(reinterpret_cast<const unsigned char*>(encoded.data()), encoded.size());
        std::uint64_t last = 0;
        const auto mesh = decode_draco_mesh(bytes, [&](std::uint64_t more) {
            last = more;
            return true;
        });
        ASSERT_TRUE(mesh);
        EXPECT_EQ(mesh->num_faces(), 2u);
        EXPECT_EQ(last, kAttributes);
        EXPECT_FALSE(decode_draco_mesh(bytes, [&](std::uint64_t more) { return more < kAttributes; }));
    }
}

// Whatever a byte is changed to, the file loads or is refused.
TEST(Draco, DamagedBytesAreNoDanger) {
    const std::vector<char> good = encoded_square();
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (const int value : {0x00, 0x7f, 0xff}) {
            std::vector<char> bad = good;
            bad[i] = static_cast<char>(value);
            static_cast<void>(compressed_mesh(bad).load());
        }
    }
}

}  // namespace
}  // namespace etendue
