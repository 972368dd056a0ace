#include "loader/gltf/gltf_builder.h"

#include <cmath>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A triangle whose nodes and scenes the test writes itself.
GltfBuilder with_nodes(nlohmann::json nodes, nlohmann::json roots = {0}) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["nodes"] = std::move(nodes);
    builder.json["scenes"] = {{{"nodes", std::move(roots)}}};
    return builder;
}

Vec3f origin(const Mat4f& m) {
    return {m[3][0], m[3][1], m[3][2]};
}

void expect_near(const Vec3f& a, const Vec3f& b) {
    EXPECT_LT(length(a - b), 1e-5f) << a << b;
}

TEST(Nodes, TrsIsScaleThenRotationThenTranslation) {
    const float s = std::sqrt(0.5f);
    const LoadedScene loaded =
        with_nodes({{{"mesh", 0}, {"scale", {2, 3, 4}}, {"rotation", {0, 0, s, s}}, {"translation", {10, 0, 0}}}})
            .load();
    ASSERT_EQ(loaded.scene.instances.size(), 1u) << listing(loaded.problems);
    const Mat4f& m = loaded.scene.instances[0].to_world;
    expect_near(transform_point(m, {1, 0, 0}), {10, 2, 0});  // x goes to y
    expect_near(transform_point(m, {0, 1, 0}), {7, 0, 0});
}

TEST(Nodes, MatrixIsColumnMajor) {
    const LoadedScene loaded =
        with_nodes({{{"mesh", 0}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}}).load();
    const Mat4f& m = loaded.scene.instances.at(0).to_world;
    expect_near(transform_point(m, {1, 0, 0}), {5, 7, 7});
}

TEST(Nodes, ChildrenAreRelativeToTheirParent) {
    const LoadedScene loaded = with_nodes({{{"children", {1}}, {"translation", {1, 0, 0}}, {"scale", {2, 2, 2}}},
                                           {{"children", {2}}, {"translation", {0, 1, 0}}},
                                           {{"mesh", 0}, {"translation", {0, 0, 1}}}})
                                   .load();
    expect_near(origin(loaded.scene.instances.at(0).to_world), {1, 2, 2});
}

// For names of mattes: the hierarchy as the file has it, parents first, without what the scene does not show.
TEST(Nodes, AreKeptWithTheirParents) {
    const LoadedScene loaded = with_nodes({{{"mesh", 0}, {"name", "leaf"}},
                                           {{"name", "unused"}},
                                           {{"name", "top"}, {"children", {3}}},
                                           {{"name", "middle"}, {"children", {0, 4}}},
                                           {{"mesh", 0}}},
                                          {2})
                                   .load();
    const std::vector<NodeDesc>& nodes = loaded.scene.nodes;
    ASSERT_EQ(nodes.size(), 4u);
    EXPECT_EQ(nodes[0].name, "top");
    EXPECT_EQ(nodes[0].parent, NodeDesc::kNone);
    EXPECT_EQ(nodes[0].number, 2u);
    EXPECT_EQ(nodes[1].name, "middle");
    EXPECT_EQ(nodes[1].parent, 0u);
    ASSERT_EQ(loaded.scene.instances.size(), 2u);
    EXPECT_EQ(nodes.at(loaded.scene.instances[0].node).name, "leaf");
    EXPECT_EQ(nodes.at(loaded.scene.instances[0].node).parent, 1u);
    EXPECT_EQ(nodes.at(loaded.scene.instances[1].node).number, 4u);
    EXPECT_NE(dump(loaded.scene).find("node 2 \"leaf\" below node 1 \"middle\""), std::string::npos);
}

