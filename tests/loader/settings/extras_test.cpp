// Settings that the scene file's extras bring, as Blender writes custom properties.
#include "loader/gltf/gltf_builder.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

using Json = nlohmann::json;

/// A triangle of material "paper", a node "Bulb" with the point light "lamp" of 10 cd, an empty node "Spare" and a
/// camera "main"; each, their scene and the triangle's mesh have these extras, null for none.
struct Extras {
    Json material{};
    Json node{};
    Json light{};
    Json empty{};
    Json camera{};
    Json scene{};
    Json mesh{};
};

LoadedScene load_extras(const Extras& extras, const std::string& settings = "") {
    GltfBuilder builder;
    builder.add_triangle()["material"] = 0;
    const auto say = [](Json& thing, const Json& value) {
        if (!value.is_null()) thing["extras"] = {{"etendue", value}, {"other", 1}};
    };
    builder.json["materials"] = {{{"name", "paper"}}};
    say(builder.json["materials"][0], extras.material);
    builder.json["cameras"] = {
        {{"type", "perspective"}, {"name", "main"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    say(builder.json["cameras"][0], extras.camera);
    Json& nodes = builder.json["nodes"];
    nodes[0]["camera"] = 0;
    nodes.push_back({{"name", "Bulb"}});
    nodes[1]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    say(nodes[1], extras.node);
    nodes.push_back({{"name", "Spare"}});
    say(nodes[2], extras.empty);
    builder.json["scenes"][0]["nodes"] = {0, 1, 2};
    say(builder.json["scenes"][0], extras.scene);
    say(builder.json["meshes"][0], extras.mesh);
    builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "lamp"}, {"intensity", 10}}};
    say(builder.json["extensions"]["KHR_lights_punctual"]["lights"][0], extras.light);
    const TempDir dir;
    builder.write(dir);
    if (!settings.empty()) dir.write("render.json", settings);
    return inspect_scene(dir.path());
}

TEST(Extras, DoNotHideWhatIsWrongWithRenderJson) {
    for (const char* const settings : {R"({"materials": {"paper": 5}})", R"({"materials": {"paper": null}})"}) {
        const LoadedScene loaded = load_extras({.material = {{"roughness", 0.25}}}, settings);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "", "/materials/paper")) << listing(loaded.problems);
    }
}

TEST(Extras, SetWhatRenderJsonSets) {
    const LoadedScene loaded = load_extras({.material = {{"visible_to_camera", false}, {"roughness", 0.25}},
                                            .node = {{"radius", 0.5}},
                                            .light = {{"color", {1, 0, 0}}},
                                            .empty = {{"type", "rectangle"}, {"power", 5}}});
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    EXPECT_FALSE(loaded.scene.materials.at(0).visible_to_camera);
    EXPECT_EQ(loaded.scene.materials.at(0).roughness, 0.25f);
    EXPECT_TRUE(loaded.scene.lights.empty()) << "a sphere took its place";
    ASSERT_EQ(loaded.scene.instances.size(), 3u);
    EXPECT_EQ(loaded.scene.instances[1].name, "Bulb");
    EXPECT_EQ(loaded.scene.materials.at(1).emissive, Rgb(1, 0, 0));
    EXPECT_EQ(loaded.scene.instances[2].name, "Spare");
}

TEST(Extras, MayBeTextAndHaveNumbersForFlags) {
    const LoadedScene loaded = load_extras({.material = R"({"visible_to_camera": 0})", .node = {{"enabled", 0}}});
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    EXPECT_FALSE(loaded.scene.materials.at(0).visible_to_camera);
    EXPECT_TRUE(loaded.scene.lights.empty());
}

TEST(Extras, GiveWayToRenderJsonKeyByKey) {
    const LoadedScene loaded = load_extras(
        {.material = {{"visible_to_camera", false}, {"roughness", 0.25}}, .node = {{"power", 5}, {"color", {1, 0, 0}}}},
        R"({"materials": {"paper": {"visible_to_camera": true}}, "lights": {"Bulb": {"intensity": 3}}})");
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    EXPECT_TRUE(loaded.scene.materials.at(0).visible_to_camera);
    EXPECT_EQ(loaded.scene.materials.at(0).roughness, 0.25f);
    EXPECT_EQ(loaded.scene.lights.at(0).intensity, 3.0f);
    EXPECT_EQ(loaded.scene.lights.at(0).color, Rgb(1, 0, 0));
}

