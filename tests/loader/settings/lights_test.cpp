// Lamps that render.json adds and changes.
#include "loader/gltf/gltf_builder.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr double kPiD = std::numbers::pi;

/// A triangle of node 0, nodes "Bulb" with the point light "lamp" of 10 cd, "Star" with the sun "sun" of 2 lx and
/// "Beam" with a spot of 5 cd, and an empty node "Area" at (1, 2, 3), twice as large, that looks along -X.
LoadedScene load_lamps(const std::string& lights, const std::string& settings = "") {
    GltfBuilder builder;
    builder.add_triangle();
    const auto node = [&](const std::string& name, int light) {
        nlohmann::json json = {{"name", name}, {"translation", {0, 4, 0}}};
        json["extensions"]["KHR_lights_punctual"]["light"] = light;
        return json;
    };
    nlohmann::json& nodes = builder.json["nodes"];
    nodes.push_back(node("Bulb", 0));
    nodes.push_back(node("Star", 1));
    nodes.push_back(node("Beam", 2));
    nodes.push_back({{"name", "Area"},
                     {"translation", {1, 2, 3}},
                     {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
                     {"scale", {2, 2, 2}}});
    builder.json["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "lamp"}, {"intensity", 10}},
        {{"type", "directional"}, {"name", "sun"}, {"intensity", 2}},
        {{"type", "spot"}, {"intensity", 5}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}}};
    const TempDir dir;
    builder.write(dir);
    dir.write("render.json", "{" + settings + R"("lights": )" + lights + "}");
    return inspect_scene(dir.path());
}

const MaterialDesc& material_of(const SceneDesc& scene, const InstanceDesc& instance) {
    const MeshDesc& mesh = scene.meshes.at(static_cast<std::size_t>(instance.mesh.index));
    return scene.materials.at(static_cast<std::size_t>(mesh.primitives.at(0).material.index));
}

/// The lamp that has been added last.
struct Added {
    const InstanceDesc& instance;
    const MaterialDesc& material;
    double radiance;
    double area;
    Vec3f axis;  ///< unit, where its front looks

    explicit Added(const SceneDesc& scene)
        : instance(scene.instances.back()),
          material(material_of(scene, instance)),
          radiance(static_cast<double>(material.emissive_strength)),
          area(0.0),
          axis(0.0f) {
        const PrimitiveDesc& surface = scene.meshes.at(static_cast<std::size_t>(instance.mesh.index)).primitives.at(0);
        area = surface.shape.value().area(instance.to_world);
        axis = normalize(transform_vector(instance.to_world, {0.0f, 0.0f, -1.0f}));
    }
    /// Returns the watts that the lamp emits if it is as bright from everywhere.
    [[nodiscard]] double power() const { return kPiD * area * radiance; }
};

TEST(Lamps, SurfacesHaveThePowerThatIsSaid) {
    const char* const lamps[] = {
        R"({"type": "rectangle", "width": 2, "height": 0.5, "power": 100})",
        R"({"type": "disk", "radius": 0.7, "power": 100, "spread": 1.0})",
        R"({"type": "disk", "width": 1, "height": 3, "power": 100})",
        R"({"type": "sphere", "radius": 0.1, "power": 50, "scale": 2, "node": "Area"})",
    };
    const double areas[] = {2.0 * 0.5 * 4.0, kPiD * 0.49 * 4.0, kPiD * 0.75 * 4.0, 4.0 * kPiD * 0.01 * 4.0};
    for (std::size_t i = 0; i < std::size(lamps); ++i) {
        const LoadedScene loaded = load_lamps(std::string(R"({"Area": )") + lamps[i] + "}");
        ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        const Added lamp(loaded.scene);
        EXPECT_NEAR(lamp.power(), 100.0, 1e-3) << lamps[i];
        EXPECT_NEAR(lamp.area / areas[i], 1.0, 1e-5) << "the node is twice as large: " << lamps[i];
        EXPECT_EQ(lamp.instance.name, "Area");
        EXPECT_TRUE(lamp.material.visible_to_camera);
        EXPECT_EQ(loaded.scene.lights.size(), 3u);
        if (i == 3) continue;
        EXPECT_NEAR(lamp.axis.x, -1.0f, 1e-5f) << "along the node's -Z: " << lamps[i];
    }
}