TEST(Nodes, ThatAreFarAwayAreRelativeToAnOriginNearThem) {
    GltfBuilder builder = with_nodes({{{"children", {1, 2}}, {"translation", {5000000, 0, -400000.3}}},
                                      {{"mesh", 0}, {"translation", {0.125, 0.25, 0}}},
                                      {{"camera", 0}, {"translation", {0, 0, 4.1}}}});
    auto& json = builder.json;
    json["nodes"][2]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    json["extensionsUsed"] = {"KHR_lights_punctual"};
    json["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}}};
    const LoadedScene loaded = builder.load();
    const SceneDesc& scene = loaded.scene;
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    EXPECT_EQ(scene.origin, Vec3d(5e6, 0, -4e5));
    ASSERT_EQ(scene.instances.size(), 1u) << "what was placed first is gone";
    ASSERT_EQ(scene.cameras.size(), 1u);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.nodes.size(), 3u);
    EXPECT_LT(length(origin(scene.instances[0].to_world) - Vec3f(0.125f, 0.25f, -0.3f)), 1e-7f);
    EXPECT_LT(length(origin(scene.cameras[0].to_world) - Vec3f(0, 0, 3.8f)), 1e-6f);
    EXPECT_LT(length(origin(scene.lights[0].to_world) - Vec3f(0, 0, 3.8f)), 1e-6f);
    EXPECT_EQ(scene.cameras[0].name, "camera") << "and free again";
}

TEST(Nodes, ThatCancelEachOtherAreNotFarAway) {
    const LoadedScene loaded = with_nodes({{{"children", {1}}, {"translation", {1e8, 0, 0}}},
                                           {{"mesh", 0}, {"translation", {-99999999.75, 0, 0}}}})
                                   .load();
    EXPECT_EQ(loaded.scene.origin, Vec3d(0.0));
    EXPECT_EQ(origin(loaded.scene.instances.at(0).to_world), Vec3f(0.25f, 0, 0));
}

TEST(Nodes, OfASkinMayBeFarAway) {
    GltfBuilder builder = with_nodes({{{"mesh", 0}, {"skin", 0}}, {{"translation", {5000000, 0.25, 0}}}}, {0, 1});
    auto& json = builder.json;
    auto& attributes = json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = builder.accessor(std::vector<std::uint8_t>(12, 0), "VEC4", 5121, 3);
    attributes["WEIGHTS_0"] = builder.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4);
    json["skins"] = {{{"joints", {1}}}};
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(loaded.scene.origin, Vec3d(5e6, 0, 0));
    const SceneDesc& scene = loaded.scene;
    ASSERT_EQ(scene.instances.size(), 1u) << listing(loaded.problems);
    ASSERT_EQ(scene.meshes.size(), 2u) << "deformed once in the end";
    EXPECT_EQ(scene.instances[0].to_world, Mat4f());
    EXPECT_EQ(scene.meshes[1].primitives.at(0).positions.at(1), Vec3f(1, 0.25f, 0));
}

TEST(Nodes, RotationsAreNormalised) {
    const LoadedScene loaded = with_nodes({{{"mesh", 0}, {"rotation", {0, 0, 0, 5}}}}).load();
    EXPECT_EQ(loaded.scene.instances.at(0).to_world, Mat4f());
    const LoadedScene zero = with_nodes({{{"mesh", 0}, {"rotation", {0, 0, 0, 0}}}}).load();
    EXPECT_EQ(zero.scene.instances.at(0).to_world, Mat4f());
    EXPECT_TRUE(has_problem(zero.problems, Severity::Warning, "zero quaternion", "/nodes/0"));
}

TEST(Nodes, SharedMeshesAreInstances) {
    const LoadedScene loaded = with_nodes({{{"mesh", 0}}, {{"mesh", 0}, {"translation", {1, 0, 0}}}}, {0, 1}).load();
    EXPECT_EQ(loaded.scene.meshes.size(), 1u);
    EXPECT_EQ(loaded.scene.instances.size(), 2u);
}

TEST(Nodes, NegativeScaleIsKept) {
    const LoadedScene loaded = with_nodes({{{"mesh", 0}, {"scale", {-1, 1, 1}}}}).load();
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    EXPECT_LT(loaded.scene.instances.at(0).to_world.determinant(), 0.0f);
}

