#include "loader/settings/render_json.h"

#include "loader/gltf/gltf_builder.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

struct Parsed {
    RenderJson json;
    ProblemList problems;
};

Parsed parse(const std::string& text) {
    const TempDir dir;
    dir.write("render.json", text);
    Parsed result;
    result.json = read_render_json(dir.path() / "render.json", {}, result.problems);
    return result;
}

/// A triangle of material "paper" lit by a light "lamp" and seen by a camera "main", with this render.json.
LoadedScene load_with(const std::string& text, const nlohmann::json& translation = {0, 0, 0}) {
    GltfBuilder builder;
    builder.add_triangle()["material"] = 0;
    builder.json["materials"] = {{{"name", "paper"}, {"emissiveFactor", {1, 1, 1}}}};
    builder.json["cameras"] = {
        {{"type", "perspective"}, {"name", "main"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    builder.json["nodes"][0]["camera"] = 0;
    builder.json["nodes"][0]["translation"] = translation;
    builder.json["nodes"][0]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "lamp"}, {"intensity", 10}}};
    const TempDir dir;
    builder.write(dir);
    dir.write("render.json", text);
    return inspect_scene(dir.path());
}

TEST(RenderJson, DefaultsStayWhenNothingIsSaid) {
    const Parsed parsed = parse("{}");
    EXPECT_TRUE(parsed.problems.all().empty());
    EXPECT_EQ(parsed.json.settings.spp, RenderSettings{}.spp);
    EXPECT_FALSE(parsed.json.environment);
}

TEST(RenderJson, EverySettingIsRead) {
    const Parsed parsed = parse(R"({
        "scene": "x.glb", "integrator": {"type": "direct", "max_depth": 7, "min_depth": 2, "roulette_depth": 6, "light_samples": 5,
                       "heuristic": "power", "strategy": "2,3", "weighted": false, "connections": "cache:4"},
        "sampler": "random", "spp": 9, "seed": 4294967295, "time": 1.5, "error": 0.25, "adaptive": false, "min_spp": 70, "size": [30, 20], "crop": [1, 2, 3, 4],
        "light_units": "radiometric", "camera": "c", "lens_radius": 0.5, "focus_distance": 4,
        "film": {"filter": "mitchell", "filter_radius": 2.5},
        "environment": {"image": "i.exr", "color": [1, 2, 3], "scale": 4, "rotation": 5, "visible_to_camera": false},
        "color": {"working_space": "w", "display": "d", "view": "v", "look": "l", "exposure": -1, "output_space": "o",
                  "aces_container": true}})");
    EXPECT_TRUE(parsed.problems.all().empty()) << listing(parsed.problems);
    const RenderSettings& s = parsed.json.settings;
    EXPECT_EQ(parsed.json.scene, "x.glb");
    EXPECT_EQ(s.integrator.type, "direct");
    EXPECT_EQ(s.integrator.lengths.max_depth, 7);
    EXPECT_EQ(s.integrator.lengths.min_depth, 2);
    EXPECT_EQ(s.integrator.lengths.roulette_depth, 6);
    EXPECT_EQ(s.integrator.light_samples, 5u);
    EXPECT_EQ(s.integrator.heuristic, Heuristic::Power);
    EXPECT_EQ(s.integrator.strategy, (Strategy{2, 3}));
    EXPECT_FALSE(s.integrator.weighted);
    EXPECT_EQ(s.integrator.cached_connections, 4);
    EXPECT_EQ(s.sampler, SamplerType::Random);
    EXPECT_EQ(s.spp, 9);
    EXPECT_EQ(s.seed, 4294967295u);
    EXPECT_EQ(s.time_limit, 1.5);
    EXPECT_EQ(s.relative_error, 0.25);
    EXPECT_FALSE(s.adaptive);
    EXPECT_EQ(s.min_spp, 70);
    EXPECT_EQ(s.light_units, LightUnits::Radiometric);
    EXPECT_EQ(s.film.width, 30);
    EXPECT_EQ(s.film.height, 20);
    EXPECT_EQ(s.film.crop, (std::array{1, 2, 3, 4}));
    EXPECT_EQ(s.camera, "c");
    EXPECT_EQ(parsed.json.lens.lens_radius, 0.5f);
    EXPECT_EQ(parsed.json.lens.focus_distance, 4.0f);
    EXPECT_EQ(s.film.filter, PixelFilterType::Mitchell);
    EXPECT_EQ(s.film.filter_radius, 2.5f);
    EXPECT_EQ(parsed.json.environment->image, "i.exr");
    EXPECT_EQ(parsed.json.environment->color, Rgb(1, 2, 3));
    EXPECT_EQ(parsed.json.environment->scale, 4.0f);
    EXPECT_EQ(parsed.json.environment->rotation, 5.0f);
    EXPECT_FALSE(parsed.json.environment->visible_to_camera);
    EXPECT_EQ(s.color.working_space, "w");
    EXPECT_EQ(s.color.display, "d");
    EXPECT_EQ(s.color.view, "v");
    EXPECT_EQ(s.color.look, "l");
    EXPECT_EQ(s.color.exposure, -1.0f);
    EXPECT_EQ(s.color.output_space, "o");
    EXPECT_TRUE(s.color.aces_container);
}

