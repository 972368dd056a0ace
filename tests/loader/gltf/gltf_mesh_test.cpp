#include "loader/gltf/gltf_builder.h"

#include <limits>

#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

const std::vector<float> kSquare{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

TEST(Mesh, StripsAndFansBecomeTriangles) {
    for (const int mode : {5, 6}) {
        GltfBuilder builder;
        builder.add_mesh({{"POSITION", builder.floats(kSquare, 3)}})["mode"] = mode;
        const LoadedScene loaded = builder.load();
        const PrimitiveDesc& p = first_primitive(loaded);
        ASSERT_EQ(p.triangles.size(), 2u);
        if (mode != 5) continue;
        for (const auto& [a, b, c] : p.triangles)
            EXPECT_GT(cross(p.positions[b] - p.positions[a], p.positions[c] - p.positions[a]).z, 0.0f) << "wound alike";
    }
}

TEST(Mesh, PointsAndLinesAreSkippedWithOneWarning) {
    GltfBuilder builder;
    builder.add_triangle();
    for (const int mode : {0, 1, 2, 3}) builder.add_mesh({{"POSITION", 0}})["mode"] = mode;
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(loaded.problems.all().size(), 1u) << listing(loaded.problems);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "4 times"));
    EXPECT_EQ(loaded.scene.instances.size(), 1u);
}

TEST(Mesh, PrimitivesWithoutPositionsAreSkipped) {
    GltfBuilder builder;
    builder.add_mesh({{"NORMAL", builder.floats(kSquare, 3)}});
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Warning, "without positions"));
}

TEST(Mesh, UnusedVerticesAreDropped) {
    GltfBuilder builder;
    nlohmann::json& primitive =
        builder.add_mesh({{"POSITION", builder.floats({kNan, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0}, 3)},
                          {"TEXCOORD_0", builder.floats({9, 9, 1, 1, 2, 2, 3, 3}, 2)}});
    primitive["indices"] = builder.indices({1, 2, 3});
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(first_primitive(loaded).positions.size(), 3u);
    EXPECT_EQ(first_primitive(loaded).uv0[0], Vec2f(1, 1));
}

TEST(Mesh, IndicesOutOfRangeAreErrors) {
    for (const std::uint32_t bad : {3u, 65535u, 4294967295u}) {
        GltfBuilder builder;
        builder.add_triangle()["indices"] = builder.indices({0, 1, bad});
        EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "the primitive has 3 vertices", "/indices"));
    }
}

TEST(Mesh, TrianglesAtPositionsThatAreNotFiniteAreRemoved) {
    for (const float bad : {kNan, kInf, -kInf}) {
        GltfBuilder builder;
        builder.add_mesh({{"POSITION", builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, bad, 0, 0, 0, 0, 1, 1, 0}, 3)}});
        const LoadedScene loaded = builder.load();
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "not finite are removed (once", "/POSITION"));
        ASSERT_EQ(loaded.scene.meshes.size(), 1u);
        EXPECT_EQ(loaded.scene.meshes[0].primitives[0].triangles.size(), 1u);
        EXPECT_EQ(loaded.scene.meshes[0].primitives[0].positions.size(), 3u) << "the others are not used";
    }
}

// As some exporters write them.
TEST(Mesh, ColorsInBytesAreFractions) {
    const auto color_of = [](bool normalized) {
        GltfBuilder builder;
        nlohmann::json& primitive = builder.add_triangle();
        primitive["attributes"]["COLOR_0"] = builder.accessor(
            std::vector<std::uint8_t>{255, 51, 0, 0, 255, 51, 0, 0, 255, 51, 0, 0}, "VEC4", 5121, 3, normalized);
        const LoadedScene loaded = builder.load();
        EXPECT_EQ(has_problem(loaded.problems, Severity::Warning, "not marked as normalised", "/COLOR_0"), !normalized);
        return loaded.scene.meshes.at(0).primitives.at(0).colors.at(0);
    };
    EXPECT_EQ(color_of(false), Vec4f(1.0f, 0.2f, 0.0f, 0.0f));
    EXPECT_EQ(color_of(false), color_of(true));
}

TEST(Mesh, AttributesMustBeAsManyAsPositions) {
    for (const char* name : {"NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"}) {
        GltfBuilder builder;
        const int components = std::string(name) == "NORMAL" ? 3 : name[0] == 'T' && name[1] == 'E' ? 2 : 4;
        const std::vector<float> values(static_cast<std::size_t>(2 * components), 1.0f);
        builder.add_triangle()["attributes"][name] = builder.floats(values, components);
        EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "2 values for 3 vertices", name)) << name;
    }
}

TEST(Mesh, WithoutNormalsTrianglesAreFlatAndTangentsDropped) {
    GltfBuilder builder;
    builder.add_triangle()["attributes"]["TANGENT"] = builder.floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, 4);
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(first_primitive(loaded).normals.empty());
    EXPECT_TRUE(first_primitive(loaded).tangents.empty());
}

