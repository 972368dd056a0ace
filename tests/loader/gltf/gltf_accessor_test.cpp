// Accessors, through the loader: every legal way to store numbers, and every way to point outside.

#include "loader/gltf/gltf_accessor.h"

#include "loader/gltf/gltf_builder.h"

#include <cstdint>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace etendue {
namespace {

const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

template <typename T>
void expect_indices(int component_type) {
    GltfBuilder builder;
    builder.add_triangle()["indices"] = builder.accessor(std::vector<T>{2, 0, 1}, "SCALAR", component_type, 3);
    EXPECT_EQ(first_primitive(builder.load()).triangles.at(0), (std::array<std::uint32_t, 3>{2, 0, 1}));
}

TEST(Accessor, IndicesOfEveryType) {
    expect_indices<std::uint8_t>(5121);
    expect_indices<std::uint16_t>(5123);
    expect_indices<std::uint32_t>(5125);
}

TEST(Accessor, TexcoordsOfEveryType) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    const std::vector<std::uint8_t> bytes{0, 255, 51, 0, 0, 0};
    const std::vector<std::uint16_t> shorts{65535, 0, 0, 13107, 0, 0};
    primitive["attributes"]["TEXCOORD_0"] = builder.accessor(bytes, "VEC2", 5121, 3, true);
    primitive["attributes"]["TEXCOORD_1"] = builder.accessor(shorts, "VEC2", 5123, 3, true);
    const LoadedScene loaded = builder.load();
    const PrimitiveDesc& p = first_primitive(loaded);
    EXPECT_EQ(p.uv0[0], Vec2f(0, 1));
    EXPECT_FLOAT_EQ(p.uv0[1].x, 0.2f);
    EXPECT_EQ(p.uv1[0], Vec2f(1, 0));
    EXPECT_FLOAT_EQ(p.uv1[1].y, 0.2f);
}

TEST(Accessor, ColorsOfThreeOrFourComponents) {
    GltfBuilder rgb;
    rgb.add_triangle()["attributes"]["COLOR_0"] =
        rgb.accessor(std::vector<std::uint16_t>{65535, 0, 0, 0, 65535, 0, 0, 0, 0}, "VEC3", 5123, 3, true);
    EXPECT_EQ(first_primitive(rgb.load()).colors[1], Vec4f(0, 1, 0, 1));

    GltfBuilder rgba;
    rgba.add_triangle()["attributes"]["COLOR_0"] = rgba.floats({0, 0, 0, 0.5f, 1, 2, 3, 1, 0, 0, 0, 0}, 4);
    const LoadedScene loaded = rgba.load();
    EXPECT_EQ(first_primitive(loaded).colors[0].w, 0.5f);
    EXPECT_EQ(first_primitive(loaded).colors[1], Vec4f(1, 2, 3, 1));
}

TEST(Accessor, InterleavedWithOffsets) {
    GltfBuilder builder;
    // position, normal, position, normal, ...
    std::vector<float> vertices;
    for (std::size_t i = 0; i < 3; ++i) {
        vertices.insert(vertices.end(), kTriangle.begin() + std::ptrdiff_t(3 * i),
                        kTriangle.begin() + std::ptrdiff_t(3 * i) + 3);
        vertices.insert(vertices.end(), {0, 0, -2});
    }
    const int view = builder.view(vertices, 24);
    const int position = builder.accessor_of_view(view, "VEC3", 5126, 3);
    const int normal = builder.accessor_of_view(view, "VEC3", 5126, 3);
    builder.json["accessors"][std::size_t(normal)]["byteOffset"] = 12;
    builder.add_mesh({{"POSITION", position}, {"NORMAL", normal}});
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(first_primitive(loaded).positions[2], Vec3f(0, 1, 0));
    EXPECT_EQ(first_primitive(loaded).normals[2], Vec3f(0, 0, -1));  // and normalised
}

TEST(Accessor, LastElementMayEndWithTheView) {
    GltfBuilder builder;
    // Stride 16, but the last element has only its own 12 bytes.
    const std::vector<float> vertices{0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0};
    builder.add_mesh({{"POSITION", builder.accessor_of_view(builder.view(vertices, 16), "VEC3", 5126, 3)}});
    EXPECT_EQ(first_primitive(builder.load()).positions[2], Vec3f(0, 1, 0));
}

GltfBuilder sparse_triangle(bool with_base) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    nlohmann::json& accessor = builder.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    accessor["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", builder.view(std::vector<std::uint8_t>{1, 2})}, {"componentType", 5121}}},
        {"values", {{"bufferView", builder.view(std::vector<float>{5, 0, 0, 0, 6, 0})}}}};
    if (!with_base) accessor.erase("bufferView");
    return builder;
}