TEST(RenderJson, AnisotropyMayBeTheMostOfItsRange) {
    for (const char* material :
         {R"({"scatter_anisotropy": 0.999})", R"({"scatter_anisotropy": -0.999})",
          R"({"subsurface": {"anisotropy": 0.999}})", R"({"dielectric": {"scatter_anisotropy": -0.999}})"}) {
        const LoadedScene loaded = load_with(R"({"materials": {"paper": )" + std::string(material) + "}}");
        EXPECT_FALSE(loaded.problems.has_errors()) << material << listing(loaded.problems);
        EXPECT_FALSE(validate(loaded.scene).has_errors()) << material << listing(validate(loaded.scene));
    }
}

TEST(RenderJson, UnknownKeysSuggestTheNearest) {
    const Parsed parsed =
        parse(R"({"sppp": 3, "integrator": {"maxdepth": 4}, "color": {"veiw": "x"}, "film": {"zzz": 1}})");
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "did you mean 'spp'", "/sppp"));
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "did you mean 'max_depth'", "/integrator/maxdepth"));
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "did you mean 'view'", "/color/veiw"));
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "'filter', 'filter_radius'", "/film/zzz"));
    EXPECT_EQ(parsed.problems.error_count(), 4u);
    EXPECT_NE(parsed.problems.all()[0].where.file.find("render.json"), std::string::npos);
}

TEST(RenderJson, KnownKeysThatAreUnknownHereAreToldTheirPlace) {
    const Parsed parsed = parse(R"({"max_depth": 3, "exposure": 1, "integrator": {"spp": 4}, "zzz": 1})");
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "it belongs in 'integrator'", "/max_depth"));
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "it belongs in 'color'", "/exposure"));
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "it belongs outside of this object", "/integrator/spp"));
    EXPECT_FALSE(has_problem(parsed.problems, Severity::Error, "'animation', 'animation'")) << "no name stands twice";
    EXPECT_EQ(parsed.problems.error_count(), 4u);
}

TEST(RenderJson, ErrorsStateWhatIsExpected) {
    const Parsed parsed = parse(R"({"spp": 0, "time": "x", "size": [3], "camera":
        {"position": [0, 0, 1], "look_at": [0, 0, 0], "yfov": 4}, "sampler": "sobel", "focus_distance": 0})");
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "integer in [1, 16777216], but is 0", "/spp"));
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "a number >= 0, but is a string", "/time"));
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "an array of 2 integers, but is an array of 1", "/size"));
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "a number in (0, 3.14159], but is 4", "/camera/yfov"));
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "did you mean 'sobol'", "/sampler"));
    EXPECT_TRUE(has_problem(parsed.problems, Severity::Error, "a number > 0", "/focus_distance"));
    EXPECT_EQ(parsed.problems.error_count(), 6u);
}