TEST(Nodes, SingularTransformsAreLeftOut) {
    const LoadedScene loaded = with_nodes({{{"mesh", 0}, {"scale", {1, 0, 1}}}, {{"mesh", 0}}}, {0, 1}).load();
    EXPECT_EQ(loaded.scene.instances.size(), 1u);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "singular", "/nodes/0"));
    EXPECT_FALSE(loaded.problems.has_errors());
}

// glTF lets implementations leave out what is scaled to nothing along all axes, not along one.
TEST(Nodes, WhatIsScaledFlatIsShownFlat) {
    const LoadedScene loaded =
        with_nodes({{{"mesh", 0}, {"scale", {2, 3, 0}}, {"translation", {0, 0, 5}}}, {{"mesh", 0}}}, {0, 1}).load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "is shown flat", "/nodes/0"));
    ASSERT_EQ(loaded.scene.instances.size(), 2u);
    const InstanceDesc& flat = loaded.scene.instances[0];
    EXPECT_EQ(flat.to_world, Mat4f(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1));
    const PrimitiveDesc& primitive = loaded.scene.meshes.at(static_cast<std::size_t>(flat.mesh.index)).primitives.at(0);
    EXPECT_EQ(primitive.positions, (std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}));
    EXPECT_TRUE(primitive.normals.empty());
    EXPECT_TRUE(validate(loaded.scene).all().empty()) << listing(validate(loaded.scene));
    EXPECT_EQ(loaded.scene.instances[1].mesh.index, 0) << "the other one has its thickness";
}

TEST(Nodes, FlatMeshesAreSharedWhereOnlyTheirPlaceDiffers) {
    const nlohmann::json flat = {{"mesh", 0}, {"scale", {1, 1, 0}}};
    nlohmann::json elsewhere = flat;
    elsewhere["translation"] = {7, 0, 0};
    nlohmann::json larger = flat;
    larger["scale"] = {2, 1, 0};
    const LoadedScene loaded = with_nodes({flat, elsewhere, larger}, {0, 1, 2}).load();
    const std::vector<InstanceDesc>& instances = loaded.scene.instances;
    ASSERT_EQ(instances.size(), 3u) << listing(loaded.problems);
    EXPECT_EQ(instances[1].mesh, instances[0].mesh);
    EXPECT_NE(instances[2].mesh, instances[0].mesh);
    EXPECT_EQ(origin(instances[1].to_world), Vec3f(7, 0, 0));
    EXPECT_EQ(loaded.scene.meshes.size(), 3u);
}

TEST(Nodes, TransformsThatOverflowAreLeftOut) {
    const LoadedScene loaded =
        with_nodes({{{"children", {1}}, {"scale", {1e30, 1e30, 1e30}}}, {{"mesh", 0}, {"scale", {1e30, 1e30, 1e30}}}})
            .load();
    EXPECT_TRUE(loaded.scene.instances.empty());
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "singular", "/nodes/1"));
    const LoadedScene flat =
        with_nodes({{{"children", {1}}, {"scale", {1e30, 1e30, 0}}}, {{"mesh", 0}, {"translation", {1e30, 0, 0}}}})
            .load();
    EXPECT_TRUE(flat.scene.instances.empty()) << "flat, but nowhere";
    EXPECT_TRUE(validate(flat.scene).all().empty()) << listing(validate(flat.scene));
}

TEST(Nodes, ProjectiveMatricesAreErrors) {
    const LoadedScene loaded =
        with_nodes({{{"mesh", 0}, {"matrix", {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}}).load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "not affine", "/nodes/0"));
}

TEST(Nodes, CyclesAreErrors) {
    const auto expect_cycle = [](nlohmann::json nodes, nlohmann::json roots) {
        const LoadedScene loaded = with_nodes(std::move(nodes), std::move(roots)).load();
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "its own ancestor")) << listing(loaded.problems);
    };
    expect_cycle({{{"children", {0}}}}, {0});
    expect_cycle({{{"children", {1}}}, {{"children", {0}}}}, {0});
    expect_cycle({{{"mesh", 0}}, {{"children", {2}}}, {{"children", {3}}}, {{"children", {1}}}}, {0});
}

