#include "loader/gltf/gltf_builder.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A triangle whose node, moved by (0, 0, 10), places it with these attributes.
GltfBuilder instanced(const std::function<nlohmann::json(GltfBuilder&)>& attributes) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["nodes"][0]["translation"] = {0, 0, 10};
    builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", attributes(builder)}};
    builder.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    return builder;
}

TEST(GpuInstancing, PlacesTheMeshByScaleRotationAndTranslation) {
    const float s = std::sqrt(0.5f);
    const LoadedScene loaded = instanced([s](GltfBuilder& b) {
                                   return nlohmann::json{{"TRANSLATION", b.floats({5, 0, 0, 0, 7, 0}, 3)},
                                                         {"ROTATION", b.floats({0, 0, s, s, 0, 0, 0, 1}, 4)},
                                                         {"SCALE", b.floats({2, 2, 2, 1, 1, 1}, 3)}};
                               }).load();
    ASSERT_EQ(loaded.scene.instances.size(), 2u) << listing(loaded.problems);
    EXPECT_LT(length(transform_point(loaded.scene.instances[0].to_world, {1, 0, 0}) - Vec3f(5, 2, 10)), 1e-5f);
    EXPECT_LT(length(transform_point(loaded.scene.instances[1].to_world, {1, 0, 0}) - Vec3f(1, 7, 10)), 1e-5f);
}

TEST(GpuInstancing, AttributesOfOtherProgramsCountInstances) {
    const LoadedScene loaded = instanced([](GltfBuilder& b) {
                                   return nlohmann::json{{"_ID", b.floats({1, 2, 3}, 1)}};
                               }).load();
    ASSERT_EQ(loaded.scene.instances.size(), 3u) << listing(loaded.problems);
    EXPECT_EQ(transform_point(loaded.scene.instances[2].to_world, Vec3f(0.0f)), Vec3f(0, 0, 10));
}

TEST(GpuInstancing, RotationsMayBeNormalisedIntegers) {
    const LoadedScene loaded = instanced([](GltfBuilder& b) {
                                   const std::vector<std::int16_t> half_turn{0, 0, 32767, 0};
                                   return nlohmann::json{{"ROTATION", b.accessor(half_turn, "VEC4", 5122, 1, true)}};
                               }).load();
    ASSERT_EQ(loaded.scene.instances.size(), 1u) << listing(loaded.problems);
    EXPECT_LT(length(transform_point(loaded.scene.instances[0].to_world, {1, 0, 0}) - Vec3f(-1, 0, 10)), 1e-4f);
}

TEST(GpuInstancing, AttributesOfDifferentLengthAreAnError) {
    const LoadedScene loaded =
        instanced([](GltfBuilder& b) {
            return nlohmann::json{{"TRANSLATION", b.floats({5, 0, 0, 0, 7, 0}, 3)}, {"SCALE", b.floats({1, 1, 1}, 3)}};
        }).load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "1 values for 2 instances", "/attributes/SCALE"));
}

TEST(GpuInstancing, WrongTypesAreAnError) {
    const LoadedScene loaded = instanced([](GltfBuilder& b) {
                                   return nlohmann::json{{"TRANSLATION", b.floats({5, 0}, 2)}};
                               }).load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "2 components", "/attributes/TRANSLATION"));
}

TEST(GpuInstancing, InstancesOutOfNothingAreAnError) {
    // An accessor without bytes, which costs a file nothing.
    const LoadedScene loaded =
        instanced([](GltfBuilder& b) {
            b.json["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 2'000'000}});
            return nlohmann::json{{"TRANSLATION", b.json["accessors"].size() - 1}};
        }).load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "would take too much memory"));
}

// An accessor without bytes costs a file nothing, and a mesh for each place would.
TEST(GpuInstancing, FlatPlacesShareTheirMesh) {
    GltfBuilder builder = instanced([](GltfBuilder& b) {
        b.json["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 1000}});
        return nlohmann::json{{"TRANSLATION", b.json["accessors"].size() - 1}};
    });
    builder.json["nodes"][0]["scale"] = {1, 1, 0};
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(loaded.scene.instances.size(), 1000u);
    EXPECT_EQ(loaded.scene.meshes.size(), 2u);
}

TEST(GpuInstancing, ManyPlacesOfManyPrimitivesAreAnError) {
    // Each primitive has a place of its own in the world wherever its mesh is placed.
    GltfBuilder builder;
    const nlohmann::json primitive = builder.add_triangle();
    builder.json["meshes"][0]["primitives"] = nlohmann::json::array();
    for (int i = 0; i < 7000; ++i) builder.json["meshes"][0]["primitives"].push_back(primitive);
    builder.json["nodes"] = nlohmann::json::array();
    builder.json["scenes"][0]["nodes"] = nlohmann::json::array();
    for (int i = 0; i < 7000; ++i) {
        builder.json["nodes"].push_back({{"mesh", 0}});
        builder.json["scenes"][0]["nodes"].push_back(i);
    }
    const ProblemList problems = builder.load().problems;
    EXPECT_EQ(problems.error_count(), 1u);
    EXPECT_TRUE(has_problem(problems, Severity::Error, "would take too much memory")) << listing(problems);
}

}  // namespace
}  // namespace etendue