TEST(Lamps, AreExactShapes) {
    const auto shape_of = [](const std::string& lamp) {
        const LoadedScene loaded = load_lamps(R"({"a": {"power": 1, "position": [0, 0, 0], )" + lamp + "}}");
        EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        return loaded.scene.meshes.back().primitives.at(0).shape.value();
    };
    EXPECT_EQ(shape_of(R"("type": "sphere")").kind, ShapeKind::Sphere);
    EXPECT_EQ(shape_of(R"("type": "sphere", "radius": 2)").half_size, Vec3f(2.0f));
    EXPECT_EQ(shape_of(R"("type": "disk")").half_size, Vec3f(0.5f));
    EXPECT_EQ(shape_of(R"("type": "disk", "width": 4, "height": 2)").half_size, Vec3f(2.0f, 1.0f, 1.0f));
    EXPECT_EQ(shape_of(R"("type": "rectangle", "width": 4, "height": 2)").kind, ShapeKind::Rectangle);
    EXPECT_EQ(shape_of(R"("type": "point", "radius": 2)").kind, ShapeKind::Sphere);
    EXPECT_EQ(shape_of(R"("type": "spot", "radius": 2)").kind, ShapeKind::Disk);
}

// The power stays what it is where the node makes an ellipsoid of a sphere.
TEST(Lamps, EllipsoidsHaveThePowerThatIsSaid) {
    const ShapeDesc ball{ShapeKind::Sphere, Vec3f(1.0f)};
    const auto scaled = [](float x, float y, float z) {
        Mat4f m;
        m.setScale(Vec3f(x, y, z));
        return m;
    };
    // Closed forms of spheroids with semi-axes 1 and 2, e² = 1 - 1 / 4.
    EXPECT_NEAR(ball.area(Mat4f()), 4.0 * kPiD, 1e-12);
    const double e = std::sqrt(0.75);
    const double oblate = 2.0 * kPiD * 4.0 * (1.0 + 0.25 / e * std::atanh(e));
    const double prolate = 2.0 * kPiD * (1.0 + 2.0 / e * std::asin(e));
    EXPECT_NEAR(ball.area(scaled(2.0f, 1.0f, 2.0f)) / oblate, 1.0, 1e-12);
    EXPECT_NEAR(ball.area(scaled(1.0f, 2.0f, 1.0f)) / prolate, 1.0, 1e-12);
    EXPECT_NEAR(ball.area(scaled(1.0f, 1.0f, 1e-6f)), 2.0 * kPiD, 1e-6) << "both sides of a disk";
}

TEST(Lamps, StandWhereThePositionSaysAndLookWhereTheyAreTold) {
    const auto axis = [](const std::string& place) {
        const LoadedScene loaded =
            load_lamps(R"({"a": {"type": "rectangle", "radiance": 3, "position": [1, 2, 3])" + place + "}}");
        EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        const Added lamp(loaded.scene);
        EXPECT_EQ(lamp.radiance, 3.0);
        EXPECT_EQ(transform_point(lamp.instance.to_world, Vec3f(0.0f)), Vec3f(1, 2, 3));
        return lamp.axis;
    };
    EXPECT_NEAR(axis("").z, -1.0f, 1e-6f);
    EXPECT_NEAR(axis(R"(, "look_at": [1, 0, 3])").y, -1.0f, 1e-6f) << "straight down, too";
    EXPECT_NEAR(axis(R"(, "look_at": [5, 2, 3], "up": [0, 0, 1])").x, 1.0f, 1e-6f);
    EXPECT_NEAR(axis(R"(, "rotation": [0, 1, 0, 0])").z, 1.0f, 1e-6f);
}