TEST(Extras, ThatAreWrongAreWarningsAndTheRestHolds) {
    const auto expect = [](const Extras& extras, const std::string& part, const std::string& pointer) {
        const LoadedScene loaded = load_extras(extras);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, part, pointer)) << listing(loaded.problems);
        EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        return loaded.scene;
    };
    const SceneDesc scene = expect({.material = {{"rougness", 0.25}, {"visible_to_camera", false}, {"metallic", "x"}}},
                                   "did you mean 'roughness'", "/materials/0/extras/etendue/rougness");
    EXPECT_FALSE(scene.materials.at(0).visible_to_camera);
    expect({.material = {{"metallic", "x"}}}, "must be a number", "/materials/0/extras/etendue/metallic");
    expect({.material = {{"metallic", 2}}}, "must be a number in [0, 1]", "/materials/0/extras/etendue/metallic");
    expect({.material = 3}, "must be an object, but is a number", "/materials/0/extras/etendue");
    expect({.material = "{"}, "", "/materials/0/extras/etendue");
    expect({.material = Json::object()}, "says nothing", "/materials/0/extras/etendue");
    expect({.node = {{"angle", 1}}}, "no angle", "/nodes/1/extras/etendue/angle");
    expect({.node = {{"visible_to_camera", false}}}, "never seen", "/nodes/1/extras/etendue/visible_to_camera");
    expect({.empty = {{"radius", 1}}}, "has no light", "/nodes/2/extras/etendue");
    expect({.empty = {{"type", "rectangle"}}}, "must have a", "/nodes/2/extras/etendue");
    expect({.empty = {{"type", "rectangle"}, {"power", 1}, {"radius", 1}}}, "has no radius",
           "/nodes/2/extras/etendue/radius");
    expect({.scene = {{"spp", 4}}}, "belongs in render.json", "/scenes/0/extras/etendue/spp");
    expect({.scene = {{"materials", 3}}}, "must be an object", "/scenes/0/extras/etendue/materials");
    expect({.scene = {{"materials", {{"paper", {{"metallic", 2}}}}}}}, "must be a number in [0, 1]",
           "/scenes/0/extras/etendue/materials/paper/metallic");
    expect({.scene = {{"environment", {{"scale", -1}}}}}, "", "/scenes/0/extras/etendue/environment/scale");
    const SceneDesc without = expect({.scene = {{"environment", {{"image", "missing.exr"}}}}}, "missing.exr",
                                     "/scenes/0/extras/etendue/environment/image");
    EXPECT_FALSE(without.environment.enabled);
    expect({.mesh = {{"visible_to_camera", false}}}, "is not read here", "/meshes/0/extras/etendue");
    expect({.camera = {{"f_stop", -2}}}, "must be a number > 0", "/cameras/0/extras/etendue/f_stop");
    expect({.camera = {{"focus_node", "Nobody"}}}, "no node 'Nobody'", "/cameras/0/extras/etendue/focus_node");
}

TEST(Extras, OfCamerasYieldToRenderJson) {
    const Extras extras{.camera = {{"lens_radius", 0.25}, {"focus_distance", 3}, {"blades", 5}}};
    const LoadedScene alone = load_extras(extras);
    EXPECT_TRUE(alone.problems.all().empty()) << listing(alone.problems);
    ASSERT_EQ(alone.scene.cameras.size(), 1u);
    EXPECT_EQ(alone.scene.cameras[0].lens_radius, 0.25f);
    EXPECT_EQ(alone.scene.cameras[0].aperture.blades, 5);
    const LoadedScene both = load_extras(extras, R"({"cameras": {"main": {"focus_distance": 7}}})");
    EXPECT_TRUE(both.problems.all().empty()) << listing(both.problems);
    EXPECT_EQ(both.scene.cameras[0].lens_radius, 0.25f);
    EXPECT_EQ(both.scene.cameras[0].focus_distance, 7.0f);
}