TEST(Accessor, SparseOverABase) {
    const LoadedScene loaded = sparse_triangle(true).load();
    EXPECT_EQ(first_primitive(loaded).positions[0], Vec3f(0, 0, 0));
    EXPECT_EQ(first_primitive(loaded).positions[1], Vec3f(5, 0, 0));
    EXPECT_EQ(first_primitive(loaded).positions[2], Vec3f(0, 6, 0));
}

TEST(Accessor, SparseOverZeros) {
    EXPECT_EQ(first_primitive(sparse_triangle(false).load()).positions[2], Vec3f(0, 6, 0));
}

TEST(Accessor, SparseWithoutElementsChangesNothing) {
    GltfBuilder builder = sparse_triangle(true);
    builder.json["accessors"][0]["sparse"]["count"] = 0;
    EXPECT_EQ(first_primitive(builder.load()).positions[1], Vec3f(1, 0, 0));
}

// Multiples of 4 up to 252 are what glTF allows.
TEST(Accessor, StridesMayBeOfAnyLength) {
    for (const std::size_t stride : {13u, 254u, 1000u}) {
        GltfBuilder builder;
        std::vector<unsigned char> vertices(2 * stride + 12);
        for (std::size_t i = 0; i < 3; ++i) std::memcpy(vertices.data() + i * stride, kTriangle.data() + 3 * i, 12);
        const int view = builder.view(vertices, static_cast<int>(stride));
        nlohmann::json& primitive = builder.add_mesh({{"POSITION", builder.accessor_of_view(view, "VEC3", 5126, 3)}});
        const int indices = builder.view(std::vector<std::uint16_t>{2, 0, 1}, 2);
        primitive["indices"] = builder.accessor_of_view(indices, "SCALAR", 5123, 3);
        const int colors = builder.view(std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255}, 3);
        primitive["attributes"]["COLOR_0"] = builder.accessor_of_view(colors, "VEC3", 5121, 3, true);
        const LoadedScene loaded = builder.load();
        const PrimitiveDesc& p = first_primitive(loaded);
        EXPECT_EQ(p.positions[2], Vec3f(0, 1, 0)) << stride;
        EXPECT_EQ(p.triangles[0], (std::array<std::uint32_t, 3>{2, 0, 1})) << stride;
        EXPECT_EQ(p.colors[1], Vec4f(0, 1, 0, 1)) << stride;
    }
}

TEST(Accessor, IndicesMayBeSparseOverZeros) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    primitive["indices"] = builder.indices({0, 0, 0});
    nlohmann::json& accessor = builder.json["accessors"][primitive["indices"].get<std::size_t>()];
    accessor.erase("bufferView");
    accessor["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", builder.view(std::vector<std::uint8_t>{0, 1})}, {"componentType", 5121}}},
        {"values", {{"bufferView", builder.view(std::vector<std::uint32_t>{1, 2})}}}};
    const LoadedScene loaded = builder.load();
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(first_primitive(loaded).triangles.at(0), (std::array<std::uint32_t, 3>{1, 2, 0}));
}

TEST(Accessor, WithoutViewIsZeros) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    builder.json["accessors"].push_back({{"type", "VEC2"}, {"componentType", 5126}, {"count", 3}});
    primitive["attributes"]["TEXCOORD_0"] = 1;
    EXPECT_EQ(first_primitive(builder.load()).uv0[1], Vec2f(0, 0));
}

struct BadAccessor {
    const char* name;
    const char* expected;
    std::function<void(GltfBuilder&)> make;
};

class BadAccessorTest : public testing::TestWithParam<BadAccessor> {};

TEST_P(BadAccessorTest, IsAnError) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    primitive["indices"] = builder.indices({0, 1, 2});
    GetParam().make(builder);
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, GetParam().expected)) << listing(loaded.problems);
}

nlohmann::json& positions(GltfBuilder& b) {
    return b.json["accessors"][0];
}
nlohmann::json& position_view(GltfBuilder& b) {
    return b.json["bufferViews"][0];
}