TEST(Nodes, TwoParentsAreAnError) {
    const LoadedScene loaded = with_nodes({{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}}, {0, 1}).load();
    EXPECT_TRUE(
        has_problem(loaded.problems, Severity::Error, "node 2 already is a child of node 0", "/nodes/1/children/0"));
}

TEST(Nodes, ChildrenListedTwiceAreAnError) {
    EXPECT_TRUE(has_problem(with_nodes({{{"children", {1, 1}}}, {{"mesh", 0}}}).load().problems, Severity::Error,
                            "already is a child"));
}

// What Unity's exporter writes into every file, among others.
TEST(Nodes, ScenesMayListChildrenOrANodeTwice) {
    const auto shows_one = [](GltfBuilder builder, const char* warning) {
        const LoadedScene loaded = builder.load();
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, warning, "/scenes/0/nodes"));
        EXPECT_FALSE(loaded.problems.has_errors());
        ASSERT_EQ(loaded.scene.instances.size(), 1u) << warning;
        EXPECT_EQ(loaded.scene.instances[0].to_world[3][0], 3.0f) << warning;
    };
    const nlohmann::json placed = {{"mesh", 0}, {"translation", {3, 0, 0}}};
    shows_one(with_nodes({placed}, {0, 0}), "are listed again");
    shows_one(with_nodes({{{"children", {1}}}, placed}, {0, 1}), "are children of others of them");
    shows_one(with_nodes({{{"children", {1}}, {"translation", {9, 0, 0}}}, placed}, {1}), "that it does not show");
}
TEST(Nodes, DeepHierarchiesNeedNoStack) {
    constexpr int kDepth = 100'000;
    nlohmann::json nodes = nlohmann::json::array();
    for (int i = 0; i + 1 < kDepth; ++i) nodes.push_back({{"children", {i + 1}}});
    nodes.push_back({{"mesh", 0}});
    const LoadedScene loaded = with_nodes(std::move(nodes)).load();
    EXPECT_EQ(loaded.scene.instances.size(), 1u) << listing(loaded.problems);
}

TEST(Nodes, SceneSelection) {
    GltfBuilder builder = with_nodes({{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}});
    builder.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    EXPECT_EQ(builder.load().scene.instances.at(0).name, "a");
    builder.json["scene"] = 1;
    EXPECT_EQ(builder.load().scene.instances.at(0).name, "b");

    builder.json.erase("scene");
    builder.json.erase("scenes");
    const LoadedScene all = builder.load();
    EXPECT_EQ(all.scene.instances.size(), 2u);
    EXPECT_TRUE(has_problem(all.problems, Severity::Warning, "no scene"));
}

TEST(Cameras, TakeTheirNodesTransformWithoutScale) {
    GltfBuilder builder =
        with_nodes({{{"mesh", 0}},
                    {{"camera", 0}, {"scale", {3, 3, 3}}, {"translation", {0, 0, 5}}, {"name", "node"}},
                    {{"camera", 1}},
                    {{"camera", 1}}},
                   {0, 1, 2, 3});
    builder.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", 1.5}}}},
        {{"type", "orthographic"},
         {"name", "flat"},
         {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}}};
    const LoadedScene loaded = builder.load();
    ASSERT_EQ(loaded.scene.cameras.size(), 3u) << listing(loaded.problems);
    EXPECT_FALSE(has_problem(loaded.problems, Severity::Note, "mirrors its camera"));
    builder.json["nodes"][1]["scale"] = {-3, 3, 3};
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Note, "mirrors its camera", "/nodes/1"));
    const CameraDesc& perspective = loaded.scene.cameras[0];
    EXPECT_EQ(perspective.name, "node");
    EXPECT_FLOAT_EQ(perspective.yfov, 0.5f);
    EXPECT_FLOAT_EQ(perspective.aspect_ratio, 1.5f);
    EXPECT_EQ(perspective.file_clip.start, 0.1f);
    EXPECT_TRUE(std::isinf(perspective.file_clip.end));
    EXPECT_EQ(perspective.clip.start, 0.0f) << "nobody has asked for it";
    EXPECT_NEAR(perspective.to_world.determinant(), 1.0f, 1e-5f);
    expect_near(origin(perspective.to_world), {0, 0, 5});
    const CameraDesc& flat = loaded.scene.cameras[1];
    EXPECT_EQ(flat.type, CameraType::Orthographic);
    EXPECT_FLOAT_EQ(flat.ymag, 2.0f);
    EXPECT_FLOAT_EQ(flat.aspect_ratio, 2.0f);
    EXPECT_EQ(flat.file_clip.start, 0.0f);
    EXPECT_EQ(flat.file_clip.end, 9.0f);
    EXPECT_EQ(flat.name, "flat");
    EXPECT_EQ(loaded.scene.cameras[2].name, "flat-2");
}