TEST(Extras, OfScenesYieldToThoseOfThingsAndToRenderJson) {
    const Extras extras{.light = {{"color", {1, 0, 0}}},
                        .scene = Json::parse(R"({"environment": {"color": [0, 1, 0], "scale": 2},
                                                 "materials": {"paper": {"roughness": 0.25, "metallic": 0.5}},
                                                 "lights": {"lamp": {"intensity": 3, "color": [0, 0, 1]}},
                                                 "cameras": {"main": {"lens_radius": 0.25, "focus_distance": 3}}})")};
    const LoadedScene alone = load_extras(extras);
    EXPECT_TRUE(alone.problems.all().empty()) << listing(alone.problems);
    EXPECT_TRUE(alone.scene.environment.enabled);
    EXPECT_EQ(alone.scene.environment.color, Rgb(0, 1, 0));
    EXPECT_EQ(alone.scene.environment.scale, 2.0f);
    EXPECT_EQ(alone.scene.materials.at(0).roughness, 0.25f);
    EXPECT_EQ(alone.scene.lights.at(0).intensity, 3.0f);
    EXPECT_EQ(alone.scene.lights.at(0).color, Rgb(1, 0, 0)) << "the lamp's own";
    EXPECT_EQ(alone.scene.cameras.at(0).lens_radius, 0.25f);
    const LoadedScene both =
        load_extras(extras, R"({"environment": {"scale": 5}, "materials": {"paper": {"roughness": 0.75}}})");
    EXPECT_TRUE(both.problems.all().empty()) << listing(both.problems);
    EXPECT_EQ(both.scene.environment.color, Rgb(0, 1, 0));
    EXPECT_EQ(both.scene.environment.scale, 5.0f);
    EXPECT_EQ(both.scene.materials.at(0).roughness, 0.75f);
    EXPECT_EQ(both.scene.materials.at(0).metallic, 0.5f);
}

TEST(Extras, OfAnyKindCrashNothing) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["extras"] = {{"etendue", {{"spp", 3}}}};
    for (const Json& extras : {Json(nullptr), Json(1), Json("etendue"), Json::array({Json{{"etendue", 1}}}),
                               Json{{"etendue", nullptr}}, Json{{"etendue", Json::array({1})}}}) {
        builder.json["nodes"][0]["extras"] = extras;
        builder.json["meshes"][0]["extras"] = extras;
        const TempDir dir;
        builder.write(dir);
        const ProblemList problems = inspect_scene(dir.path()).problems;
        EXPECT_FALSE(problems.has_errors()) << extras;
        EXPECT_TRUE(has_problem(problems, Severity::Warning, "is not read here", "/extras/etendue")) << extras;
    }
}

TEST(LampNotes, AreaLampsOfWhichAnEmptyNodeIsLeftAreNamed) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["nodes"].push_back({{"name", "Area.001"}});
    builder.json["nodes"].push_back({{"name", "Target"}});
    builder.json["scenes"][0]["nodes"] = {0, 1, 2};
    const auto load = [&](const std::string& settings) {
        const TempDir dir;
        builder.write(dir);
        dir.write("render.json", settings);
        return inspect_scene(dir.path()).problems;
    };
    EXPECT_TRUE(has_problem(load("{}"), Severity::Note, "\"lights\": {\"Area.001\"")) << listing(load("{}"));
    for (const char* lights : {R"({"Area.001": {"type": "disk", "power": 1}})",
                               R"({"key": {"type": "disk", "power": 1, "node": "Area.001"}})"}) {
        const ProblemList problems = load(R"({"lights": )" + std::string(lights) + "}");
        EXPECT_FALSE(has_problem(problems, Severity::Note, "area lamp")) << listing(problems);
        EXPECT_FALSE(problems.has_errors()) << listing(problems);
    }
    builder.json["nodes"][1]["name"] = "Arena";
    EXPECT_FALSE(has_problem(load("{}"), Severity::Note, "area lamp"));
}

TEST(LampNotes, WattsAsLumensAreRecognised) {
    const auto load = [](const char* type, double intensity, const std::string& settings) {
        GltfBuilder builder;
        builder.add_triangle();
        builder.json["nodes"].push_back({{"name", "Lamp"}, {"translation", {0, 1, 0}}});
        builder.json["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 0;
        builder.json["scenes"][0]["nodes"] = {0, 1};
        builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", type}, {"intensity", intensity}}};
        const TempDir dir;
        builder.write(dir);
        dir.write("render.json", settings);
        return inspect_scene(dir.path()).problems;
    };
    // 100 W and 3 W/m², by 683 lm/W.
    for (const auto& [type, intensity] : {std::pair("point", 5435.0), std::pair("directional", 2049.0)}) {
        EXPECT_TRUE(has_problem(load(type, intensity, "{}"), Severity::Note, "--light-units radiometric")) << type;
        EXPECT_FALSE(has_problem(load(type, intensity / 683.0, "{}"), Severity::Note, "--light-units"));
        for (const char* settings : {R"({"light_units": "radiometric"})", R"({"color": {"exposure": -8}})",
                                     R"({"lights": {"Lamp": {"scale": 0.001}}})"})
            EXPECT_FALSE(has_problem(load(type, intensity, settings), Severity::Note, "--light-units")) << settings;
    }
}

}  // namespace
}  // namespace etendue
