#include "loader/gltf/gltf_builder.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A triangle with a material, a camera and a lamp, and an animation of `pointer` from `values` at 0 s to those at 1 s.
GltfBuilder pointing(const std::string& pointer, const std::vector<float>& values, int components) {
    GltfBuilder builder;
    builder.add_triangle()["material"] = 0;
    auto& json = builder.json;
    json["materials"] = {{{"name", "paint"}}};
    json["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    json["scenes"][0]["nodes"] = {0, 1};
    json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_animation_pointer"};
    json["extensionsRequired"] = {"KHR_animation_pointer"};
    json["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}}};
    json["animations"] = {
        {{"samplers", {{{"input", builder.floats({0, 1}, 1)}, {"output", builder.floats(values, components)}}}},
         {"channels",
          {{{"sampler", 0},
            {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}}}}}};
    return builder;
}

LoadedScene load_at(const GltfBuilder& builder, double seconds) {
    LoadOptions options;
    options.adjust = [seconds](RenderSettings& settings) { settings.time_code = seconds; };
    LoadedScene loaded = builder.load(options);
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    return loaded;
}

TEST(AnimationPointer, MaterialsHaveTheValuesOfTheMoment) {
    const GltfBuilder color =
        pointing("/materials/0/pbrMetallicRoughness/baseColorFactor", {0, 0, 0, 1, 1, 0.5f, 0, 1}, 4);
    EXPECT_EQ(load_at(color, 0.5).scene.materials.at(0).base_color, Rgb(0.5f, 0.25f, 0.0f));
    EXPECT_EQ(color.load().scene.materials.at(0).base_color, Rgb(1.0f)) << "at rest";
    const GltfBuilder metallic = pointing("/materials/0/pbrMetallicRoughness/metallicFactor", {-1, 1}, 1);
    EXPECT_EQ(load_at(metallic, 0.75).scene.materials.at(0).metallic, 0.5f);
    EXPECT_EQ(load_at(metallic, 0.0).scene.materials.at(0).metallic, 0.0f) << "kept within the range";
    const GltfBuilder strength =
        pointing("/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", {2, 4}, 1);
    EXPECT_EQ(load_at(strength, 0.5).scene.materials.at(0).emissive_strength, 3.0f);
    const GltfBuilder cutoff = pointing("/materials/0/alphaCutoff", {0, 1}, 1);
    EXPECT_EQ(load_at(cutoff, 0.25).scene.materials.at(0).alpha_cutoff, 0.25f);
}

TEST(AnimationPointer, WhatIsNotThereIsNotMade) {
    const LoadedScene loaded = load_at(pointing("/materials/0/normalTexture/scale", {0, 1}, 1), 0.5);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "cannot be animated")) << listing(loaded.problems);
}

// The node is hidden at first; the camera and the ground are placed for all that is shown at any time.
TEST(AnimationPointer, HiddenNodesCountForTheStageOfTheWhole) {
    GltfBuilder builder = pointing("/nodes/0/extensions/KHR_node_visibility/visible", {0, 1}, 1);
    builder.json["animations"][0]["samplers"][0]["interpolation"] = "STEP";
    builder.json["animations"][0]["samplers"][0]["output"] =
        builder.accessor(std::vector<std::uint8_t>{0, 1}, "SCALAR", 5121, 2);
    builder.json["extensionsUsed"].push_back("KHR_node_visibility");
    builder.json.erase("cameras");
    builder.json["nodes"][1].erase("camera");
    for (const int frame : {0, 24}) {
        const LoadedScene loaded = builder.load({.frame = frame});
        EXPECT_EQ(loaded.scene.instances.size(), frame == 0 ? 0u : 1u) << listing(loaded.problems);
        EXPECT_EQ(loaded.swept.bounds.max, Vec3f(1, 1, 0)) << "frame " << frame;
    }
}

TEST(AnimationPointer, CamerasAndLightsToo) {
    EXPECT_EQ(load_at(pointing("/cameras/0/perspective/yfov", {0.5f, 1.5f}, 1), 0.5).scene.cameras.at(0).yfov, 1.0f);
    EXPECT_EQ(load_at(pointing("/extensions/KHR_lights_punctual/lights/0/intensity", {0, 8}, 1), 0.5)
                  .scene.lights.at(0)
                  .intensity,
              4.0f);
    EXPECT_EQ(load_at(pointing("/extensions/KHR_lights_punctual/lights/0/color", {0, 0, 0, 1, 1, 1}, 3), 0.5)
                  .scene.lights.at(0)
                  .color,
              Rgb(0.5f));
}

