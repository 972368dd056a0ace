// EXT_lights_ies; KHR_lights_punctual is tested with the nodes that place it.

#include "loader/gltf/gltf_builder.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A triangle, and a node with the measured lamp `light` of the profiles `profiles`.
GltfBuilder with_lamp(nlohmann::json profiles, nlohmann::json light = {{"light", 0}}) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["nodes"].push_back(
        {{"name", "ceiling"}, {"translation", {1, 2, 3}}, {"extensions", {{"EXT_lights_ies", std::move(light)}}}});
    builder.json["scenes"][0]["nodes"] = {0, 1};
    builder.json["extensionsUsed"] = {"EXT_lights_ies"};
    builder.json["extensionsRequired"] = {"EXT_lights_ies"};
    builder.json["extensions"]["EXT_lights_ies"]["lights"] = std::move(profiles);
    return builder;
}

LoadedScene load_beside(const GltfBuilder& builder, const std::string& ies, const std::string& render_json = "{}") {
    const TempDir dir;
    builder.write(dir);
    dir.write("my lamp.ies", ies);
    dir.write("render.json", render_json);
    return inspect_scene(dir.path());
}

TEST(MeasuredLights, FromAFile) {
    const GltfBuilder builder = with_lamp({{{"uri", "my%20lamp.ies"}, {"name", "downlight"}}},
                                          {{"light", 0}, {"multiplier", 2.5}, {"color", {1, 0.5, 4}}});
    const LoadedScene loaded = load_beside(builder, ies_bytes());
    ASSERT_EQ(loaded.scene.lights.size(), 1u) << listing(loaded.problems);
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    const LightDesc& light = loaded.scene.lights[0];
    EXPECT_EQ(light.name, "downlight");
    EXPECT_EQ(light.type, LightType::Point);
    EXPECT_EQ(light.intensity, 2.5f);
    EXPECT_EQ(light.color, Rgb(1.0f, 0.5f, 1.0f)) << "clamped";
    EXPECT_EQ(light.profile.index, 0);
    EXPECT_EQ(transform_point(light.to_world, {0, 0, 0}), Vec3f(1, 2, 3));
    EXPECT_EQ(peak_candela(loaded.scene.ies_profiles.at(0)), 100.0f);
    EXPECT_EQ(loaded.scene.inputs.size(), 4u) << "the lamp is one of them";
}

TEST(MeasuredLights, FromABufferViewOrADataUri) {
    GltfBuilder view = with_lamp({{{"mimeType", "application/x-ies-lm-63"}}});
    view.json["extensions"]["EXT_lights_ies"]["lights"][0]["bufferView"] =
        view.view(std::vector<char>(ies_bytes().begin(), ies_bytes().end()));
    const GltfBuilder data =
        with_lamp({{{"uri",
                     "data:application/x-ies-lm-63;base64,"
                     "SUVTTkE6TE0tNjMtMjAwMgpUSUxUPU5PTkUKMSAtMSAxIDIgMSAxIDIgMCAwIDAKMSAxIDEwCjAgOTAKMAoxMDAgNTAK"}}});
    for (const GltfBuilder& builder : {view, data}) {
        const LoadedScene loaded = builder.load();
        ASSERT_EQ(loaded.scene.lights.size(), 1u) << listing(loaded.problems);
        EXPECT_EQ(loaded.scene.lights[0].name, "ceiling");
        EXPECT_EQ(peak_candela(loaded.scene.ies_profiles.at(0)), 100.0f);
    }
}

TEST(MeasuredLights, LampsOfOneKindShareTheirProfile) {
    GltfBuilder builder = with_lamp({{{"uri", "my%20lamp.ies"}}});
    builder.json["nodes"].push_back(builder.json["nodes"][1]);
    builder.json["scenes"][0]["nodes"] = {0, 1, 2};
    const LoadedScene loaded = load_beside(builder, ies_bytes());
    EXPECT_EQ(loaded.scene.lights.size(), 2u) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.ies_profiles.size(), 1u);
}

TEST(MeasuredLights, AreOverriddenByName) {
    const GltfBuilder builder = with_lamp({{{"uri", "my%20lamp.ies"}}}, {{"light", 0}, {"multiplier", 3}});
    const auto intensity = [&](const std::string& change) {
        return load_beside(builder, ies_bytes(), R"({"lights": {"ceiling": )" + change + "}}")
            .scene.lights.at(0)
            .intensity;
    };
    EXPECT_EQ(intensity(R"({"scale": 2})"), 6.0f);
    EXPECT_EQ(intensity(R"({"intensity": 250})"), 2.5f) << "of the peak";
}

TEST(MeasuredLights, BrokenProfilesAreErrorsWithTheirPlace) {
    struct Case {
        nlohmann::json profile;
        const char* expected;
    };
    const Case cases[] = {
        {{{"name", "x"}}, "either a URI or a buffer view"},
        {{{"uri", "a.ies"}, {"bufferView", 0}}, "either a URI or a buffer view"},
        {{{"uri", "a.ies"}}, "'a.ies': the file does not exist"},
        {{{"uri", "../a.ies"}}, "'..'"},
        {{{"uri", "http://localhost/a.ies"}}, "no other URIs"},
        {{{"uri", "data:;base64,*"}}, "not base64"},
        {{{"uri", "data:;base64,SUVT"}}, "line 1: there is no line TILT="},
        {{{"bufferView", 0}}, "no line TILT="},
    };
    for (const Case& c : cases) {
        const LoadedScene loaded = with_lamp(nlohmann::json::array({c.profile})).load();
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, c.expected, "/extensions/EXT_lights_ies/lights/0"))
            << c.expected << ":\n"
            << listing(loaded.problems);
        EXPECT_EQ(loaded.problems.error_count(), 1u);
        EXPECT_TRUE(loaded.scene.lights.empty());
    }
    const LoadedScene missing = with_lamp(nlohmann::json::array(), {{"light", 0}}).load();
    EXPECT_TRUE(has_problem(missing.problems, Severity::Error, "there are 0", "/EXT_lights_ies/light"));
}

}  // namespace
}  // namespace etendue