TEST(RenderJson, BrokenFilesAreErrors) {
    for (const char* text : {"", "{", "{\"spp\": 1,}", "{\"spp\": 1, \"spp\": 2}", "\xff"}) {
        EXPECT_TRUE(parse(text).problems.has_errors()) << text;
    }
    EXPECT_TRUE(parse(std::string(100'000, '[')).problems.has_errors());
}

TEST(RenderJson, CameraObjectIsAddedAndChosen) {
    const LoadedScene loaded = load_with(R"({"camera": {"position": [3, 0, 0], "look_at": [1, 0, 0], "yfov": 1}})");
    ASSERT_EQ(loaded.scene.cameras.size(), 2u) << listing(loaded.problems);
    const CameraDesc& camera = loaded.scene.cameras[1];
    EXPECT_EQ(camera.name, "render.json");
    EXPECT_EQ(loaded.scene.settings.camera, "render.json");
    EXPECT_EQ(camera.focus_distance, 2.0f);
    EXPECT_EQ(camera.yfov, 1.0f);
    // It looks along -x: its local -z.
    EXPECT_NEAR(camera.to_world[2][0], 1.0f, 1e-6f);
    EXPECT_NEAR(camera.to_world[1][1], 1.0f, 1e-6f);
    EXPECT_NEAR(camera.to_world.determinant(), 1.0f, 1e-6f);
    EXPECT_EQ(camera.to_world[3][0], 3.0f);
}

TEST(RenderJson, CameraObjectMayBeFarAway) {
    const LoadedScene loaded =
        load_with(R"({"camera": {"position": [5000000.3, 0, 0], "look_at": [5000000.1, 0, 0]}})", {5000000, 0, 0});
    ASSERT_EQ(loaded.scene.cameras.size(), 2u) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.origin, Vec3d(5e6, 0, 0));
    const CameraDesc& camera = loaded.scene.cameras[1];
    EXPECT_NEAR(camera.to_world[3][0], 0.3f, 1e-7f);
    EXPECT_NEAR(camera.to_world[2][0], 1.0f, 1e-6f);
    EXPECT_NEAR(camera.focus_distance, 0.2f, 1e-7f);
}

TEST(RenderJson, CameraThatCannotBeAimedIsAnError) {
    const auto problems_of = [](const char* camera) {
        return load_with(std::string("{\"camera\": ") + camera + "}").problems;
    };
    EXPECT_TRUE(has_problem(problems_of(R"({"position": [1, 1, 1], "look_at": [1, 1, 1]})"), Severity::Error, "differ",
                            "/camera/look_at"));
    EXPECT_TRUE(has_problem(problems_of(R"({"position": [0, 5, 0], "look_at": [0, 0, 0]})"), Severity::Error,
                            "parallel", "/camera/up"));
    EXPECT_TRUE(has_problem(problems_of(R"({"name": "main", "position": [0, 0, 5], "look_at": [0, 0, 0]})"),
                            Severity::Error, "already has a camera", "/camera"));
}

TEST(RenderJson, LensAppliesToTheCamera) {
    const LoadedScene loaded = load_with(R"({"lens_radius": 0.25, "focus_distance": 9})");
    EXPECT_EQ(loaded.scene.cameras.at(0).lens_radius, 0.25f);
    EXPECT_EQ(loaded.scene.cameras.at(0).focus_distance, 9.0f);
}

TEST(RenderJson, UnknownNamesSuggestTheNearest) {
    const LoadedScene loaded =
        load_with(R"({"camera": "mian", "materials": {"papier": {"diffuse": {}}}, "lights": {"lamb": {"scale": 2}}})");
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "did you mean 'main'"));
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "did you mean 'paper'", "/materials/papier"));
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "did you mean 'lamp'", "/lights/lamb"));
}

TEST(RenderJson, UnknownNamesBeyondTheLongestListAreCounted) {
    std::string materials;
    for (int i = 0; i < 1100; ++i)
        materials += fmt::format(R"({}"papier{}": {{"diffuse": {{}}}})", i > 0 ? ", " : "", i);
    const LoadedScene loaded = load_with(R"({"materials": {)" + materials + "}}");
    EXPECT_EQ(loaded.problems.all().size(), ProblemList::kMaxProblems);
    EXPECT_GE(loaded.problems.error_count(), 1100u);
}