/// Two scenes of a node each.
GltfBuilder with_two_scenes() {
    GltfBuilder builder = with_nodes({{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}}, {0});
    builder.json["scenes"] = {{{"name", "day"}, {"nodes", {0}}}, {{"name", "night"}, {"nodes", {1}}}};
    return builder;
}

TEST(Scenes, AreChosenByNameAndANoteSaysWhichWasTaken) {
    GltfBuilder builder = with_two_scenes();
    const auto shown_of = [&](const std::string& name) {
        const LoadedScene loaded = builder.load({.adjust = [&](RenderSettings& s) { s.scene_name = name; }});
        EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
        return loaded.scene.instances.at(0).name;
    };
    EXPECT_EQ(shown_of("night"), "b");
    EXPECT_EQ(shown_of("day"), "a");
    LoadedScene loaded = builder.load();
    EXPECT_EQ(loaded.scene.instances.at(0).name, "a");
    EXPECT_EQ(loaded.scene.scenes, (std::vector<std::string>{"day", "night"}));
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Note,
                            "'day' is shown; --scene NAME shows another, such as 'night'", "/scenes"))
        << listing(loaded.problems);
    builder.json["scene"] = 1;
    loaded = builder.load();
    EXPECT_EQ(loaded.scene.instances.at(0).name, "b") << "the file's own";
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Note, "'night' is shown")) << listing(loaded.problems);
    loaded = builder.load({.adjust = [](RenderSettings& s) { s.scene_name = "nigth"; }});
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "no scene 'nigth'; did you mean 'night'?", "/scene_name"))
        << listing(loaded.problems);
}

TEST(Scenes, WithoutANameOfTheirOwnGetOne) {
    GltfBuilder builder = with_two_scenes();
    for (nlohmann::json& scene : builder.json["scenes"]) scene.erase("name");
    EXPECT_EQ(builder.load({.adjust = [](RenderSettings& s) { s.scene_name = "scene-2"; }}).scene.instances.at(0).name,
              "b");
}

TEST(Cameras, AreFoundByTheirNodesAndANoteSaysWhichWasTaken) {
    GltfBuilder builder =
        with_nodes({{{"mesh", 0}}, {{"camera", 0}, {"name", "Hero"}}, {{"camera", 0}, {"name", "Side"}}}, {0, 1, 2});
    builder.json["cameras"] = {
        {{"type", "perspective"}, {"name", "Data"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    const auto named = [](const char* name) {
        return LoadOptions{.adjust = [=](RenderSettings& s) { s.camera = name; }};
    };
    const LoadedScene loaded = builder.load(named("Side"));
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    EXPECT_EQ(find_camera(loaded.scene, "Side"), &loaded.scene.cameras.at(1));
    EXPECT_EQ(find_camera(loaded.scene, "Data-2"), &loaded.scene.cameras.at(1));
    EXPECT_EQ(find_camera(loaded.scene, "Data"), &loaded.scene.cameras.at(0));
    EXPECT_EQ(find_camera(loaded.scene, ""), nullptr);
    EXPECT_TRUE(has_problem(builder.load(named("Sid")).problems, Severity::Error, "did you mean 'Side'?"));
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Note,
                            "2 cameras, of which the first, 'Hero', is taken; --camera NAME takes another: 'Side'",
                            "/cameras"));
    builder.json["nodes"].push_back({{"camera", 0}, {"name", "Side"}});
    builder.json["scenes"][0]["nodes"].push_back(3);
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Note, "takes another: 'Side', 'Data-3'", "/cameras"))
        << "a node's name stands for the first of its name";
    builder.json["cameras"][0]["name"] = "Side";
    EXPECT_EQ(find_camera(builder.load().scene, "Side")->node, "Hero") << "a camera's own name goes first";
}