const BadAccessor kBadAccessors[] = {
    {"CountTooLarge", "4 elements of 12 bytes", [](GltfBuilder& b) { positions(b)["count"] = 4; }},
    {"CountHuge", "do not fit", [](GltfBuilder& b) { positions(b)["count"] = 1'000'000'000; }},
    {"CountBeyond32Bits", "must be an integer in", [](GltfBuilder& b) { positions(b)["count"] = 1'000'000'000'000; }},
    {"CountZero", "no elements", [](GltfBuilder& b) { positions(b)["count"] = 0; }},
    {"CountNegative", "must be an integer in [0", [](GltfBuilder& b) { positions(b)["count"] = -3; }},
    {"CountFraction", "must be an integer, but is 2.5", [](GltfBuilder& b) { positions(b)["count"] = 2.5; }},
    {"OffsetTooLarge", "do not fit", [](GltfBuilder& b) { positions(b)["byteOffset"] = 4; }},
    {"OffsetHuge", "do not fit", [](GltfBuilder& b) { positions(b)["byteOffset"] = 9007199254740992; }},
    {"OffsetOverflows", "must be an integer in",
     [](GltfBuilder& b) { positions(b)["byteOffset"] = 18446744073709551608ull; }},
    {"ViewBeyondBuffer", "covers 1000 bytes from 0", [](GltfBuilder& b) { position_view(b)["byteLength"] = 1000; }},
    {"ViewOffsetHuge", "bytes from 9007199254740992",
     [](GltfBuilder& b) { position_view(b)["byteOffset"] = 9007199254740992; }},
    {"StrideTooSmall", "overlap", [](GltfBuilder& b) { position_view(b)["byteStride"] = 4; }},
    {"StrideTooLarge", "byteStride", [](GltfBuilder& b) { position_view(b)["byteStride"] = 4294967296; }},
    {"StrideMakesItTooLong", "do not fit", [](GltfBuilder& b) { position_view(b)["byteStride"] = 252; }},
    {"ViewDoesNotExist", "refers to number 9", [](GltfBuilder& b) { positions(b)["bufferView"] = 9; }},
    {"BufferDoesNotExist", "refers to number 1", [](GltfBuilder& b) { position_view(b)["buffer"] = 1; }},
    {"BufferIndexWraps", "refers to number", [](GltfBuilder& b) { position_view(b)["buffer"] = 4294967296; }},
    {"ComponentTypeUnknown", "must be one of 5120", [](GltfBuilder& b) { positions(b)["componentType"] = 5124; }},
    {"TypeUnknown", "must be one of SCALAR", [](GltfBuilder& b) { positions(b)["type"] = "VEC5"; }},
    {"MatrixAsPositions", "components", [](GltfBuilder& b) { positions(b)["type"] = "MAT4"; }},
    {"Vec2AsPositions", "2 components, but this attribute takes 3",
     [](GltfBuilder& b) { positions(b)["type"] = "VEC2"; }},
    {"QuantizedPositions", "KHR_mesh_quantization", [](GltfBuilder& b) { positions(b)["componentType"] = 5122; }},
    {"FloatIndices", "cannot be indices", [](GltfBuilder& b) { b.json["accessors"][1]["componentType"] = 5126; }},
    {"SignedIndices", "cannot be indices", [](GltfBuilder& b) { b.json["accessors"][1]["componentType"] = 5122; }},
    {"VectorIndices", "cannot be indices", [](GltfBuilder& b) { b.json["accessors"][1]["type"] = "VEC3"; }},
    {"IndicesWithoutView", "no buffer view", [](GltfBuilder& b) { b.json["accessors"][1].erase("bufferView"); }},
    {"ZerosWithoutEnd", "without a buffer view; at most",
     [](GltfBuilder& b) {
         positions(b).erase("bufferView");
         positions(b)["count"] = 4'000'000'000u;
     }},
    {"AttributeDoesNotExist", "refers to number 77",
     [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 77; }},
    {"SparseIndexTooLarge", "sparse index 1 is 3",
     [](GltfBuilder& b) {
         positions(b)["sparse"] = {
             {"count", 2},
             {"indices", {{"bufferView", b.view(std::vector<std::uint16_t>{0, 3})}, {"componentType", 5123}}},
             {"values", {{"bufferView", 0}}}};
     }},
    {"SparseValuesTooShort", "do not fit",
     [](GltfBuilder& b) {
         positions(b)["sparse"] = {
             {"count", 2},
             {"indices", {{"bufferView", b.view(std::vector<std::uint8_t>{0})}, {"componentType", 5121}}},
             {"values", {{"bufferView", 0}}}};
     }},
    {"SparseCountTooLarge", "2000000000 sparse values are more than",
     [](GltfBuilder& b) {
         positions(b)["sparse"] = {{"count", 2'000'000'000},
                                   {"indices", {{"bufferView", 0}, {"componentType", 5121}}},
                                   {"values", {{"bufferView", 0}}}};
     }},
    {"SparseViewDoesNotExist", "refers to number 5",
     [](GltfBuilder& b) {
         positions(b)["sparse"] = {
             {"count", 1}, {"indices", {{"bufferView", 5}, {"componentType", 5121}}}, {"values", {{"bufferView", 0}}}};
     }},
};

INSTANTIATE_TEST_SUITE_P(All, BadAccessorTest, testing::ValuesIn(kBadAccessors),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

TEST(Accessor, IntegersMayBeWrittenAsFloats) {
    GltfBuilder builder;
    builder.add_triangle();
    positions(builder)["count"] = 3.0;
    EXPECT_EQ(first_primitive(builder.load()).positions.size(), 3u);
}

TEST(Accessor, SharingTheSameBytesWithoutEndIsAnError) {
    // A few kilobytes of JSON that ask for the same 1.2 MB several thousand times.
    GltfBuilder builder;
    std::vector<float> points(300'000, 0.0f);
    points[3] = 1.0f;
    points[7] = 1.0f;
    nlohmann::json& primitives = builder.add_mesh({{"POSITION", builder.floats(points, 3)}});
    nlohmann::json list = nlohmann::json::array();
    for (int i = 0; i < 2000; ++i) list.push_back(primitives);
    builder.json["meshes"][0]["primitives"] = list;
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "refers to the same things so often"));
}

TEST(Accessor, WorkHasALimitOfItsOwn) {
    constexpr std::uint64_t kWork = std::uint64_t{1} << 32;
    const GltfDocument document{};
    ProblemList problems;
    AccessorReader accessors(document, problems);
    EXPECT_TRUE(accessors.allow_work(kWork, {}));
    EXPECT_TRUE(accessors.allocate(kWork / 4, 1, {})) << "memory is counted by itself";
    EXPECT_FALSE(accessors.is_exhausted());
    accessors.forget();
    EXPECT_TRUE(accessors.allocate(1, 1, {}));
    EXPECT_FALSE(accessors.allow_work(4, {})) << "work stays done";
    EXPECT_TRUE(accessors.is_exhausted());
    EXPECT_TRUE(has_problem(problems, Severity::Error, "too long to load")) << listing(problems);
}

/// A triangle whose positions, normals and texture coordinates are quantised.
GltfBuilder quantized_triangle() {
    GltfBuilder builder;
    const std::vector<std::int16_t> positions{0, 0, 0, 0, 1000, 0, 0, 0, 0, -1000, 0, 0};
    const std::vector<std::int8_t> normals{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, -128, 0};
    const std::vector<std::uint16_t> uvs{0, 0, 4096, 0, 0, 65535};
    const int position = builder.accessor_of_view(builder.view(positions, 8), "VEC3", 5122, 3);
    const int normal = builder.accessor_of_view(builder.view(normals, 4), "VEC3", 5120, 3, true);
    const int uv = builder.accessor_of_view(builder.view(uvs, 4), "VEC2", 5123, 3);
    builder.add_mesh({{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}});
    builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    return builder;
}

TEST(Quantization, IntegersAreTakenAsTheyAreOrAsFractions) {
    const LoadedScene loaded = quantized_triangle().load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const PrimitiveDesc& p = loaded.scene.meshes.at(0).primitives.at(0);
    EXPECT_EQ(p.positions[1], Vec3f(1000, 0, 0));
    EXPECT_EQ(p.positions[2], Vec3f(0, -1000, 0));
    EXPECT_EQ(p.normals[0], Vec3f(0, 0, 1));
    EXPECT_EQ(p.normals[2], Vec3f(0, 0, -1));
    EXPECT_EQ(p.uv0[1], Vec2f(4096, 0));
    EXPECT_EQ(p.uv0[2], Vec2f(0, 65535));
}

/// A triangle whose positions are fractions in signed bytes, which nothing normalises afterwards.
GltfBuilder triangle_of_fractions() {
    GltfBuilder builder;
    const std::vector<std::int8_t> positions{0, 0, 0, 0, 127, 0, 0, 0, 0, -127, -128, 0};
    builder.add_mesh({{"POSITION", builder.accessor_of_view(builder.view(positions, 4), "VEC3", 5120, 3, true)}});
    builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    return builder;
}

TEST(Quantization, TheLeastFractionIsMinusOne) {
    const LoadedScene loaded = triangle_of_fractions().load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(first_primitive(loaded).positions[1], Vec3f(1, 0, 0));
    EXPECT_EQ(first_primitive(loaded).positions[2], Vec3f(0, -1, -1)) << "-128 counts as -127";
}

TEST(Quantization, SparseFractionsAreFractionsToo) {
    GltfBuilder builder = triangle_of_fractions();
    builder.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", builder.view(std::vector<std::uint8_t>{1})}, {"componentType", 5121}}},
        {"values", {{"bufferView", builder.view(std::vector<std::int8_t>{-127, 127, -128, 0})}}}};
    const LoadedScene loaded = builder.load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(first_primitive(loaded).positions[1], Vec3f(-1, 1, -1));
    EXPECT_EQ(first_primitive(loaded).positions[2], Vec3f(0, -1, -1));
}

TEST(Quantization, NeedsTheExtension) {
    GltfBuilder builder = quantized_triangle();
    builder.json.erase("extensionsUsed");
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "KHR_mesh_quantization", "/POSITION"));
}

TEST(Quantization, DoesNotAllowEverything) {
    GltfBuilder builder = quantized_triangle();
    builder.json["accessors"][1]["normalized"] = false;
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "may not have", "/NORMAL"));
}

}  // namespace
}  // namespace etendue