TEST(RenderJson, MaterialOverrides) {
    const auto material = [](const std::string& change) {
        const LoadedScene loaded = load_with("{\"materials\": {\"paper\": " + change + "}}");
        EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        return loaded.scene.materials.at(0);
    };
    const MaterialDesc gold = material(R"({"conductor": {"metal": "Au", "roughness": 0.5}})");
    ASSERT_TRUE(std::holds_alternative<ConductorDesc>(gold.override_model));
    EXPECT_EQ(std::get<ConductorDesc>(gold.override_model).metal, "Au");
    EXPECT_EQ(std::get<ConductorDesc>(gold.override_model).roughness, 0.5f);
    EXPECT_EQ(gold.emissive, Rgb(1.0f));  // untouched

    const MaterialDesc glass = material(R"({"dielectric": {"ior": 1.33}})");
    EXPECT_EQ(std::get<DielectricDesc>(glass.override_model).ior, 1.33f);

    const MaterialDesc clay = material(R"({"diffuse": {"albedo": [0.1, 0.2, 0.3]}, "emission": {"color": [0, 0, 0]}})");
    EXPECT_EQ(std::get<DiffuseDesc>(clay.override_model).albedo, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(clay.emissive, Rgb(0.0f));

    const MaterialDesc lamp = material(R"({"emission": {"color": [4, 2, 0], "strength": 10}})");
    EXPECT_TRUE(std::holds_alternative<std::monostate>(lamp.override_model));
    EXPECT_EQ(lamp.emissive, Rgb(1, 0.5f, 0));
    EXPECT_EQ(lamp.emissive_strength, 40.0f);
}

/// The material "paper" of the scene above, but with all that `material` says, after this change of render.json.
LoadedScene load_material(const nlohmann::json& material, const std::string& change) {
    GltfBuilder builder;
    builder.add_triangle()["material"] = 0;
    builder.json["materials"] = {material};
    builder.json["materials"][0]["name"] = "paper";
    const TempDir dir;
    builder.write(dir);
    dir.write("render.json", "{\"materials\": {\"paper\": " + change + "}}");
    return inspect_scene(dir.path());
}

TEST(RenderJson, FactorsChangeOneNumberOfTheGltfMaterial) {
    const nlohmann::json source = {{"pbrMetallicRoughness", {{"metallicFactor", 0.25}, {"roughnessFactor", 0.5}}},
                                   {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}}}};
    const LoadedScene loaded =
        load_material(source, R"({"roughness": 0.125, "sheen_color": [0.5, 0, 1], "transmission": 1, "priority": 0})");
    const MaterialDesc& material = loaded.scene.materials.at(0);
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(material.override_model));
    EXPECT_EQ(material.roughness, 0.125f);
    EXPECT_EQ(material.metallic, 0.25f);
    EXPECT_EQ(material.sheen.color, Rgb(0.5f, 0, 1));
    EXPECT_EQ(material.transmission, 1.0f);
}

// Each factor by its own name: no two write to one place.
TEST(RenderJson, EveryFactorHasAPlaceOfItsOwn) {
    std::set<const float*> places;
    MaterialDesc material;
    for (const MaterialFactor& factor : material_factors()) {
        ASSERT_NE(factor.number == nullptr, factor.color == nullptr) << factor.name;
        const float* const place = factor.number != nullptr ? &factor.number(material) : &factor.color(material).r;
        EXPECT_TRUE(places.insert(place).second) << factor.name;
    }
}

TEST(RenderJson, FactorsThatMeanNothingAreErrors) {
    const auto expect = [](const LoadedScene& loaded, const std::string& message, const std::string& pointer) {
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, message, pointer)) << listing(loaded.problems);
    };
    expect(load_material({}, R"({"rougness": 0.1})"), "did you mean 'roughness'", "/materials/paper/rougness");
    expect(load_material({}, R"({"diffuse": {}, "roughness": 0.1})"), "a model takes the place",
           "/materials/paper/roughness");
    expect(load_material({}, R"({"dielectric": {}, "solid": true})"), "a model takes the place",
           "/materials/paper/solid");
    expect(load_material({}, R"({"emission": {}, "emissive": [1, 1, 1]})"), "'emission' takes its place",
           "/materials/paper/emissive");
    expect(load_material({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", nlohmann::json::object()}}}},
                         R"({"roughness": 0.1})"),
           "which has no roughness", "/materials/paper/roughness");
}

TEST(RenderJson, SolidClosesAMaterialAndKeepsIt) {
    const nlohmann::json glass = {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1, 1, 1}}}},
                                  {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}};
    const LoadedScene loaded = load_material(glass, R"({"solid": true})");
    EXPECT_TRUE(loaded.scene.materials.at(0).volume.closed);
    EXPECT_EQ(loaded.scene.materials[0].base_color, Rgb(0.5f, 1, 1));
    EXPECT_TRUE(has_problem(load_material({}, R"({"solid": true})").problems, Severity::Warning, "transmits no light",
                            "/materials/paper/solid"));
    nlohmann::json thick = glass;
    thick["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    EXPECT_TRUE(load_material(thick, R"({"roughness": 0})").scene.materials.at(0).volume.closed);
    EXPECT_FALSE(load_material(thick, R"({"solid": false})").scene.materials.at(0).volume.closed);
}