TEST(Cameras, WithoutTheirDescriptionAreErrors) {
    GltfBuilder builder = with_nodes({{{"camera", 0}}});
    builder.json["cameras"] = {{{"type", "perspective"}}};
    EXPECT_TRUE(builder.load().problems.has_errors());
    builder.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 4}, {"znear", 1}}}}};
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "yfov is 4", "/cameras/0"));
}

// KHR_node_visibility: what is below a hidden node is hidden, whatever it says itself; cameras are not.
TEST(Nodes, HiddenNodesShowNothingButTheirCameras) {
    const auto visible = [](bool value) { return nlohmann::json{{"KHR_node_visibility", {{"visible", value}}}}; };
    nlohmann::json lamp = visible(true);
    lamp["KHR_lights_punctual"]["light"] = 0;
    GltfBuilder builder =
        with_nodes({{{"mesh", 0}, {"name", "seen"}, {"extensions", visible(true)}},
                    {{"children", {2}}, {"camera", 0}, {"mesh", 0}, {"extensions", visible(false)}},
                    {{"mesh", 0}, {"extensions", lamp}},
                    {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", nlohmann::json::object()}}}},
                    {{"extensions", lamp}, {"name", "shining"}}},
                   {0, 1, 3, 4});
    builder.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    builder.json["extensionsUsed"] = {"KHR_node_visibility", "KHR_lights_punctual"};
    builder.json["extensionsRequired"] = {"KHR_node_visibility"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    ASSERT_EQ(loaded.scene.instances.size(), 2u);
    EXPECT_EQ(loaded.scene.instances[0].name, "seen");
    ASSERT_EQ(loaded.scene.lights.size(), 1u);
    EXPECT_EQ(loaded.scene.lights[0].name, "shining");
    EXPECT_EQ(loaded.scene.cameras.size(), 1u);
    builder.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = 1;
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "must be true or false", "/visible"));
}

TEST(Lights, AreReadAndPlaced) {
    GltfBuilder builder =
        with_nodes({{{"mesh", 0}},
                    {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {1, 2, 3}}},
                    {{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}, {"name", "sun"}}},
                   {0, 1, 2});
    builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"},
         {"name", "lamp"},
         {"color", {1, 0.5, 0}},
         {"intensity", 7},
         {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}},
        {{"type", "directional"}}};
    const LoadedScene loaded = builder.load();
    ASSERT_EQ(loaded.scene.lights.size(), 2u) << listing(loaded.problems);
    const LightDesc& lamp = loaded.scene.lights[0];
    EXPECT_EQ(lamp.type, LightType::Spot);
    EXPECT_EQ(lamp.name, "lamp");
    EXPECT_EQ(lamp.color, Rgb(1, 0.5f, 0));
    EXPECT_EQ(lamp.intensity, 7.0f);
    EXPECT_FLOAT_EQ(lamp.inner_cone_angle, 0.1f);
    EXPECT_FLOAT_EQ(lamp.outer_cone_angle, 0.2f);
    expect_near(origin(lamp.to_world), {1, 2, 3});
    EXPECT_EQ(loaded.scene.lights[1].type, LightType::Directional);
    EXPECT_EQ(loaded.scene.lights[1].name, "sun");
    EXPECT_EQ(loaded.scene.lights[1].intensity, 1.0f);
    EXPECT_EQ(loaded.scene.extensions_used.size(), 1u);
}

