// What glTF demands beyond types: errors where nothing can be rendered, one warning each for what is put right.
#include "loader/gltf/gltf_builder.h"

#include <functional>

#include <gtest/gtest.h>

namespace etendue {
namespace {

struct Breach {
    const char* name;
    Severity severity;
    const char* expected;
    const char* where;
    std::function<void(GltfBuilder&)> make;
};

class BreachTest : public testing::TestWithParam<Breach> {};

TEST_P(BreachTest, IsSaid) {
    GltfBuilder builder;
    builder.add_triangle();
    GetParam().make(builder);
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, GetParam().severity, GetParam().expected, GetParam().where))
        << listing(loaded.problems);
    EXPECT_EQ(loaded.problems.has_errors(), GetParam().severity == Severity::Error);
}

nlohmann::json& node(GltfBuilder& b) {
    return b.json["nodes"][0];
}

void add_camera(GltfBuilder& b, const nlohmann::json& camera) {
    b.json["cameras"] = nlohmann::json::array({camera});
    node(b)["camera"] = 0;
}

const Breach kBreaches[] = {
    {"EmptyChildren", Severity::Warning, "empty arrays", "/nodes/0/children",
     [](GltfBuilder& b) { node(b)["children"] = nlohmann::json::array(); }},
    {"Undeclared", Severity::Warning, "does not declare; those that are supported are read",
     "/materials/0/extensions/KHR_materials_ior",
     [](GltfBuilder& b) {
         b.json["materials"] = {{{"extensions", {{"KHR_materials_ior", {{"ior", 1.4}}}}}}};
     }},
    {"RequiredNotUsed", Severity::Warning, "missing from extensionsUsed", "/extensionsRequired",
     [](GltfBuilder& b) { b.json["extensionsRequired"] = {"KHR_materials_ior"}; }},
    {"MatrixAndScale", Severity::Warning, "the matrix counts", "/nodes/0/matrix",
     [](GltfBuilder& b) {
         node(b)["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
         node(b)["scale"] = {2, 2, 2};
     }},
    {"LongRotation", Severity::Warning, "normalised", "/nodes/0/rotation",
     [](GltfBuilder& b) {
         node(b)["rotation"] = {5, 0, 0, 1};
     }},
    {"WeightsOfNode", Severity::Warning, "morph targets", "/nodes/0/weights",
     [](GltfBuilder& b) { node(b)["weights"] = {0.5}; }},
    {"WeightsOfMesh", Severity::Warning, "morph targets", "/meshes/0/weights",
     [](GltfBuilder& b) { b.json["meshes"][0]["weights"] = {0.5}; }},
    {"NoBounds", Severity::Warning, "no min and max", "/meshes/0/primitives/0",
     [](GltfBuilder& b) { b.json["accessors"][0].erase("min"); }},
    {"FarBeforeNear", Severity::Warning, "far plane", "/cameras/0/perspective",
     [](GltfBuilder& b) {
         add_camera(b, {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 2}, {"zfar", 1}}}});
     }},
    {"HalfwayIntoAComponent", Severity::Warning, "multiples of their components' size", "/accessors/1",
     [](GltfBuilder& b) {
         b.json["accessors"].push_back(b.json["accessors"][0]);
         b.json["accessors"][1]["byteOffset"] = 1;
         b.json["accessors"][1]["count"] = 2;
     }},
    {"VertexAtAnOddByte", Severity::Warning, "of 4 for vertices", "/meshes/0/primitives/0",
     [](GltfBuilder& b) {
         const int colors = b.accessor(std::vector<unsigned char>(20, 255), "VEC4", 5121, 3, true);
         b.json["accessors"][static_cast<std::size_t>(colors)]["byteOffset"] = 2;
         b.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colors;
     }},
    {"NoMimeType", Severity::Warning, "no mimeType", "/images/0",
     [](GltfBuilder& b) {
         b.json["images"] = {{{"bufferView", 0}}};
     }},
    {"TwoChannelsOfOneTarget", Severity::Warning, "the last of them counts", "/animations/0/channels/1",
     [](GltfBuilder& b) {
         const int times = b.floats({0, 1}, 1);
         const int moves = b.floats({0, 0, 0, 1, 0, 0}, 3);
         const nlohmann::json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}};
         b.json["animations"] = {
             {{"samplers", {{{"input", times}, {"output", moves}}}}, {"channels", {channel, channel}}}};
     }},
    {"JointsTwice", Severity::Warning, "more than once", "/skins/0/joints",
     [](GltfBuilder& b) {
         b.json["skins"] = {{{"joints", {0, 0}}}};
     }},
    {"FewerTargets", Severity::Warning, "differ in number", "/meshes/0/primitives/1",
     [](GltfBuilder& b) {
         nlohmann::json& primitives = b.json["meshes"][0]["primitives"];
         primitives.push_back(primitives[0]);
         primitives[0]["targets"] = {{{"POSITION", 0}}};
     }},
    {"MoreWeightsThanTargets", Severity::Warning, "differ in number", "/meshes/0/weights",
     [](GltfBuilder& b) {
         b.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
         b.json["meshes"][0]["weights"] = {0.5, 0.5};
     }},
    {"NoNear", Severity::Error, "znear", "/cameras/0/perspective",
     [](GltfBuilder& b) {
         add_camera(b, {{"type", "perspective"}, {"perspective", {{"yfov", 1}}}});
     }},
    {"NoLens", Severity::Error, "has no 'orthographic'", "/cameras/0",
     [](GltfBuilder& b) {
         add_camera(b, {{"type", "orthographic"}});
     }},
    {"MirroredView", Severity::Warning, "not mirrored", "/cameras/0/orthographic",
     [](GltfBuilder& b) {
         add_camera(
             b, {{"type", "orthographic"}, {"orthographic", {{"xmag", -1}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}});
     }},
    {"StrideOfZero", Severity::Warning, "stride of 0", "/bufferViews/0/byteStride",
     [](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 0; }},
    {"OddStride", Severity::Warning, "no multiple of 4", "/bufferViews/1/byteStride",
     [](GltfBuilder& b) {
         b.view(std::vector<std::uint16_t>{0, 1, 2}, 2);
     }},
    {"LongStride", Severity::Warning, "up to 252", "/bufferViews/1/byteStride",
     [](GltfBuilder& b) {
         b.view(std::vector<std::uint16_t>{0, 1, 2}, 256);
     }},
    {"SpotWithoutCones", Severity::Warning, "the angles 0 and pi/4 are taken",
     "/extensions/KHR_lights_punctual/lights/1",
     [](GltfBuilder& b) {
         b.json["extensionsUsed"] = {"KHR_lights_punctual"};
         b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}, {{"type", "spot"}}};
     }},
    {"NoPrimitives", Severity::Warning, "empty arrays", "/meshes/1/primitives",
     [](GltfBuilder& b) {
         b.json["meshes"].push_back({{"primitives", nlohmann::json::array()}});
     }},
    {"EmptyAnimation", Severity::Warning, "empty arrays", "/animations/0/channels",
     [](GltfBuilder& b) {
         b.json["animations"] = {
             {{"name", "Take 001"}, {"channels", nlohmann::json::array()}, {"samplers", nlohmann::json::array()}}};
     }},
    {"NoJoints", Severity::Warning, "empty arrays", "/skins/0/joints",
     [](GltfBuilder& b) {
         b.json["skins"] = {{{"joints", nlohmann::json::array()}}};
     }},
    {"VersionTwoAndLetters", Severity::Error, "is not supported", "/asset/version",
     [](GltfBuilder& b) { b.json["asset"]["version"] = "2.0x"; }},
};

INSTANTIATE_TEST_SUITE_P(All, BreachTest, testing::ValuesIn(kBreaches),
                         [](const auto& breach) { return std::string(breach.param.name); });

TEST(GltfRules, AFileThatKeepsThemHasNoWarnings) {
    GltfBuilder builder;
    builder.add_triangle();
    EXPECT_TRUE(builder.load().problems.all().empty()) << listing(builder.load().problems);
}

}  // namespace
}  // namespace etendue