/// A camera at z = 10 that looks along -Z, and a node "in focus" 4 m before it and 3 m beside its axis.
LoadedScene load_lens(const std::string& text, double aspect_ratio = 0.0) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["cameras"] = {
        {{"type", "perspective"}, {"name", "main"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    if (aspect_ratio > 0.0) builder.json["cameras"][0]["perspective"]["aspectRatio"] = aspect_ratio;
    builder.json["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 10}}});
    builder.json["nodes"].push_back({{"name", "in focus"}, {"translation", {3, 0, 6}}});
    builder.json["nodes"].push_back({{"name", "behind"}, {"translation", {0, 0, 11}}});
    builder.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
    const TempDir dir;
    builder.write(dir);
    dir.write("render.json", text);
    return inspect_scene(dir.path());
}

// A full-frame camera of 50 mm sees 24 mm of height in landscape 3:2, and 36 mm in portrait.
TEST(RenderJson, LensesAsPhotographersSayThem) {
    const auto camera = [](const LoadedScene& loaded) {
        EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        return loaded.scene.cameras.at(0);
    };
    const CameraDesc wide = camera(load_lens(R"({"size": [300, 200], "focal_length": 50, "f_stop": 2})"));
    EXPECT_NEAR(wide.yfov, 2.0f * std::atan(12.0f / 50.0f), 1e-6f);
    EXPECT_NEAR(wide.lens_radius, 0.0125f, 1e-8f);
    EXPECT_NEAR(wide.focal_length, 50.0f, 1e-4f);
    const CameraDesc tall = camera(load_lens(R"({"size": [200, 300], "focal_length": 50, "sensor_width": 24})"));
    EXPECT_NEAR(tall.yfov, 2.0f * std::atan(12.0f / 50.0f), 1e-6f);
    EXPECT_EQ(tall.lens_radius, 0.0f);
    // The focal length of the camera's own view, whatever the image is.
    const CameraDesc own = camera(load_lens(R"({"size": [90, 100], "f_stop": 4})", 1.5));
    EXPECT_EQ(own.yfov, 0.5f);
    const float focal_length = 12.0f / std::tan(0.25f);
    EXPECT_NEAR(own.focal_length, focal_length, 1e-4f);
    EXPECT_NEAR(own.lens_radius, focal_length * 1e-3f / 8.0f, 1e-8f);
    EXPECT_NEAR(camera(load_lens(R"({"focus_node": "in focus"})")).focus_distance, 4.0f, 1e-6f);
    // A focal length is that of the image, whatever view the file's camera has.
    const CameraDesc other = camera(load_lens(R"({"size": [108, 192], "focal_length": 50})", 16.0 / 9.0));
    EXPECT_NEAR(other.yfov, 2.0f * std::atan(18.0f / 50.0f), 1e-6f);
}

TEST(RenderJson, FocusesOnNodesFromWhereTheCameraIsPlaced) {
    const LoadedScene own = load_lens(R"({"focus_node": "in focus"})");
    const Vec3f node = std::ranges::find(own.scene.nodes, "in focus", &NodeDesc::name)->position();
    const Vec3d eye = Vec3d(node) + Vec3d(0.0, 0.0, 20.0);
    const LoadedScene placed =
        load_lens(fmt::format(R"({{"focus_node": "in focus", "camera_place": [{}, {}, {}, {}, {}, {}]}})", eye.x, eye.y,
                              eye.z, eye.x, eye.y, eye.z - 1.0));
    EXPECT_FALSE(placed.problems.has_errors()) << listing(placed.problems);
    EXPECT_NEAR(placed.scene.cameras.at(0).focus_distance, 20.0f, 1e-4f);
}

TEST(RenderJson, NotesWhatACameraOfItsTypeDoesNotHave) {
    const auto note_of = [](const char* json) { return listing(load_lens(json).problems); };
    EXPECT_NE(note_of(R"({"cameras": {"main": {"fov": 0.3, "ymag": 4}}})").find("ignores fov, ymag; yfov and focal"),
              std::string::npos);
    EXPECT_NE(note_of(R"({"cameras": {"main": {"focus_distance": 3, "blades": 6}}})")
                  .find("is a pinhole, and ignores focus_distance, blades; lens_radius or f_stop"),
              std::string::npos);
    const LoadedScene flat = load_lens(R"({"cameras": {"main": {"type": "orthographic", "ymag": 4, "yfov": 0.5}}})");
    EXPECT_EQ(flat.scene.cameras.at(0).ymag, 4.0f);
    EXPECT_NE(listing(flat.problems).find("is orthographic, and ignores yfov"), std::string::npos);
    EXPECT_EQ(load_lens(R"({"cameras": {"main": {"yfov": 0.25}}})").scene.cameras.at(0).yfov, 0.25f);
    EXPECT_NE(note_of(R"({"camera": {"position": [0, 0, 5], "look_at": [0, 0, 0], "fov": 2, "focus_distance": 3}})")
                  .find("is a pinhole, and ignores focus_distance, fov"),
              std::string::npos);
    EXPECT_EQ(note_of(R"({"camera": {"position": [0, 0, 5], "look_at": [0, 0, 0], "yfov": 0.5}})").find("ignores"),
              std::string::npos);
}

// What is said of one camera goes before what is said of all, which it keeps the rest of.
TEST(RenderJson, ChangesCamerasByName) {
    const LoadedScene loaded = load_lens(R"({"size": [300, 200], "lens_radius": 0.5, "focus_distance": 9,
        "sensor_width": 24, "cameras": {"main": {"f_stop": 2, "focal_length": 50, "shift": [0.25, -0.5], "clip": true,
        "clip_end": 7, "blades": 5, "blade_rotation": 0.5, "aperture_ratio": 2}}})");
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const CameraDesc& camera = loaded.scene.cameras.at(0);
    EXPECT_NEAR(camera.yfov, 2.0f * std::atan(8.0f / 50.0f), 1e-6f);
    EXPECT_NEAR(camera.lens_radius, 0.0125f, 1e-8f);
    EXPECT_EQ(camera.focus_distance, 9.0f);
    EXPECT_EQ(camera.shift, Vec2f(0.25f, -0.5f));
    EXPECT_EQ(camera.clip.start, camera.file_clip.start);
    EXPECT_GT(camera.clip.start, 0.0f);
    EXPECT_EQ(camera.clip.end, 7.0f);
    EXPECT_EQ(camera.aperture.blades, 5);
    EXPECT_EQ(camera.aperture.rotation, 0.5f);
    EXPECT_EQ(camera.aperture.ratio, 2.0f);
    const CameraDesc plain = load_lens("{}").scene.cameras.at(0);
    EXPECT_EQ(plain.clip.start, 0.0f) << "clipped without being asked to";
    EXPECT_TRUE(std::isinf(plain.clip.end));
    EXPECT_NEAR(load_lens(R"({"cameras": {"main": {"focus_node": "in focus"}}, "focus_distance": 3})")
                    .scene.cameras.at(0)
                    .focus_distance,
                4.0f, 1e-6f);
}

// Of a lens of 8 mm, an equisolid circle of 180 degrees is 4 · 8 mm · sin(45°) across.
TEST(RenderJson, MakesPanoramasOfCameras) {
    const LoadedScene loaded = load_lens(R"({"size": [300, 200], "cameras": {"main": {"type": "fisheye",
        "mapping": "equisolid", "focal_length": 8, "sensor_width": 36}}})");
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const CameraDesc& camera = loaded.scene.cameras.at(0);
    EXPECT_EQ(camera.type, CameraType::Fisheye);
    EXPECT_EQ(camera.fisheye, FisheyeType::Equisolid);
    EXPECT_EQ(camera.fov, kPi);
    EXPECT_NEAR(camera.circle, 32.0f * std::sqrt(0.5f) / 24.0f, 1e-5f);
    const LoadedScene round = load_lens(R"({"cameras": {"main": {"type": "equirectangular"}}, "f_stop": 2,
        "lens_radius": 0.1})");
    EXPECT_EQ(round.scene.cameras.at(0).type, CameraType::Equirectangular);
}