TEST(Mesh, TexturesWithoutCoordinatesAreSaidOnWhateverLayer) {
    GltfBuilder builder;
    builder.add_triangle()["material"] = 0;
    builder.json["images"] = {
        {{"uri",
          "data:image/png;base64,"
          "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}}};
    builder.json["textures"] = {{{"source", 0}}};
    builder.json["extensionsUsed"] = {"KHR_materials_clearcoat"};
    builder.json["materials"] = {
        {{"extensions",
          {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatTexture", {{"index", 0}}}}}}}}};
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "texture coordinates", "/meshes/0/primitives/0"))
        << listing(loaded.problems);
}

TEST(Mesh, BadNormalsAreRepaired) {
    GltfBuilder builder;
    builder.add_triangle()["attributes"]["NORMAL"] = builder.floats({0, 0, 0, kNan, 0, 1, 0, 3, 0}, 3);
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(first_primitive(loaded).normals[0], Vec3f(0, 0, 1));
    EXPECT_EQ(first_primitive(loaded).normals[1], Vec3f(0, 0, 1));
    EXPECT_EQ(first_primitive(loaded).normals[2], Vec3f(0, 1, 0));
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "2 times", "/NORMAL"));
}

TEST(Mesh, TangentsAreNormalisedOrDropped) {
    const std::vector<float> up{0, 0, 1, 0, 0, 1, 0, 0, 1};
    GltfBuilder good;
    nlohmann::json& primitive = good.add_triangle();
    primitive["attributes"]["NORMAL"] = good.floats(up, 3);
    primitive["attributes"]["TANGENT"] = good.floats({2, 0, 0, -0.5f, 1, 0, 0, 1, 1, 0, 0, 0}, 4);
    const LoadedScene loaded = good.load();
    EXPECT_EQ(first_primitive(loaded).tangents[0], Vec4f(1, 0, 0, -1));
    EXPECT_EQ(first_primitive(loaded).tangents[2], Vec4f(1, 0, 0, 1));

    GltfBuilder bad;
    nlohmann::json& second = bad.add_triangle();
    second["attributes"]["NORMAL"] = bad.floats(up, 3);
    second["attributes"]["TANGENT"] = bad.floats({1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1}, 4);
    const LoadedScene dropped = bad.load();
    EXPECT_TRUE(first_primitive(dropped).tangents.empty());
    EXPECT_TRUE(has_problem(dropped.problems, Severity::Warning, "tangents"));
}

TEST(Mesh, DegenerateTrianglesAreRemovedWithOneWarning) {
    GltfBuilder builder;
    builder.add_mesh({{"POSITION", builder.floats(kSquare, 3)}})["indices"] =
        builder.indices({0, 1, 2, 0, 0, 1, 1, 3, 2, 2, 1, 2});
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(first_primitive(loaded).triangles.size(), 2u);
    EXPECT_EQ(loaded.problems.all().size(), 1u);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "degenerate triangles are removed (2 times"));
}

TEST(Mesh, StripsMayBeStitchedWithDegenerateTriangles) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_mesh({{"POSITION", builder.floats(kSquare, 3)}});
    primitive["mode"] = 5;
    primitive["indices"] = builder.indices({0, 1, 2, 2, 3, 3, 1});
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
}

TEST(Mesh, NothingButDegenerateTrianglesIsSkipped) {
    GltfBuilder builder;
    builder.add_mesh({{"POSITION", builder.floats({0, 0, 0, 0, 0, 0, 0, 0, 0}, 3)}});
    const LoadedScene loaded = builder.load();
    EXPECT_FALSE(loaded.problems.has_errors());
    EXPECT_TRUE(loaded.scene.instances.empty());
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "shows no surfaces"));
}

TEST(Mesh, LeftoverIndicesAreIgnored) {
    GltfBuilder builder;
    builder.add_mesh({{"POSITION", builder.floats(kSquare, 3)}});
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(first_primitive(loaded).triangles.size(), 1u);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "left over"));
}

TEST(Mesh, BadTexcoordsAndColorsAreRepaired) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    primitive["attributes"]["TEXCOORD_0"] = builder.floats({kNan, 0, 1, kInf, 1, 1}, 2);
    primitive["attributes"]["COLOR_0"] = builder.floats({-1, 0.5f, kNan, 1, 1, 1, 1, 1, 1, 1, 1, 1}, 4);
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(first_primitive(loaded).uv0[0], Vec2f(0, 0));
    EXPECT_EQ(first_primitive(loaded).uv0[1], Vec2f(0, 0));
    EXPECT_EQ(first_primitive(loaded).uv0[2], Vec2f(1, 1));
    EXPECT_EQ(first_primitive(loaded).colors[0], Vec4f(0, 0.5f, 1, 1));
    EXPECT_TRUE(
        has_problem(loaded.problems, Severity::Warning, "texture coordinates that are not finite", "TEXCOORD_0"));
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "vertex colours", "COLOR_0"));
}

TEST(Mesh, PrimitivesWithoutMaterialShareOne) {
    GltfBuilder builder;
    builder.json["materials"] = {{{"name", "mine"}}};
    builder.add_triangle()["material"] = 0;
    builder.add_triangle();
    builder.add_triangle();
    const LoadedScene loaded = builder.load();
    ASSERT_EQ(loaded.scene.materials.size(), 2u);
    EXPECT_EQ(loaded.scene.meshes[0].primitives[0].material.index, 0);
    EXPECT_EQ(loaded.scene.meshes[1].primitives[0].material.index, 1);
    EXPECT_EQ(loaded.scene.meshes[2].primitives[0].material.index, 1);
}

}  // namespace
}  // namespace etendue