/// The same with a measured lamp beside the other, and an environment.
GltfBuilder pointing_to_light(const std::string& pointer, const std::vector<float>& values, int components) {
    GltfBuilder builder = pointing(pointer, values, components);
    builder.add_cube_map();
    builder.json["extensionsUsed"].push_back("EXT_lights_ies");
    builder.json["extensions"]["EXT_lights_ies"]["lights"] = {
        {{"mimeType", "application/x-ies-lm-63"},
         {"bufferView", builder.view(std::vector<char>(ies_bytes().begin(), ies_bytes().end()))}}};
    builder.json["nodes"][1]["extensions"]["EXT_lights_ies"] = {{"light", 0}, {"multiplier", 2}};
    return builder;
}

TEST(AnimationPointer, MeasuredLampsToo) {
    const auto lamp_at = [](const GltfBuilder& builder, double seconds) {
        return load_at(builder, seconds).scene.lights.at(1);
    };
    const GltfBuilder multiplier = pointing_to_light("/nodes/1/extensions/EXT_lights_ies/multiplier", {-1, 8}, 1);
    EXPECT_EQ(lamp_at(multiplier, 1.0).intensity, 8.0f);
    EXPECT_EQ(lamp_at(multiplier, 0.5).intensity, 3.5f);
    EXPECT_EQ(lamp_at(multiplier, 0.0).intensity, 0.0f) << "kept within the range";
    EXPECT_EQ(multiplier.load().scene.lights.at(1).intensity, 2.0f) << "at rest";
    const GltfBuilder color = pointing_to_light("/nodes/1/extensions/EXT_lights_ies/color", {0, 0, 0, 1, 0.5f, 4}, 3);
    EXPECT_EQ(lamp_at(color, 0.5).color, Rgb(0.5f, 0.25f, 1.0f)) << "the file says no colour";
    EXPECT_EQ(lamp_at(color, 0.5).intensity, 2.0f) << "what else the node says of it stays";
}

TEST(AnimationPointer, EnvironmentsToo) {
    const std::string light = "/extensions/EXT_lights_image_based/lights/0/";
    const GltfBuilder intensity = pointing_to_light(light + "intensity", {-1, 3}, 1);
    EXPECT_EQ(load_at(intensity, 0.75).scene.environment.cube.value().intensity, 2.0f);
    EXPECT_EQ(load_at(intensity, 0.0).scene.environment.cube.value().intensity, 0.0f) << "kept within the range";
    EXPECT_EQ(intensity.load().scene.environment.cube.value().intensity, 1.0f) << "at rest";
    // From rest to half a turn about y: a third of the way is 60 degrees, where straight lines would give 53.
    const GltfBuilder rotation = pointing_to_light(light + "rotation", {0, 0, 0, 1, 0, 1, 0, 0}, 4);
    const Mat4f third = load_at(rotation, 1.0 / 3.0).scene.environment.cube.value().to_world;
    const Vec3f turned = transform_vector(third, {1, 0, 0});
    EXPECT_LT(length(turned - Vec3f(0.5f, 0.0f, -0.8660254f)), 1e-6f) << turned;
}

// What the loader does not read of them, and lights that are not there.
TEST(AnimationPointer, OtherThingsOfTheseLightsAreIgnoredWithAWarning) {
    for (const char* pointer :
         {"/nodes/0/extensions/EXT_lights_ies/multiplier", "/nodes/9/extensions/EXT_lights_ies/multiplier",
          "/nodes/x/extensions/EXT_lights_ies/multiplier", "/nodes/1/extensions/EXT_lights_ies/light",
          "/nodes/1/extensions/EXT_lights_ies/color", "/nodes/1/extensions/EXT_lights_ies/color/0",
          "/extensions/EXT_lights_ies/lights/0/multiplier", "/extensions/EXT_lights_image_based/lights/1/intensity",
          "/extensions/EXT_lights_image_based/lights/-/intensity",
          "/extensions/EXT_lights_image_based/lights/0/rotation",
          "/extensions/EXT_lights_image_based/lights/0/irradianceCoefficients",
          "/extensions/EXT_lights_image_based/lights/0/specularImageSize"}) {
        const LoadedScene loaded = load_at(pointing_to_light(pointer, {0, 1}, 1), 0.5);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "cannot be animated", "/animations/0/channels/0"))
            << pointer;
        EXPECT_EQ(loaded.scene.lights.at(1).intensity, 2.0f) << pointer;
        EXPECT_EQ(loaded.scene.environment.cube.value().intensity, 1.0f) << pointer;
    }
    EXPECT_TRUE(
        has_problem(load_at(pointing("/extensions/EXT_lights_image_based/lights/0/intensity", {0, 1}, 1), 0.5).problems,
                    Severity::Warning, "cannot be animated"))
        << "the file has no environment";
}

TEST(AnimationPointer, OtherExtensionsMayReferToWhatCannotBeAnimated) {
    GltfBuilder builder = pointing("/materials/0/alphaCutoff", {0, 1}, 1);
    builder.add_cube_map();
    EXPECT_EQ(load_at(builder, 0.25).scene.materials.at(0).alpha_cutoff, 0.25f);
}