TEST(RenderJson, LensesOfCamerasWithoutAnyAreNoted) {
    for (const char* type : {"orthographic", "equirectangular", "fisheye"}) {
        const LoadedScene loaded =
            load_lens(R"({"f_stop": 2, "cameras": {"main": {"blades": 5, "focal_length": 9, "type": ")" +
                      std::string(type) + "\"}}}");
        EXPECT_TRUE(has_problem(
            loaded.problems, Severity::Note,
            type == std::string("fisheye") ? "ignores f_stop, blades" : "ignores f_stop, blades, focal_length",
            "/cameras/main"))
            << listing(loaded.problems);
        EXPECT_EQ(loaded.scene.cameras.at(0).lens_radius, 0.0f);
    }
    EXPECT_FALSE(has_problem(load_lens(R"({"f_stop": 2})").problems, Severity::Note, "ignores", ""));
    const LoadedScene own =
        load_lens(R"({"camera": {"type": "orthographic", "position": [0, 0, 5], "look_at": [0, 0, 0],
        "ymag": 2, "lens_radius": 0.1}})");
    EXPECT_TRUE(has_problem(own.problems, Severity::Note, "ignores lens_radius", "/camera")) << listing(own.problems);
}

TEST(RenderJson, CamerasThatAreNotThereOrNamedTwiceAreErrors) {
    const auto expect = [](const std::string& text, const std::string& message, const std::string& pointer) {
        const LoadedScene loaded = load_lens(text);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, message, pointer)) << listing(loaded.problems);
    };
    expect(R"({"cameras": {"mian": {}}})", "no camera 'mian'; did you mean 'main'?", "/cameras/mian");
    expect(R"({"cameras": {"main": {"focus_node": "behind"}}})", "is not in front of the camera 'main'",
           "/cameras/main/focus_node");
    expect(R"({"cameras": {"main": {"f_stop": 2, "lens_radius": 1}}})", "says the same", "/cameras/main/f_stop");
    expect(R"({"cameras": {"main": {"clip_start": 2, "clip_end": 1}}})", "the clipping is from 2 to 1", "");
}