TEST(Lamps, PointsAndSpotsKeepTheirIntensityAsSurfaces) {
    const LoadedScene ball = load_lamps(R"({"lamp": {"radius": 0.5, "visible_to_camera": false}})");
    ASSERT_FALSE(ball.problems.has_errors()) << listing(ball.problems);
    EXPECT_EQ(ball.scene.lights.size(), 2u);
    const Added sphere(ball.scene);
    // Power over the full sphere.
    EXPECT_NEAR(sphere.power() / (4.0 * kPiD), 10.0, 1e-4);
    EXPECT_EQ(sphere.instance.name, "Bulb");
    EXPECT_EQ(ball.scene.meshes.back().name, "lamp");
    EXPECT_FALSE(sphere.material.visible_to_camera);
    EXPECT_EQ(transform_point(sphere.instance.to_world, Vec3f(0.0f)), Vec3f(0, 4, 0));

    const LoadedScene cone = load_lamps(R"({"Beam": {"radius": 0.5}})");
    const Added disk(cone.scene);
    EXPECT_NEAR(disk.radiance * disk.area, 5.0, 1e-5) << "along the axis";
    EXPECT_EQ(disk.material.beam.kind, BeamDesc::Kind::Spot);
    EXPECT_FLOAT_EQ(disk.material.beam.outer_cone_angle, 0.6f);

    const LoadedScene watts = load_lamps(R"({"lamp": {"radius": 0.5}})", R"("light_units": "radiometric", )");
    EXPECT_NEAR(Added(watts.scene).power() / (4.0 * kPiD) * 683.002, 10.0, 1e-3);
}

TEST(Lamps, ThoseThatStopNoLightAreClear) {
    for (const char* lamps : {R"({"lamp": {"radius": 0.5, "stops_light": false}})",
                              R"({"Area": {"type": "disk", "power": 1, "stops_light": false}})",
                              R"({"a": {"type": "point", "power": 1, "position": [0, 0, 0], "radius": 1,
                                  "stops_light": false}})"}) {
        const LoadedScene loaded = load_lamps(lamps);
        ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        const Added lamp(loaded.scene);
        EXPECT_TRUE(std::holds_alternative<std::monostate>(lamp.material.override_model)) << lamps;
        EXPECT_EQ(lamp.material.transmission, 1.0f) << lamps;
        EXPECT_EQ(lamp.material.specular, 0.0f) << lamps;
        EXPECT_EQ(lamp.material.roughness, 0.0f) << lamps;
        EXPECT_GT(lamp.radiance, 0.0) << lamps;
    }
    const LoadedScene usual = load_lamps(R"({"lamp": {"radius": 0.5}})");
    EXPECT_EQ(Added(usual.scene).material.transmission, 0.0f);
}

TEST(Lamps, SunsHaveAnAngle) {
    const LoadedScene changed = load_lamps(R"({"sun": {"angle": 0.12}})");
    ASSERT_FALSE(changed.problems.has_errors()) << listing(changed.problems);
    EXPECT_FLOAT_EQ(changed.scene.lights.at(1).angle, 0.12f);
    EXPECT_FLOAT_EQ(changed.scene.lights.at(1).intensity, 2.0f);
    const LoadedScene added = load_lamps(
        R"({"day": {"type": "sun", "irradiance": 3, "angle": 0.5, "position": [0, 1, 0], "look_at": [0, 0, 0]}})",
        R"("light_units": "radiometric", )");
    ASSERT_FALSE(added.problems.has_errors()) << listing(added.problems);
    const LightDesc& sun = added.scene.lights.at(3);
    EXPECT_EQ(sun.type, LightType::Directional);
    EXPECT_FLOAT_EQ(sun.intensity, 3.0f * 683.002f) << "which the units divide by as much";
    EXPECT_NEAR(transform_vector(sun.to_world, {0, 0, -1}).y, -1.0f, 1e-6f);
}

TEST(Lamps, OfTheDocumentTakeThePlaceOfThoseOfTheFile) {
    const LoadedScene loaded = load_lamps(R"({"Bulb": {"type": "point", "power": 100}, "sun": {"type": "sphere",
        "power": 3}, "Beam": {"type": "disk", "power": 1, "enabled": false}})");
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    ASSERT_EQ(loaded.scene.lights.size(), 1u);
    EXPECT_NEAR(loaded.scene.lights[0].intensity, 100.0 / (4.0 * kPiD), 1e-4);
    EXPECT_EQ(transform_point(loaded.scene.lights[0].to_world, Vec3f(0.0f)), Vec3f(0, 4, 0));
    EXPECT_EQ(Added(loaded.scene).instance.name, "sun");
}

