// What moves while the shutter is open.
#include "loader/gltf/gltf_builder.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A triangle at rest and one in node 0 that goes from x = 0 at 0 s to x = 4 at 1 s, with a camera and a lamp.
GltfBuilder sliding() {
    GltfBuilder builder;
    builder.add_triangle();
    auto& json = builder.json;
    json["nodes"].push_back({{"mesh", 0}});
    json["nodes"][0]["children"] = {2};
    json["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    json["extensionsUsed"] = {"KHR_lights_punctual"};
    json["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}}};
    json["scenes"][0]["nodes"] = {0, 1};
    json["animations"] = {
        {{"samplers", {{{"input", builder.floats({0, 1}, 1)}, {"output", builder.floats({0, 0, 0, 4, 0, 0}, 3)}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    return builder;
}

LoadOptions shutter(double time, double open, double close) {
    LoadOptions options;
    options.adjust = [=](RenderSettings& settings) {
        settings.time_code = time;
        settings.shutter = {open, close};
    };
    return options;
}

Vec3f origin_after(const Mat4f& m) {
    return transform_point(m, Vec3f(0.0f));
}

TEST(GltfMotion, WhatRenderJsonPutsOnNodesMovesWithThem) {
    const TempDir dir;
    GltfBuilder builder = sliding();
    builder.json["nodes"][0]["name"] = "Mover";
    builder.json["nodes"].push_back({{"name", "Hook"}, {"translation", {0, 1, 0}}});
    builder.json["nodes"][0]["children"].push_back(builder.json["nodes"].size() - 1);
    dir.write("render.json", R"({"lights": {
        "Ball": {"type": "sphere", "node": "Mover", "radius": 0.1, "power": 1},
        "Bulb": {"type": "point", "node": "Mover", "power": 1},
        "Glow": {"type": "spot", "node": "Mover", "radius": 0.1, "power": 1},
        "Day": {"type": "sun", "node": "Mover", "irradiance": 1},
        "Still": {"type": "sphere", "position": [0, 9, 0], "power": 1}},
        "shapes": {"Pearl": {"type": "sphere", "node": "Hook", "radius": 0.2, "material": "white"}}})");
    builder.json["materials"] = {{{"name", "white"}}};
    builder.write(dir);
    const LoadedScene loaded = inspect_scene(dir.path(), shutter(0.5, 0.0, 0.25));
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const auto instance = [&](std::string_view mesh) -> const InstanceDesc& {
        return *std::ranges::find_if(loaded.scene.instances, [&](const InstanceDesc& placed) {
            return loaded.scene.meshes.at(static_cast<std::size_t>(placed.mesh.index)).name == mesh;
        });
    };
    for (const std::string_view name : {"Ball", "Glow", "Pearl"}) {
        const TransformMotion& motion = instance(name).motion;
        ASSERT_EQ(motion.size(), 2u) << name;
        EXPECT_EQ(origin_after(motion[0]).x, 2.0f) << name;
        EXPECT_EQ(origin_after(motion[1]).x, 3.0f) << name;
    }
    EXPECT_TRUE(instance("Still").motion.empty());
    for (const LightDesc& light : loaded.scene.lights) EXPECT_EQ(light.motion.size(), 2u) << light.name;
}

TEST(GltfMotion, StraightMotionHasTwoSteps) {
    const LoadedScene loaded = sliding().load(shutter(0.5, 0.0, 0.25));
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const InstanceDesc& moving = loaded.scene.instances.at(0);
    ASSERT_EQ(moving.motion.size(), 2u);
    EXPECT_EQ(origin_after(moving.motion[0]), Vec3f(2, 0, 0));
    EXPECT_EQ(origin_after(moving.motion[1]), Vec3f(3, 0, 0));
    EXPECT_EQ(origin_after(moving.to_world), Vec3f(2.5f, 0, 0)) << "in the middle";
    EXPECT_TRUE(loaded.scene.instances.at(1).motion.empty());
    ASSERT_EQ(loaded.scene.cameras.at(0).motion.size(), 2u) << "it hangs on the node";
    EXPECT_EQ(origin_after(loaded.scene.cameras[0].motion[1]), Vec3f(3, 0, 0));
    EXPECT_EQ(origin_after(loaded.scene.lights.at(0).to_world), Vec3f(2.5f, 0, 0));
    ASSERT_EQ(loaded.scene.lights[0].motion.size(), 2u);
    EXPECT_EQ(origin_after(loaded.scene.lights[0].motion[1]), Vec3f(3, 0, 0));
}

// It grows from nothing at 0 s to its full size at 1 s.
TEST(GltfMotion, WhatGrowsFromNothingIsThereWhileTheShutterIsOpen) {
    GltfBuilder builder = sliding();
    builder.json["animations"][0]["samplers"][0]["output"] = builder.floats({0, 0, 0, 1, 1, 1}, 3);
    builder.json["animations"][0]["channels"][0]["target"]["path"] = "scale";
    builder.json["nodes"].erase(2);
    builder.json["nodes"][0].erase("children");
    const LoadedScene loaded = builder.load(shutter(0.25, -0.25, 0.25));
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    ASSERT_EQ(loaded.scene.instances.size(), 2u) << listing(loaded.problems);
    const InstanceDesc& growing = loaded.scene.instances[0];
    EXPECT_EQ(growing.to_world[0][0], 0.25f) << "in the middle";
    EXPECT_EQ(growing.motion.back()[0][0], 0.5f);
    EXPECT_GT(growing.motion.front()[0][0], 0.0f);
    EXPECT_LT(growing.motion.front()[0][0], 0.01f);
    EXPECT_EQ(builder.load(shutter(-1.0, -0.25, 0.25)).scene.instances.size(), 1u) << "before it grows";
}

TEST(GltfMotion, AKeyInTheShutterTakesMoreSteps) {
    // At rest up to 0 s: the path bends in the middle.
    const LoadedScene loaded = sliding().load(shutter(0.0, -0.5, 0.5));
    const TransformMotion& motion = loaded.scene.instances.at(0).motion;
    ASSERT_EQ(motion.size(), 3u);
    EXPECT_EQ(origin_after(motion[0]), Vec3f(0.0f));
    EXPECT_EQ(origin_after(motion[1]), Vec3f(0.0f));
    EXPECT_EQ(origin_after(motion[2]), Vec3f(2, 0, 0));
}

TEST(GltfMotion, AClosedShutterShowsAMoment) {
    for (const LoadOptions& options : {shutter(0.5, 0.0, 0.0), shutter(0.25, 0.25, 0.25)}) {
        const LoadedScene loaded = sliding().load(options);
        EXPECT_TRUE(loaded.scene.instances.at(0).motion.empty());
        EXPECT_TRUE(loaded.scene.cameras.at(0).motion.empty());
        EXPECT_EQ(origin_after(loaded.scene.instances.at(0).to_world), Vec3f(2, 0, 0));
    }
    EXPECT_TRUE(has_problem(sliding().load(shutter(0.0, 0.5, 0.25)).problems, Severity::Error, "open <= close"));
}

/// A wheel that turns once in a second, with keys at every quarter: its rim must stay round.
TEST(GltfMotion, WheelsStayRound) {
    GltfBuilder builder;
    builder.add_triangle();
    const float s = std::sqrt(0.5f);
    builder.json["animations"] = {
        {{"samplers",
          {{{"input", builder.floats({0, 0.25f, 0.5f, 0.75f, 1}, 1)},
            {"output", builder.floats({0, 0, 0, 1, 0, 0, s, s, 0, 0, 1, 0, 0, 0, s, -s, 0, 0, 0, -1}, 4)}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}}};
    const LoadedScene loaded = builder.load(shutter(0.0, 0.0, 1.0));
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const TransformMotion& motion = loaded.scene.instances.at(0).motion;
    EXPECT_GT(motion.size(), 16u);
    EXPECT_LE(motion.size(), kMaxMotionSteps);
    for (std::size_t i = 0; i + 1 < motion.size(); ++i) {
        const Mat4f middle = (motion[i] + motion[i + 1]) * 0.5f;
        const Vec3f rim = transform_point(middle, {1, 0, 0});
        EXPECT_NEAR(length(rim), 1.0f, 3e-3f) << "of a sweep about 3 m wide";
        const float angle = 2.0f * kPi * (static_cast<float>(i) + 0.5f) / static_cast<float>(motion.size() - 1);
        EXPECT_LT(length(rim - Vec3f(std::cos(angle), std::sin(angle), 0)), 3e-3f);
    }
    EXPECT_LT(builder.load(shutter(0.0, 0.0, 0.02)).scene.instances.at(0).motion.size(), 6u) << "as many as it takes";
}

// A small triangle goes 1 m while it turns by 8 degrees. Two steps would suffice for its long way, but would shrink the
// triangle by more than a lamp that is sampled may shrink.
TEST(GltfMotion, WhatTurnsSlowlyOnALongWayStaysRigid) {
    GltfBuilder builder;
    builder.add_triangle();
    for (const float far : {0.0f, 1e-3f, 2e-3f}) builder.json["nodes"][0]["scale"].push_back(0.01f + far);
    const float angle = 8.0f * kPi / 180.0f;
    builder.json["animations"] = {
        {{"samplers",
          {{{"input", builder.floats({0, 1}, 1)},
            {"output", builder.floats({0, 0, 0, 1, 0, 0, std::sin(angle / 2), std::cos(angle / 2)}, 4)}},
           {{"input", builder.floats({0, 1}, 1)}, {"output", builder.floats({0, 0, 0, 1, 0, 0}, 3)}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}},
           {{"sampler", 1}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    const LoadedScene loaded = builder.load(shutter(0.0, 0.0, 1.0));
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const TransformMotion& motion = loaded.scene.instances.at(0).motion;
    ASSERT_GT(motion.size(), 2u);
    for (std::size_t i = 0; i + 1 < motion.size(); ++i) {
        const Mat4f middle = (motion[i] + motion[i + 1]) * 0.5f;
        EXPECT_NEAR(length(transform_vector(middle, {1, 0, 0})), 0.01f, 0.01f * 1.2e-3f);
    }
}

const PrimitiveDesc& first_instanced_primitive(const LoadedScene& loaded) {
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const Handle<MeshDesc> mesh = loaded.scene.instances.at(0).mesh;
    return loaded.scene.meshes.at(static_cast<std::size_t>(mesh.index)).primitives.at(0);
}

TEST(GltfMotion, MorphTargetsMoveVertices) {
    GltfBuilder builder;
    builder.add_triangle()["targets"] = {{{"POSITION", builder.floats({0, 0, 0, 0, 0, 0, 0, 0, 2}, 3)}}};
    builder.json["animations"] = {
        {{"samplers", {{{"input", builder.floats({0, 1}, 1)}, {"output", builder.floats({0, 1}, 1)}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
    const LoadedScene loaded = builder.load(shutter(0.0, 0.0, 1.0));
    const PrimitiveDesc& p = first_instanced_primitive(loaded);
    ASSERT_EQ(p.motion.size(), 2u);
    EXPECT_EQ(p.motion[0].positions[2], Vec3f(0, 1, 0));
    EXPECT_EQ(p.positions[2], Vec3f(0, 1, 1));
    EXPECT_EQ(p.motion[1].positions[2], Vec3f(0, 1, 2));
    EXPECT_TRUE(p.motion[1].normals.empty()) << "the file has none: triangles are flat at every step";
    EXPECT_TRUE(loaded.scene.instances.at(0).motion.empty());
    EXPECT_TRUE(first_instanced_primitive(builder.load(shutter(3.0, 0.0, 1.0))).motion.empty()) << "after the last key";
}

/// A few lines of JSON can stand for any number of zeros: poses of all of them must not be kept for every step.
TEST(GltfMotion, PosesAreBounded) {
    GltfBuilder builder;
    builder.add_triangle()["targets"] = {{{"POSITION", builder.floats({0, 0, 0, 0, 0, 0, 0, 0, 2}, 3)}}};
    const auto zeros = builder.json["accessors"].size();
    builder.json["accessors"].push_back({{"componentType", 5126}, {"count", 10'000'000}, {"type", "SCALAR"}});
    builder.json["animations"] = {{{"samplers", {{{"input", builder.floats({0}, 1)}, {"output", zeros}}}},
                                   {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
    EXPECT_TRUE(builder.load(shutter(0.0, 0.0, 1.0)).problems.has_errors());
}

TEST(GltfMotion, SkinsMoveVerticesWithTheirJoints) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    const std::vector<std::uint8_t> joints{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
    primitive["attributes"]["JOINTS_0"] = builder.accessor(joints, "VEC4", 5121, 3);
    primitive["attributes"]["WEIGHTS_0"] = builder.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4);
    auto& json = builder.json;
    json["nodes"][0]["skin"] = 0;
    json["nodes"].push_back({{"children", {2}}});
    json["nodes"].push_back(nlohmann::json::object());
    json["scenes"][0]["nodes"] = {0, 1};
    json["skins"] = {{{"joints", {1, 2}}}};
    json["animations"] = {
        {{"samplers", {{{"input", builder.floats({0, 1}, 1)}, {"output", builder.floats({0, 0, 0, 0, 8, 0}, 3)}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}}}};
    const LoadedScene loaded = builder.load(shutter(0.0, 0.25, 0.75));
    const PrimitiveDesc& p = first_instanced_primitive(loaded);
    ASSERT_EQ(p.motion.size(), 2u);
    EXPECT_EQ(p.motion[0].positions[1], Vec3f(1, 0, 0));
    EXPECT_EQ(p.motion[0].positions[2], Vec3f(0, 3, 0));
    EXPECT_EQ(p.motion[1].positions[2], Vec3f(0, 7, 0));
    EXPECT_EQ(p.positions[2], Vec3f(0, 5, 0));
}

}  // namespace
}  // namespace etendue