TEST(RenderJson, LensesThatAreSaidTwiceOrBehindAreErrors) {
    const auto expect = [](const std::string& text, const std::string& message, const std::string& pointer) {
        const LoadedScene loaded = load_lens(text);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, message, pointer)) << listing(loaded.problems);
    };
    expect(R"({"f_stop": 2, "lens_radius": 0.1})", "lens_radius says the same", "/f_stop");
    expect(R"({"focus_node": "in focus", "focus_distance": 2})", "focus_distance says the same", "/focus_node");
    expect(R"({"focus_node": "in fokus"})", "no node 'in fokus'; did you mean 'in focus'?", "/focus_node");
    expect(R"({"focus_node": "behind"})", "is not in front of the camera 'main'", "/focus_node");
}

TEST(RenderJson, LightOverrides) {
    const LoadedScene changed = load_with(R"({"lights": {"lamp": {"color": [1, 0, 0], "scale": 3}}})");
    EXPECT_EQ(changed.scene.lights.at(0).color, Rgb(1, 0, 0));
    EXPECT_EQ(changed.scene.lights.at(0).intensity, 30.0f);
    const LoadedScene replaced = load_with(R"({"lights": {"lamp": {"intensity": 2, "scale": 3}}})");
    EXPECT_EQ(replaced.scene.lights.at(0).intensity, 6.0f);
    EXPECT_TRUE(load_with(R"({"lights": {"lamp": {"enabled": false}}})").scene.lights.empty());
}

// Two nodes share the lamp "bulb", and a third node is called as that lamp.
TEST(RenderJson, LightsAreFoundByTheirNodes) {
    GltfBuilder builder;
    builder.add_triangle();
    const nlohmann::json extension = {{"KHR_lights_punctual", {{"light", 0}}}};
    for (const char* name : {"left", "right", "bulb"})
        builder.json["nodes"].push_back({{"name", name}, {"extensions", extension}});
    builder.json["nodes"][3]["extensions"]["KHR_lights_punctual"]["light"] = 1;
    builder.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "bulb"}, {"intensity", 10}},
        {{"type", "point"}, {"name", "other"}, {"intensity", 10}}};
    const auto intensities = [&](const std::string& changes) {
        const TempDir dir;
        builder.write(dir);
        dir.write("render.json", R"({"lights": )" + changes + "}");
        const LoadedScene loaded = inspect_scene(dir.path());
        std::vector<float> found;
        for (const LightDesc& light : loaded.scene.lights) found.push_back(light.intensity);
        if (loaded.problems.has_errors()) ADD_FAILURE() << listing(loaded.problems);
        return found;
    };
    using Floats = std::vector<float>;
    EXPECT_EQ(intensities(R"({"left": {"scale": 2}})"), (Floats{20, 10, 10}));
    EXPECT_EQ(intensities(R"({"bulb": {"scale": 3}})"), (Floats{30, 30, 10})) << "lamps' own names go first";
    EXPECT_EQ(intensities(R"({"bulb": {"intensity": 3}, "left": {"scale": 2}, "right": {"enabled": false}})"),
              (Floats{6, 10}))
        << "what a node is told comes after";
}