/// A file with a spot of these angles, radians.
LoadedScene with_spot(double inner, double outer) {
    GltfBuilder builder = with_nodes({{{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}});
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}}};
    return builder.load();
}

TEST(Lights, CopiesOfLongNamesHaveALimit) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", std::string(1'000'000, 'n')}}};
    for (int i = 1; i <= 300; ++i) {
        builder.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        builder.json["scenes"][0]["nodes"].push_back(i);
    }
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "refers to the same things so often"))
        << listing(loaded.problems);
}

TEST(Lights, ConesAreMovedIntoTheirRange) {
    const double right = std::acos(0.0);
    const struct {
        double inner;
        double outer;
        double read_inner;
        double read_outer;
        bool is_said;
    } cases[] = {
        {-0.1, 0.2, 0.0, 0.2, true},
        {0.0, 2.0, 0.0, right, true},
        {3.0, 2.0, right, right, true},
        {0.5, right, 0.5, right, false},
        {0.5, static_cast<double>(static_cast<float>(right)), 0.5, right, false},
    };
    for (const auto& c : cases) {
        const LoadedScene loaded = with_spot(c.inner, c.outer);
        EXPECT_EQ(has_problem(loaded.problems, Severity::Warning, "not in [0, pi/2]", "/lights/0"), c.is_said)
            << c.inner << " " << c.outer << listing(loaded.problems);
        ASSERT_EQ(loaded.scene.lights.size(), 1u) << c.inner << " " << c.outer;
        EXPECT_FLOAT_EQ(loaded.scene.lights[0].inner_cone_angle, static_cast<float>(c.read_inner));
        EXPECT_FLOAT_EQ(loaded.scene.lights[0].outer_cone_angle, static_cast<float>(c.read_outer));
        EXPECT_FALSE(validate(loaded.scene).has_errors()) << listing(validate(loaded.scene));
    }
}

TEST(Lights, ThatAreClosedAreLeftOut) {
    for (const auto& [inner, outer] : {std::pair(0.0, 0.0), std::pair(0.2, 0.0), std::pair(-0.2, -0.1)}) {
        const LoadedScene closed = with_spot(inner, outer);
        EXPECT_TRUE(has_problem(closed.problems, Severity::Warning, "it is left out", "/lights/0")) << inner;
        EXPECT_FALSE(closed.problems.has_errors()) << inner;
        EXPECT_TRUE(closed.scene.lights.empty()) << inner;
    }
}

TEST(Lights, SpotsWithoutConesHaveTheDefaults) {
    GltfBuilder builder = with_nodes({{{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}});
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}}};
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "do not describe their cones", "/lights/0"));
    ASSERT_EQ(loaded.scene.lights.size(), 1u) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.lights[0].inner_cone_angle, 0.0f);
    EXPECT_FLOAT_EQ(loaded.scene.lights[0].outer_cone_angle, 0.78539816f);
}

TEST(Lights, ConesWithoutARampHaveAHardEdge) {
    const LoadedScene loaded = with_spot(0.5, 0.2);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "hard edge", "/lights/0"));
    ASSERT_EQ(loaded.scene.lights.size(), 1u);
    EXPECT_EQ(loaded.scene.lights[0].inner_cone_angle, 0.2f);
    // Cones that are equal in the file break glTF's rule; cones that are equal in single precision only do not. Blender
    // writes the last pair if the outer cone is the default.
    for (const auto& [inner, outer] : {std::pair(0.2, 0.2), std::pair(0.08968102931976317, 0.08968102931976318),
                                       std::pair(0.7853981852531433, 0.7853981633974483)}) {
        const LoadedScene equal = with_spot(inner, outer);
        EXPECT_EQ(has_problem(equal.problems, Severity::Warning, "cone", "/lights/0"), inner == outer);
        EXPECT_FALSE(equal.problems.has_errors());
        ASSERT_EQ(equal.scene.lights.size(), 1u);
        EXPECT_EQ(equal.scene.lights[0].inner_cone_angle, equal.scene.lights[0].outer_cone_angle);
    }
}
}  // namespace
}  // namespace etendue