TEST(AnimationPointer, NodesMoveAsWithOrdinaryChannels) {
    const GltfBuilder builder = pointing("/nodes/0/translation", {0, 0, 0, 4, 0, 0}, 3);
    const LoadedScene loaded = load_at(builder, 0.5);
    EXPECT_EQ(transform_point(loaded.scene.instances.at(0).to_world, Vec3f(0.0f)), Vec3f(2, 0, 0));
    LoadOptions open;
    open.adjust = [](RenderSettings& settings) {
        settings.time_code = 0.0;
        settings.shutter = {0.0, 0.5};
    };
    EXPECT_EQ(builder.load(open).scene.instances.at(0).motion.size(), 2u);
}

// Bytes that are 0 or 1, as the extension has them; a hidden node hides what is below it.
TEST(AnimationPointer, NodesHideAndShow) {
    GltfBuilder builder = pointing("/nodes/0/extensions/KHR_node_visibility/visible", {0, 0}, 1);
    builder.json["extensionsUsed"].push_back("KHR_node_visibility");
    auto& sampler = builder.json["animations"][0]["samplers"][0];
    constexpr int kUnsignedByte = 5121;
    sampler["output"] = builder.accessor<std::uint8_t>({0, 1}, "SCALAR", kUnsignedByte, 2);
    sampler["interpolation"] = "STEP";
    EXPECT_EQ(load_at(builder, 0.5).scene.instances.size(), 0u);
    EXPECT_EQ(load_at(builder, 1.0).scene.instances.size(), 1u);
    EXPECT_EQ(builder.load().scene.instances.size(), 1u) << "at rest";
    builder.json["nodes"][0]["extensions"] = {{"KHR_node_visibility", {{"visible", false}}}};
    EXPECT_EQ(load_at(builder, 1.0).scene.instances.size(), 1u) << "whatever the file says of it at rest";
}

// What selects objects shows nothing: the file is shown without it.
TEST(AnimationPointer, OthersOfNodesAreIgnoredWithAWarning) {
    GltfBuilder builder = pointing("/nodes/0/extensions/KHR_node_selectability/selectable", {0, 0}, 1);
    constexpr int kUnsignedByte = 5121;
    builder.json["animations"][0]["samplers"][0]["output"] =
        builder.accessor<std::uint8_t>({0, 1}, "SCALAR", kUnsignedByte, 2);
    EXPECT_TRUE(has_problem(load_at(builder, 0.5).problems, Severity::Warning, "cannot be animated",
                            "/animations/0/channels/0"));
}

/// How high the third vertex of the triangle is at half a second, whose two targets raise it by 2 and by 8.
float raised_by(const std::string& pointer, const std::vector<float>& values) {
    GltfBuilder builder = pointing(pointer, values, 1);
    const auto raise = [&builder](float by) {
        return nlohmann::json{{"POSITION", builder.floats({0, 0, 0, 0, 0, 0, 0, 0, by}, 3)}};
    };
    builder.json["meshes"][0]["primitives"][0]["targets"] = {raise(2), raise(8)};
    builder.json["meshes"][0]["weights"] = {1, 0};
    const SceneDesc scene = load_at(builder, 0.5).scene;
    const auto mesh = static_cast<std::size_t>(scene.instances.at(0).mesh.index);
    return scene.meshes.at(mesh).primitives.at(0).positions.at(2).z;
}

TEST(AnimationPointer, MorphTargetsOneByOneOrOfAMesh) {
    EXPECT_EQ(raised_by("/meshes/0/weights", {0, 0, 1, 1}), 5.0f) << "both at one half";
    EXPECT_EQ(raised_by("/meshes/0/weights/1", {0, 1}), 6.0f) << "the first keeps what the mesh says";
    EXPECT_EQ(raised_by("/nodes/0/weights/0", {0, 1}), 1.0f);
    EXPECT_EQ(raised_by("/nodes/0/weights/1", {0, 1}), 6.0f);
}

TEST(AnimationPointer, WhatItCannotAnimateIsSaid) {
    for (const char* pointer :
         {"/materials/1/alphaCutoff", "/materials/0/name", "/materials/0/glitter", "/materials/-1/alphaCutoff",
          "/materials", "/meshes/0/weights", "/meshes/0/weights/0", "/nodes/0/weights/0", "/nodes/0/mesh",
          "/nodes/9/translation", "no pointer", "/materials/0/emissiveFactor"}) {
        const LoadedScene loaded = load_at(pointing(pointer, {0, 1}, 1), 0.5);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "cannot be animated", "/animations/0/channels/0"))
            << pointer;
    }
}

}  // namespace
}  // namespace etendue
