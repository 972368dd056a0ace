// "shapes" of render.json: what it may say, and what becomes of the scene.
#include "loader/gltf/gltf_builder.h"
#include "loader/settings/render_json.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A node "Ball" with a triangle of "paper", one "Twin" with the same mesh and scaled, an empty node "Empty", and a
/// material "glass" that nothing has.
LoadedScene load_shapes(const std::string& shapes) {
    GltfBuilder builder;
    builder.add_triangle()["material"] = 0;
    builder.json["materials"] = {{{"name", "paper"}}, {{"name", "glass"}}};
    builder.json["nodes"][0]["name"] = "Ball";
    builder.json["nodes"][0]["translation"] = {1, 2, 3};
    builder.json["nodes"].push_back({{"name", "Twin"}, {"mesh", 0}, {"scale", {2, 1, 1}}});
    builder.json["nodes"].push_back({{"name", "Empty"}, {"translation", {0, 5, 0}}});
    builder.json["scenes"][0]["nodes"] = {0, 1, 2};
    const TempDir dir;
    builder.write(dir);
    dir.write("render.json", R"({"shapes": )" + shapes + "}");
    return inspect_scene(dir.path());
}

const PrimitiveDesc& primitive_of(const SceneDesc& scene, std::size_t instance) {
    return scene.meshes.at(static_cast<std::size_t>(scene.instances.at(instance).mesh.index)).primitives.at(0);
}

std::string errors_of(const std::string& shapes) {
    const LoadedScene loaded = load_shapes(shapes);
    std::string text;
    for (const Problem& problem : loaded.problems.all())
        if (problem.severity == Severity::Error) text += problem.str() + "\n";
    return text;
}

TEST(Shapes, TakeThePlaceOfMeshes) {
    const LoadedScene loaded = load_shapes(R"({"Ball": {"type": "sphere", "radius": 2}})");
    ASSERT_FALSE(loaded.problems.has_errors());
    const SceneDesc& scene = loaded.scene;
    ASSERT_EQ(scene.instances.size(), 2u);
    const PrimitiveDesc& ball = primitive_of(scene, 0);
    ASSERT_TRUE(ball.shape);
    EXPECT_EQ(ball.shape->kind, ShapeKind::Sphere);
    EXPECT_EQ(ball.shape->half_size, Vec3f(2.0f));
    EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(ball.material.index)).name, "paper");
    EXPECT_EQ(scene.instances[0].to_world[3][1], 2.0f);
    EXPECT_FALSE(primitive_of(scene, 1).shape) << "the mesh is another node's, too";
    EXPECT_EQ(compute_bounds(scene).max.z, 5.0f);
    EXPECT_NE(dump(scene).find("sphere with half its size (2 2 2), material 0"), std::string::npos);
}

TEST(Shapes, AreSurfacesOfAScene) {
    for (const bool has_shape : {false, true}) {
        GltfBuilder builder;
        builder.json["materials"] = {{{"name", "paper"}}};
        builder.json["nodes"] = {{{"name", "Empty"}}};
        builder.json["scenes"] = {{{"nodes", {0}}}};
        const TempDir dir;
        builder.write(dir);
        if (has_shape) dir.write("render.json", R"({"shapes": {"Empty": {"type": "sphere", "material": "paper"}}})");
        const LoadedScene loaded = inspect_scene(dir.path());
        EXPECT_EQ(has_problem(loaded.problems, Severity::Warning, "shows no surfaces"), !has_shape)
            << listing(loaded.problems);
    }
}

TEST(Shapes, ManyStandAtAnEmptyNodeAndOneInPlaceOfAMesh) {
    const std::string both = R"("type": "sphere", "material": "glass"})";
    const LoadedScene loaded =
        load_shapes(R"({"a": {"node": "Empty", )" + both + R"(, "b": {"node": "Empty", )" + both + "}");
    EXPECT_FALSE(loaded.problems.has_errors());
    EXPECT_EQ(loaded.scene.instances.size(), 4u);
    EXPECT_NE(errors_of(R"({"a": {"node": "Ball", )" + both + R"(, "b": {"node": "Ball", )" + both + "}")
                  .find("takes the place of the mesh whose place 'a' has taken"),
              std::string::npos);
}

TEST(Shapes, StandAtNodesWithoutMeshesAndAtPlacesOfTheirOwn) {
    const LoadedScene loaded = load_shapes(R"({
        "Rod": {"type": "cylinder", "radius": 0.25, "height": 3, "node": "Empty", "material": "glass"},
        "Plate": {"type": "rectangle", "width": 4, "height": 2, "position": [0, 0, 5], "look_at": [0, 0, 0],
                  "material": "paper"},
        "Twin": {"type": "disk", "material": "glass"}})");
    ASSERT_FALSE(loaded.problems.has_errors());
    const SceneDesc& scene = loaded.scene;
    ASSERT_EQ(scene.instances.size(), 4u);
    EXPECT_EQ(primitive_of(scene, 1).shape->half_size.x, 0.5f);
    EXPECT_EQ(scene.instances[1].to_world[0][0], 2.0f) << "an ellipse";
    const InstanceDesc& plate = scene.instances[2];
    EXPECT_EQ(plate.name, "Plate");
    EXPECT_EQ(primitive_of(scene, 2).shape->half_size.x, 2.0f);
    EXPECT_EQ(primitive_of(scene, 2).shape->half_size.y, 1.0f);
    // Its front, local -z, looks along the world's -z.
    EXPECT_NEAR(plate.to_world[2][2], 1.0f, 1e-6f);
    EXPECT_EQ(plate.to_world[3][2], 5.0f);
    const InstanceDesc& rod = scene.instances[3];
    EXPECT_EQ(rod.to_world[3][1], 5.0f);
    EXPECT_EQ(scene.nodes.at(rod.node).name, "Empty");
    EXPECT_EQ(primitive_of(scene, 3).shape->half_size, Vec3f(0.25f, 1.5f, 0.25f));
}