// Whether or not they shine: over such a size no power is left at any place.
TEST(Lamps, ThatAreTooLargeAreRefused) {
    const auto expect = [](const std::string& lights, const std::string& pointer) {
        const LoadedScene loaded = load_lamps(lights);
        ProblemList problems = validate(loaded.scene);
        for (const Problem& problem : loaded.problems.all()) problems.add(problem);
        EXPECT_TRUE(has_problem(problems, Severity::Error, "must stay within 1e+15 m", pointer))
            << lights << listing(problems);
    };
    const std::string place = R"("position": [0, 0, 0], )";
    for (const char* radius : {"1e17", "1e25", "1e38"})
        expect(R"({"a": {"type": "sphere", )" + place + R"("power": 1, "radius": )" + radius + "}}", "/lights/a");
    expect(R"({"a": {"type": "rectangle", )" + place + R"("radiance": 0, "width": 1e30}})", "/lights/a");
    expect(R"({"a": {"type": "disk", )" + place + R"("radiance": 1, "color": [0, 0, 0], "radius": 1e30}})",
           "/lights/a");
    expect(R"({"a": {"type": "point", )" + place + R"("intensity": 1, "radius": 1e25}})", "/lights/a");
    expect(R"({"lamp": {"radius": 1e25}})", "/lights/lamp");
    expect(R"({"Beam": {"radius": 1e25}})", "/lights/Beam");
    const LoadedScene dark = load_lamps(R"({"a": {"type": "sphere", "position": [0, 0, 0], "power": 0}})");
    EXPECT_FALSE(dark.problems.has_errors()) << listing(dark.problems);
    EXPECT_EQ(dark.scene.instances.size(), 1u) << "dark, and left out";
}

// The schema writes bounds so; in single precision some are a little beyond.
TEST(Lamps, MayHaveTheNumbersAtTheEndsOfTheirRanges) {
    for (const char* angle :
         {R"("type": "sun", "irradiance": 1, "angle": 3.141592)", R"("type": "disk", "power": 1, "spread": 0.0174532)",
          R"("type": "disk", "power": 1, "spread": 3.1415928)",
          R"("type": "spot", "power": 1, "outer_cone_angle": 1.5707964)"}) {
        const LoadedScene loaded = load_lamps(R"({"Area": {)" + std::string(angle) + "}}");
        EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        EXPECT_FALSE(validate(loaded.scene).has_errors()) << listing(validate(loaded.scene));
    }
    EXPECT_TRUE(load_lamps(R"({"Area": {"type": "sun", "irradiance": 1, "angle": 3.1415927}})").problems.has_errors());
    EXPECT_TRUE(
        load_lamps(R"({"Area": {"type": "disk", "power": 1, "width": 1e-60, "height": 1}})").problems.has_errors())
        << "not above 0 in single precision";
}

TEST(Lamps, WhatTheyCannotBeIsSaid) {
    const auto expect = [](const std::string& lights, const std::string& part, const std::string& pointer) {
        const LoadedScene loaded = load_lamps(lights);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, part, pointer)) << lights << listing(loaded.problems);
    };
    expect(R"({"Area": {"scale": 2}})", "the node 'Area' has no light", "/lights/Area");
    expect(R"({"Aera": {"type": "disk", "power": 1}})", "did you mean 'Area'", "/lights/Aera");
    expect(R"({"a": {"type": "disk", "power": 1, "node": "Aera"}})", "did you mean 'Area'", "/lights/a/node");
    expect(R"({"lamp": {"angle": 1}})", "no angle", "/lights/lamp/angle");
    expect(R"({"lamp": {"irradiance": 1}})", "no irradiance", "/lights/lamp/irradiance");
    expect(R"({"lamp": {"visible_to_camera": true}})", "never seen", "/lights/lamp/visible_to_camera");
    expect(R"({"lamp": {"stops_light": false}})", "stops no other light", "/lights/lamp/stops_light");
    expect(R"({"sun": {"stops_light": false}})", "stops no other light", "/lights/sun/stops_light");
    expect(R"({"sun": {"radius": 1}})", "no radius", "/lights/sun/radius");
    expect(R"({"sun": {"power": 1}})", "no power", "/lights/sun/power");
    expect(R"({"sun": {"visible_to_camera": false}})", "never seen", "/lights/sun/visible_to_camera");
    expect(R"({"a": {"type": "sphere", "position": [0, 0, 0]}})", "must have a \"power\" or a \"radiance\"",
           "/lights/a");
    expect(R"({"Area": {"type": "rectangle", "angle": "wide"}})", "angle", "/lights/Area/angle");
    expect(R"({"Area": {"type": "dsik", "power": 1}})", "did you mean 'disk'", "/lights/Area/type");
}

}  // namespace
}  // namespace etendue
