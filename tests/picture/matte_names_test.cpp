#include "picture/matte_names.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

using Names = std::vector<std::string>;

struct Placed {
    std::string name;
    std::uint32_t node;
};

SceneDesc scene_of(std::vector<NodeDesc> nodes, const std::vector<Placed>& placed) {
    SceneDesc scene;
    scene.nodes = std::move(nodes);
    for (const Placed& each : placed) {
        InstanceDesc& instance = scene.instances.emplace_back();
        instance.name = each.name;
        instance.node = each.node;
    }
    return scene;
}

constexpr std::uint32_t kTop = NodeDesc::kNone;

TEST(ObjectNames, AreThoseOfTheNodes) {
    const SceneDesc scene =
        scene_of({{"ground", kTop, 0}, {"", kTop, 4}, {"", kTop, 5}}, {{"ground", 0}, {"mesh of it", 1}, {"", 2}});
    EXPECT_EQ(object_names(scene), (Names{"ground", "mesh of it", "unnamed_node_5"}));
}

TEST(ObjectNames, ThatAreSharedAreToldApartByWhereTheyAre) {
    const SceneDesc scene =
        scene_of({{"car", kTop, 0}, {"wheel", 0, 1}, {"wheel", 0, 2}, {"", kTop, 3}, {"wheel", 3, 4}, {"body", 0, 5}},
                 {{"wheel", 1}, {"wheel", 2}, {"wheel", 4}, {"body", 5}});
    EXPECT_EQ(object_names(scene), (Names{"car/wheel", "car/wheel#2", "unnamed_node_3/wheel", "body"}));
    EXPECT_EQ(asset_names(scene), (Names{"car", "car", "unnamed_node_3", "car"}));
}

TEST(ObjectNames, AreNotTakenFromAnother) {
    const SceneDesc scene =
        scene_of({{"a", kTop, 0}, {"b", 0, 1}, {"b", kTop, 2}, {"a/b", kTop, 3}}, {{"b", 1}, {"b", 2}, {"a/b", 3}});
    EXPECT_EQ(object_names(scene), (Names{"a/b#1", "b", "a/b"}));
}

TEST(ObjectNames, OfInstancesOfOneNodeAreOne) {
    const SceneDesc scene = scene_of({{"tree", kTop, 0}, {"tree", kTop, 1}}, {{"tree", 0}, {"tree", 0}, {"tree", 1}});
    EXPECT_EQ(object_names(scene), (Names{"tree", "tree", "tree#1"}));
}

TEST(ObjectNames, OfDeepFilesAreBounded) {
    std::vector<NodeDesc> nodes{{"n", kTop, 0}};
    for (std::uint32_t i = 1; i < 1000; ++i) nodes.push_back({"n", i - 1, i});
    const std::vector<std::string> names = object_names(scene_of(nodes, {{"n", 998}, {"n", 999}}));
    EXPECT_EQ(names[0].size(), 63u) << "32 of them";
    EXPECT_EQ(names[1], names[0] + "#999");
}

// Half of the nodes have the names that the numbers of the others would give.
TEST(ObjectNames, OfManyThatAreTakenAreFoundSoon) {
    constexpr std::uint32_t kCount = 15000;
    std::vector<NodeDesc> nodes;
    std::vector<Placed> placed;
    for (std::uint32_t i = 0; i < 2 * kCount; ++i) {
        const std::string name = i < kCount ? "n" : fmt::format("n#{}", i - kCount);
        nodes.push_back({name, kTop, i});
        placed.push_back({name, i});
    }
    const SceneDesc scene = scene_of(std::move(nodes), placed);
    const auto start = std::chrono::steady_clock::now();
    const Names names = object_names(scene);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << "by the square: more than a minute";
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
    EXPECT_EQ(names[0], "n");
    EXPECT_EQ(names[1], fmt::format("n#{}", kCount));
    EXPECT_EQ(names[kCount + 7], "n#7");
}

// A mesh of a topmost node without a name, and what is below that node.
TEST(AssetNames, AreOneForANodeAndAllBelowIt) {
    const SceneDesc scene = scene_of({{"", kTop, 0}, {"wheel", 0, 1}, {"", kTop, 2}, {"door", 2, 3}},
                                     {{"wheel", 1}, {"body mesh", 0}, {"door", 3}});
    EXPECT_EQ(asset_names(scene), (Names{"body mesh", "body mesh", "unnamed_node_2"}));
}

TEST(MatteNames, OfScenesThatComeFromNoFile) {
    SceneDesc scene = scene_of({}, {{"ball", kTop}, {"ball", kTop}, {"", kTop}});
    EXPECT_EQ(object_names(scene), (Names{"ball", "ball#1", "unnamed_node_2"}));
    EXPECT_EQ(asset_names(scene), (Names{"ball", "ball", "unnamed_node_2"}));
}

TEST(MaterialNames, AreThoseOfTheFile) {
    SceneDesc scene;
    for (const char* name : {"gold", "", "gold"}) scene.materials.emplace_back().name = name;
    EXPECT_EQ(material_names(scene), (Names{"gold", "unnamed_material_1", "gold"}));
    for (std::size_t i = 0; i < 3; ++i) scene.materials[i].location = {"a.gltf", fmt::format("/materials/{}", i)};
    scene.materials.emplace_back().location = {"a.gltf", {}};  // of primitives without one
    EXPECT_EQ(material_names(scene), (Names{"gold", "unnamed_material_1", "gold", "default_material"}));
}

TEST(CleanMatteName, KeepsCharactersWhole) {
    EXPECT_EQ(clean_matte_name("a\nb\tc\x7f \"'"), "a_b_c_ \"'");
    const std::string umlauts = "x" + std::string(200, 'y') + "\xc3\xa4\xc3\xa4";
    EXPECT_EQ(clean_matte_name(umlauts), umlauts);
    std::string long_name(254, 'a');
    long_name += "\xc3\xa4";
    EXPECT_EQ(clean_matte_name(long_name), std::string(254, 'a'));
    EXPECT_EQ(clean_matte_name(std::string(300, 'b')).size(), 255u);
}

}  // namespace

}  // namespace etendue::test