// Both what takes the place of a mesh and what stands at a node without one.
TEST(Shapes, MoveWithTheNodesThatPlaceThem) {
    GltfBuilder builder;
    builder.add_triangle()["material"] = 0;
    builder.json["materials"] = {{{"name", "paper"}}};
    builder.json["nodes"][0]["name"] = "Ball";
    builder.json["nodes"].push_back({{"name", "Empty"}, {"translation", {0, 5, 0}}});
    builder.json["nodes"][0]["children"] = {1};
    const int times = builder.floats({0, 1}, 1);
    const int places = builder.floats({0, 0, 0, 4, 0, 0}, 3);
    builder.json["animations"] = {
        {{"samplers", {{{"input", times}, {"output", places}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    const TempDir dir;
    builder.write(dir);
    dir.write("render.json",
              R"({"shapes": {"Ball": {"type": "sphere"}, "Empty": {"type": "disk", "material": "paper"}}})");
    LoadOptions options;
    options.adjust = [](RenderSettings& settings) {
        settings.time_code = 0.5;
        settings.shutter = {0.0, 0.25};
    };
    const LoadedScene loaded = inspect_scene(dir.path(), options);
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    ASSERT_EQ(loaded.scene.instances.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(primitive_of(loaded.scene, i).shape->kind, i == 0 ? ShapeKind::Sphere : ShapeKind::Disk);
        const TransformMotion& motion = loaded.scene.instances[i].motion;
        ASSERT_EQ(motion.size(), 2u) << i;
        const float y = i == 0 ? 0.0f : 5.0f;
        EXPECT_EQ(transform_point(motion[0], Vec3f(0.0f)), Vec3f(2.0f, y, 0.0f)) << i;
        EXPECT_EQ(transform_point(motion[1], Vec3f(0.0f)), Vec3f(3.0f, y, 0.0f)) << i;
    }
}

TEST(Shapes, AreRefusedWithAReason) {
    const struct {
        const char* shapes;
        const char* reason;
    } cases[] = {
        {R"({"Bal": {"type": "sphere"}})", "nothing says where the shape is"},
        {R"({"a": {"type": "sphere", "node": "Bal"}})", "/shapes/a/node: the scene has no node 'Bal'"},
        {R"({"Empty": {"type": "sphere"}})", "must have a \"material\""},
        {R"({"Ball": {"type": "sphere", "material": "papr"}})",
         "/shapes/Ball/material: the scene has no material 'papr'"},
        {R"({"Ball": {"type": "sphere", "width": 1}})", "/shapes/Ball/width: a sphere has no width"},
        {R"({"Ball": {"type": "disk", "height": 1}})", "a disk has no height"},
        {R"({"Ball": {"type": "rectangle", "radius": 1}})", "a rectangle has no radius"},
        {R"({"Ball": {"radius": 1}})", "'type' is missing"},
        {R"({"Ball": {"type": "sphere", "rotation": [0, 0, 0, 1]}})", "needs a position"},
    };
    for (const auto& [shapes, reason] : cases)
        EXPECT_NE(errors_of(shapes).find(reason), std::string::npos) << shapes << ": " << errors_of(shapes);
}

TEST(Shapes, AreValidated) {
    LoadedScene loaded = load_shapes(R"({"Ball": {"type": "sphere"}})");
    PrimitiveDesc& ball =
        loaded.scene.meshes.at(static_cast<std::size_t>(loaded.scene.instances[0].mesh.index)).primitives[0];
    EXPECT_FALSE(validate(loaded.scene).has_errors());
    ball.shape->half_size.x = 0.0f;
    EXPECT_TRUE(validate(loaded.scene).has_errors());
    ball.shape->half_size.x = 0.5f;
    ball.triangles.push_back({0, 1, 2});
    EXPECT_TRUE(validate(loaded.scene).has_errors());
}

// Nobody is to look for a node in place of a position that is no position.
TEST(Shapes, HaveOneErrorForAWrongPosition) {
    for (const std::string position :
         {R"("here")", "[1, 2]", R"([1, 2, 3], "look_at": 5)", R"("here", "look_at": [0, 0, 0])"}) {
        const std::string errors =
            errors_of(R"({"a": {"type": "disk", "material": "glass", "position": )" + position + "}}");
        EXPECT_EQ(std::ranges::count(errors, '\n'), 1) << errors;
        EXPECT_EQ(errors.find("where the shape is"), std::string::npos) << errors;
    }
}

}  // namespace
}  // namespace etendue