/// The light "lamp" of a scene of two such lights, with these changes and the file lamp.ies, whose peak is 200 candela.
LoadedScene load_with_profile(const std::string& changes, const std::string& type = "point") {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["nodes"][0]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    builder.json["nodes"].push_back(builder.json["nodes"][0]);
    builder.json["scenes"][0]["nodes"] = {0, 1};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", type}, {"name", "lamp"}, {"intensity", 10}}};
    const TempDir dir;
    builder.write(dir);
    dir.write("lamp.ies", "IESNA91\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n200 50\n");
    dir.write("broken.ies", "IESNA91\nTILT=NONE\n1 -1 1 2 1 2 2 0 0 0\n1 1 10\n0 90\n0\n200 50\n");
    dir.write("render.json", R"({"lights": {"lamp": )" + changes + "}}");
    return inspect_scene(dir.path());
}

TEST(RenderJson, LightProfiles) {
    const LoadedScene measured = load_with_profile(R"({"ies": "lamp.ies"})");
    EXPECT_FALSE(measured.problems.has_errors()) << listing(measured.problems);
    ASSERT_EQ(measured.scene.ies_profiles.size(), 1u) << "both lights share it";
    EXPECT_EQ(measured.scene.ies_profiles[0].name, "lamp.ies");
    ASSERT_EQ(measured.scene.lights.size(), 2u);
    for (const LightDesc& light : measured.scene.lights) {
        EXPECT_EQ(light.profile.index, 0);
        EXPECT_EQ(light.intensity, 1.0f) << "the file's candela, not the light's";
    }
    EXPECT_EQ(measured.scene.inputs.back().filename(), "lamp.ies");
    EXPECT_EQ(load_with_profile(R"({"ies": "lamp.ies", "scale": 3})").scene.lights.at(1).intensity, 3.0f);
    EXPECT_EQ(load_with_profile(R"({"ies": "lamp.ies", "intensity": 50, "scale": 2})").scene.lights.at(0).intensity,
              0.5f);
}

TEST(RenderJson, BadLightProfilesAreErrorsWithTheirPlace) {
    const auto expect = [](const LoadedScene& loaded, const std::string& message, const std::string& pointer) {
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, message, pointer)) << listing(loaded.problems);
    };
    expect(load_with_profile(R"({"ies": "other.ies"})"), "'other.ies': the file does not exist", "/lights/lamp/ies");
    expect(load_with_profile(R"({"ies": "../lamp.ies"})"), "'..'", "/lights/lamp/ies");
    expect(load_with_profile(R"({"ies": "broken.ies"})"), "line 3: type B photometry is not supported", "");
    expect(load_with_profile(R"({"ies": "lamp.ies"})", "directional"), "a directional light has no position",
           "/lights/lamp/ies");
}

TEST(RenderJson, EnvironmentImagesAreCheckedAndStayInside) {
    EXPECT_TRUE(load_with(R"({"environment": {}})").scene.environment.enabled);
    for (const auto& [image, expected] :
         {std::pair{"sky.hdr", "does not exist"}, std::pair{"../sky.hdr", "'..'"}, std::pair{"/sky.hdr", "absolute"},
          std::pair{"http://x/sky.hdr", "other URIs"}, std::pair{"scene.gltf", "scene.gltf"}}) {
        const LoadedScene loaded = load_with(std::string(R"({"environment": {"image": ")") + image + "\"}}");
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, expected, "/environment/image"))
            << image << "\n"
            << listing(loaded.problems);
    }
}

TEST(RenderJson, EnvironmentImageIsAnInput) {
    GltfBuilder builder;
    builder.add_triangle();
    const TempDir dir;
    builder.write(dir);
    dir.write("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x80\x80\x81"));
    dir.write("render.json", R"({"environment": {"image": "sky.hdr", "scale": 2}})");
    const LoadedScene loaded = inspect_scene(dir.path());
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.environment.image.filename(), "sky.hdr");
    EXPECT_EQ(loaded.scene.inputs.size(), 4u);
}

TEST(RenderJson, CropsGoNoFartherBeyondTheImageThanThatIsLarge) {
    EXPECT_TRUE(has_problem(load_with(R"({"size": [10, 10], "crop": [0, 0, 21, 10]})").problems, Severity::Error,
                            "crop window"));
    EXPECT_FALSE(load_with(R"({"size": [10, 10], "crop": [-10, -1, 20, 10]})").problems.has_errors());
}

}  // namespace
}  // namespace etendue
