// scenes/render.schema.json and the parser must accept and refuse the same documents.

#include "loader/gltf/gltf_builder.h"
#include "loader/settings/json_schema.h"
#include "loader/settings/render_json.h"

#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

namespace etendue {
namespace {

using Json = nlohmann::json;

std::string read_text(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

const Json& schema() {
    static const Json document = Json::parse(read_text(ETENDUE_SOURCE_DIR "/scenes/render.schema.json"));
    return document;
}

std::string join(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

ProblemList problems_of(const std::string& text) {
    const TempDir dir;
    dir.write("render.json", text);
    ProblemList problems;
    static_cast<void>(read_render_json(dir.path() / "render.json", {}, problems));
    return problems;
}

TEST(SchemaValidator, FindsViolations) {
    const Json object = Json::parse(R"({"type": "object", "additionalProperties": false, "required": ["a"],
                                        "properties": {"a": {"type": "integer", "minimum": 1}}})");
    EXPECT_TRUE(schema_violations(object, {{"a", 1}}).empty());
    EXPECT_EQ(schema_violations(object, {{"a", 0}}).size(), 1u);
    EXPECT_EQ(schema_violations(object, {{"a", 1.5}}).size(), 1u);
    EXPECT_EQ(schema_violations(object, {{"b", 1}}).size(), 2u);
    EXPECT_EQ(schema_violations(object, 3).size(), 1u);
}

TEST(SchemaValidator, RefusesKeywordsItDoesNotKnow) {
    EXPECT_THROW(static_cast<void>(schema_violations({{"patternProperties", Json::object()}}, 1)), std::runtime_error);
    EXPECT_THROW(static_cast<void>(schema_violations({{"type", "tuple"}}, 1)), std::runtime_error);
}

const char* const kGood[] = {
    R"({})",
    R"({"scene": "a.glb"})",
    R"({"variant": "winter", "time_code": -0.5, "animation": "walk"})",
    R"({"time_code": 1, "animation": ["walk", "wave"], "scene_name": "Set", "metadata": {"owner": "Me", "comments": "For Jo."}})",
    R"({"frames": [-3, 9999], "fps": 23.976})",
    R"({"frames": [1, 48, 2]})",
    R"({"shutter": [-0.01, 0.01]})",
    R"({"integrator": {}})",
    R"({"integrator": {"type": "direct", "max_depth": 1, "min_depth": 1, "roulette_depth": 2147483647}})",
    R"({"integrator": {"type": "bdpt", "heuristic": "balance", "strategy": "0,2", "weighted": false, "connections": "cache:999"}})",
    R"({"integrator": {"type": "bdpt", "connections": "pairwise"}})",
    R"({"integrator": {"type": "vcm", "merge": "sds", "lamp_images": false, "aimed_emission": false, "merge_radius": 1.5, "merge_alpha": 0.75}})",
    R"({"integrator": {"type": "vcm", "merge": "all", "lamp_images": false, "merge_radius": 100, "merge_alpha": 1}})",
    R"({"integrator": {"light_samples": 64}})",
    R"({"sampler": "sobol"})",
    R"({"sampler": "random", "spp": 16777216, "seed": 4294967295, "time": 0.5, "error": 0.01})",
    R"({"error": 0.01, "adaptive": false, "min_spp": 16777216})",
    R"({"clamp_indirect": 2.5, "robust": "mon:31", "brightest": 1024})",
    R"({"clamp_indirect": 0, "robust": "mean", "brightest": 0})",
    R"({"spp": 16.0})",
    R"({"aovs": [], "aov_layout": "parts"})",
    R"({"aovs": ["depth", "N:half", "caustics=lpe:C D S+ L:float", "key-2=light:key*"], "aov_layout": "layers"})",
    R"({"texture_memory": "8G"})",
    R"({"accelerator": "kdtree", "cull_backfaces": true})",
    R"({"studio": true, "ground": false})",
    R"({"mist": {"start": 0, "depth": 0.5, "falloff": "linear"}})",
    R"({"texture_memory": "000512M"})",
    R"({"size": [1, 65536], "crop": [0, 0, 1, 1]})",
    R"({"camera": "main", "lens_radius": 0, "focus_distance": 3})",
    R"({"camera_place": [0, 1.5, 5, 0, 0, 0]})",
    R"({"camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]}})",
    R"({"camera": {"name": "n", "type": "orthographic", "position": [1, 2, 3], "look_at": [0, 0, 0], "up": [0, 0, 1],
                   "ymag": 2, "yfov": 3.14, "lens_radius": 0.1, "focus_distance": 0.5}})",
    R"({"film": {"filter": "blackman-harris", "filter_radius": 8}})",
    R"({"film": {"filter": "box"}})",
    R"({"film": {"filter": "gaussian"}})",
    R"({"film": {"filter": "mitchell"}})",
    R"({"environment": {}})",
    R"({"environment": {"image": "sky.hdr", "color": [0, 1, 200], "scale": 0, "rotation": -7, "visible_to_camera": false}})",
    R"({"color": {"working_space": "ACEScg", "display": "sRGB", "view": "ACES SDR", "exposure": -1.5}})",
    R"({"color": {"look": "a, -b", "output_space": "ACES2065-1", "aces_container": true}})",
    R"({"materials": {}, "lights": {}})",
    R"({"materials": {"a": {"conductor": {}}, "b": {"conductor": {"metal": "Au", "roughness": 1}}}})",
    R"({"materials": {"a": {"dielectric": {"ior": 3, "roughness": 0}}, "b": {"diffuse": {"albedo": [0, 0.5, 1]}}}})",
    R"({"materials": {"a": {"dielectric": {"attenuation_color": [1, 0, 0.5], "attenuation_distance": 0.1}}}})",
    R"({"materials": {"a": {"dielectric": {"dispersion": 2, "multiscatter_color": [1, 0, 0.5],
        "scatter_anisotropy": -0.5}, "priority": -3}, "b": {"priority": 2}}})",
    R"({"materials": {"a": {"subsurface": {}}, "b": {"subsurface": {"albedo": [1, 0, 0.5], "radius": [1, 2, 0.5],
        "anisotropy": 0.9, "ior": 1, "roughness": 1}}, "c": {"diffuse": {"roughness": 1}}}})",
    R"({"materials": {"a": {"emission": {"color": [0, 5, 1], "strength": 100}}, "b": {"diffuse": {}, "emission": {}}}})",
    R"({"lights": {"a": {"color": [1, 2, 3], "intensity": 0, "scale": 2, "enabled": false}, "b": {"ies": "x.ies"}}})",
    R"({"lights": {"a": {"type": "rectangle", "width": 2, "height": 1, "power": 5, "spread": 3.141592653589793},
        "b": {"type": "disk", "node": "n", "radius": 1, "radiance": 2, "visible_to_camera": false, "stops_light": true},
        "c": {"type": "disk", "width": 1, "height": 2, "power": 1, "position": [0, 1, 2], "rotation": [0, 0, 0, 1]},
        "d": {"type": "sphere", "power": 1, "position": [0, 1, 2]}, "e": {"type": "sun", "irradiance": 3, "angle": 0.1},
        "f": {"type": "point", "power": 1, "radius": 0.1, "position": [0, 1, 2], "look_at": [0, 0, 0], "up": [0, 0, 1]},
        "g": {"type": "spot", "intensity": 1, "inner_cone_angle": 0.5, "outer_cone_angle": 1.5707963267948966},
        "h": {"type": "point", "ies": "x.ies"}, "i": {"radius": 1, "visible_to_camera": false, "power": 2},
        "j": {"angle": 0.1, "irradiance": 2}}})",
    R"({"materials": {"a": {"shadow_catcher": true}, "b": {"diffuse": {}, "shadow_catcher": false}}})",
    R"({"cameras": {"a": {"yfov": 1}, "b": {"type": "orthographic", "ymag": 2}}})",
    R"({"materials": {"a": {"holdout": true, "shadow_catcher": false}, "b": {"roughness": 0.1, "holdout": false}}})",
    R"({"shapes": {}})",
    R"({"shapes": {"a": {"type": "sphere", "radius": 1, "material": "m", "node": "n"}, "b": {"type": "disk", "radius":
        0.1, "position": [0, 1, 2], "rotation": [0, 0, 0, 1]}, "c": {"type": "rectangle", "width": 2, "height": 3,
        "position": [0, 1, 2], "look_at": [0, 0, 0], "up": [0, 0, 1]}, "d": {"type": "cylinder", "radius": 1, "height":
        2}}})",
    R"({"materials": {"a": {"visible_to_camera": false}, "b": {"diffuse": {}, "visible_to_camera": true}}})",
    R"({"materials": {"a": {"base_color": [0.5, 1, 0], "metallic": 0, "roughness": 0, "normal_scale": 1, "emissive":
        [0.5, 1, 0], "emissive_strength": 0, "alpha_cutoff": 0, "ior": 1, "specular": 0, "specular_color": [0.5, 1,
        0], "transmission": 0, "diffuse_transmission": 0, "diffuse_transmission_color": [0.5, 1, 0],
        "diffuse_roughness": 0, "attenuation_color": [0.5, 1, 0], "attenuation_distance": 1, "dispersion": 0,
        "multiscatter_color": [0.5, 1, 0], "scatter_anisotropy": 0.5, "anisotropy_strength": 0, "anisotropy_rotation":
        1, "iridescence": 0, "iridescence_ior": 1, "iridescence_thickness_minimum": 0,
        "iridescence_thickness_maximum": 0, "sheen_color": [0.5, 1, 0], "sheen_roughness": 0, "clearcoat": 0,
        "clearcoat_roughness": 0, "solid": true, "priority": 1}, "b": {"diffuse": {}, "emissive_strength": 2}}})",
    R"({"f_stop": 2.8, "focal_length": 50, "sensor_width": 36, "focus_node": "a"})",
    R"({"cameras": {"a": {"shift": [0.1, -2], "clip": true, "clip_start": 0, "clip_end": 5, "blades": 6, "blade_rotation":
        -1, "aperture_ratio": 2, "f_stop": 2, "focal_length": 50, "sensor_width": 24, "focus_node": "b"}, "b":
        {"lens_radius": 0, "focus_distance": 1, "blades": 0, "clip": false}, "c": {}}})",
    R"({"camera": {"position": [0, 0, 5], "look_at": [0, 0, 0], "shift": [0, 1], "clip_start": 1, "clip_end": 2, "blades":
        64, "blade_rotation": 1, "aperture_ratio": 0.5}})",
    R"({"film": {"pixel_aspect": 2}})",
    R"({"film": {"overscan": 16}, "crop": [-8, -65536, 131072, 4]})",
    R"({"film": {"overscan": 0.05}})",
    R"({"cameras": {"a": {"type": "fisheye", "fov": 6.283185307179586, "mapping": "equisolid"}, "b": {"type":
        "equirectangular"}, "c": {"type": "perspective", "mapping": "equidistant"}, "d": {"type": "orthographic"}}})",
    R"({"camera": {"position": [0, 0, 5], "look_at": [0, 0, 0], "type": "fisheye", "fov": 3}})",
    R"({"missing_textures": "warn"})",
    R"({"missing_textures": "error"})",
    R"({"light_units": "photometric"})",
    R"({"light_units": "radiometric"})",
};

const char* const kBad[] = {
    R"([])",
    R"(3)",
    R"(null)",
    R"({"unknown": 1})",
    R"({"scene": 1})",
    R"({"scene": ""})",
    R"({"shapes": []})",
    R"({"shapes": {"a": {}}})",
    R"({"shapes": {"a": {"radius": 1}}})",
    R"({"shapes": {"a": {"type": "cone"}}})",
    R"({"shapes": {"a": {"type": "sphere", "radius": 0}}})",
    R"({"shapes": {"a": {"type": "rectangle", "width": -1}}})",
    R"({"shapes": {"a": {"type": "cylinder", "height": "1"}}})",
    R"({"shapes": {"a": {"type": "disk", "material": ""}}})",
    R"({"shapes": {"a": {"type": "disk", "position": [0, 1]}}})",
    R"({"shapes": {"a": {"type": "disk", "color": [0, 1, 1]}}})",
    R"({"frames": [1]})",
    R"({"frames": [1, 2, 3, 4]})",
    R"({"frames": "1:2"})",
    R"({"frames": [1, 2.5]})",
    R"({"shutter": 0.01})",
    R"({"shutter": [0, "1"]})",
    R"({"integrator": "path"})",
    R"({"integrator": {"type": 1}})",
    R"({"integrator": {"depth": 1}})",
    R"({"integrator": {"min_depth": 1.5}})",
    R"({"integrator": {"strategy": "2"}})",
    R"({"integrator": {"strategy": [2, 3]}})",
    R"({"integrator": {"weighted": 0}})",
    R"({"integrator": {"connections": 2}})",
    R"({"integrator": {"merge": "some"}})",
    R"({"integrator": {"lamp_images": false, "merge_radius": 0}})",
    R"({"integrator": {"merge_alpha": 1.5}})",
    R"({"integrator": {"roulette_depth": "5"}})",
    R"({"sampler": 3})",
    R"({"missing_textures": false})",
    R"({"light_units": 683})",
    R"({"lights": {"a": {"ies": ""}}})",
    R"({"lights": {"a": {"ies": 1}}})",
    R"({"color": {"look": ["a"]}})",
    R"({"color": {"aces_container": "yes"}})",
    R"({"spp": true})",
    R"({"spp": null})",
    R"({"adaptive": 1})",
    R"({"aovs": "depth"})",
    R"({"aovs": [1]})",
    R"({"aovs": [""]})",
    R"({"aovs": ["N="]})",
    R"({"aovs": ["a.b=depth"]})",
    R"({"texture_memory": 8})",
    R"({"texture_memory": "8g"})",
    R"({"texture_memory": "8K"})",
    R"({"size": 3})",
    R"({"size": [3]})",
    R"({"size": [3, 3, 3]})",
    R"({"size": {"0": 3}})",
    R"({"crop": [0, 0, 1]})",
    R"({"crop": [0, 0, 1.5, 1]})",
    R"({"camera": 3})",
    R"({"camera_place": [0, 0, 5]})",
    R"({"camera": ""})",
    R"({"camera": []})",
    R"({"camera": {}})",
    R"({"camera": {"position": [0, 0, 1]}})",
    R"({"camera": {"look_at": [0, 0, 1]}})",
    R"({"camera": {"position": [0, 0], "look_at": [0, 0, 0]}})",
    R"({"camera": {"position": [0, 0, "1"], "look_at": [0, 0, 0]}})",
    R"({"camera": {"position": [0, 0, 1], "look_at": [0, 0, 0], "yfov": 0}})",
    R"({"camera": {"position": [0, 0, 1], "look_at": [0, 0, 0], "yfov": 3.2}})",
    R"({"camera": {"position": [0, 0, 1], "look_at": [0, 0, 0], "ymag": 0}})",
    R"({"camera": {"position": [0, 0, 1], "look_at": [0, 0, 0], "type": "fish"}})",
    R"({"camera": {"position": [0, 0, 1], "look_at": [0, 0, 0], "fov": 0}})",
    R"({"cameras": {"a": {"type": "panorama"}}})",
    R"({"cameras": {"a": {"fov": 6.3}}})",
    R"({"cameras": {"a": {"mapping": "stereographic"}}})",
    R"({"film": {"overscan": -1}})",
    R"({"camera": {"position": [0, 0, 1], "look_at": [0, 0, 0], "lens_radius": -1}})",
    R"({"camera": {"position": [0, 0, 1], "look_at": [0, 0, 0], "focus_distance": 0}})",
    R"({"lens_radius": -0.1})",
    R"({"focus_distance": 0})",
    R"({"film": {"radius": 1}})",
    R"({"environment": true})",
    R"({"environment": {"image": 1}})",
    R"({"environment": {"color": [1, 1]}})",
    R"({"environment": {"color": [1, 1, -1]}})",
    R"({"environment": {"color": 1}})",
    R"({"environment": {"scale": -1}})",
    R"({"environment": {"rotation": "90"}})",
    R"({"environment": {"visible_to_camera": 1}})",
    R"({"environment": {"visible": true}})",
    R"({"color": {"exposure": "1"}})",
    R"({"color": {"gamma": 2.2}})",
    R"({"materials": []})",
    R"({"materials": {"a": 1}})",
    R"({"materials": {"a": {}}})",
    R"({"materials": {"a": {"glass": {}}}})",
    R"({"materials": {"a": {"roughness": 1.5}}})",
    R"({"materials": {"a": {"sheen_color": 1}}})",
    R"({"materials": {"a": {"solid": 1}}})",
    R"({"f_stop": 0})",
    R"({"focal_length": -35})",
    R"({"focus_node": ""})",
    R"({"cameras": []})",
    R"({"cameras": {"a": 1}})",
    R"({"cameras": {"a": {"shift": 0.1}}})",
    R"({"cameras": {"a": {"shift": [0.1]}}})",
    R"({"cameras": {"a": {"clip": 1}}})",
    R"({"cameras": {"a": {"clip_start": -1}}})",
    R"({"cameras": {"a": {"clip_end": 0}}})",
    R"({"cameras": {"a": {"blades": 2}}})",
    R"({"cameras": {"a": {"blades": 65}}})",
    R"({"cameras": {"a": {"aperture_ratio": 0}}})",
    R"({"camera": {"position": [0, 0, 1], "look_at": [0, 0, 0], "clip": true}})",
    R"({"film": {"pixel_aspect": 0}})",
    R"({"materials": {"a": {"conductor": {}, "diffuse": {}}}})",
    R"({"materials": {"a": {"conductor": {}, "dielectric": {}, "emission": {}}}})",
    R"({"materials": {"a": {"conductor": {"metal": "Pb"}}}})",
    R"({"materials": {"a": {"conductor": {"roughness": 1.1}}}})",
    R"({"materials": {"a": {"subsurface": {}, "diffuse": {}}}})",
    R"({"materials": {"a": {"subsurface": {"radius": [1, 0, 1]}}}})",
    R"({"materials": {"a": {"subsurface": {"anisotropy": 1}}}})",
    R"({"materials": {"a": {"subsurface": {"ior": 0.9}}}})",
    R"({"materials": {"a": {"diffuse": {"roughness": 2}}}})",
    R"({"materials": {"a": {"priority": 0.5}}})",
    R"({"materials": {"a": {"dielectric": {"attenuation_distance": 0}}}})",
    R"({"materials": {"a": {"dielectric": {"attenuation_color": [0, 2, 0]}}}})",
    R"({"materials": {"a": {"dielectric": {"dispersion": -1}}}})",
    R"({"materials": {"a": {"dielectric": {"multiscatter_color": 1}}}})",
    R"({"materials": {"a": {"dielectric": {"scatter_anisotropy": -1}}}})",
    R"({"materials": {"a": {"dielectric": {"ior": 0.9}}}})",
    R"({"materials": {"a": {"dielectric": {"ior": 3.5}}}})",
    R"({"materials": {"a": {"diffuse": {"albedo": [0, 0, 1.5]}}}})",
    R"({"materials": {"a": {"emission": {"strength": -1}}}})",
    R"({"materials": {"a": {"emission": {"power": 1}}}})",
    R"({"lights": {"a": {"intensity": -1}}})",
    R"({"lights": {"a": {"enabled": "no"}}})",
    R"({"lights": {"a": {"radius": -1}}})",
    R"({"lights": {"a": {"type": "cone", "power": 1}}})",
    R"({"lights": {"a": {"type": "rectangle", "power": 1, "width": 0}}})",
    R"({"lights": {"a": {"type": "rectangle", "power": 1, "spread": 0.01}}})",
    R"({"lights": {"a": {"type": "sun", "irradiance": 1, "angle": 3.2}}})",
    R"({"lights": {"a": {"type": "point", "power": 1, "rotation": [0, 0, 1]}}})",
    R"({"lights": {"a": {"visible_to_camera": 1}}})",
    R"({"lights": {"a": {"stops_light": 1}}})",
    R"({"materials": {"a": {"visible_to_camera": 0}}})",
    R"({"materials": {"a": {"shadow_catcher": 1}}})",
    R"({"materials": {"a": {"holdout": "yes"}}})",
    R"({"cameras": {"a": {"yfov": 4}}})",
    R"({"cameras": {"a": {"yfov": 1, "focal_length": 50}}})",
    R"({"materials": {"a": {"holdout": true, "shadow_catcher": true}}})",
    R"({"studio": 1})",
    R"({"ground": "no"})",
    R"({"lights": 3})",
};

TEST(RenderSchema, AcceptsWhatTheParserAccepts) {
    for (const char* text : kGood) {
        const std::vector<std::string> violations = schema_violations(schema(), Json::parse(text));
        EXPECT_TRUE(violations.empty()) << text << "\n" << join(violations);
        const ProblemList problems = problems_of(text);
        EXPECT_TRUE(problems.all().empty()) << text << "\n" << listing(problems);
    }
}

TEST(RenderSchema, RefusesWhatTheParserRefuses) {
    for (const char* text : kBad) {
        EXPECT_FALSE(schema_violations(schema(), Json::parse(text)).empty()) << text;
        EXPECT_TRUE(problems_of(text).has_errors()) << text;
    }
}

/// All keys of all objects in a document, and, for a schema, of all objects it describes.
void collect_property_names(const Json& schema_part, std::set<std::string>& names) {
    if (!schema_part.is_object() && !schema_part.is_array()) return;
    for (const auto& [key, value] : schema_part.items()) {
        if (key == "properties") {
            for (const auto& [name, unused] : value.items()) names.insert(name);
        }
        collect_property_names(value, names);
    }
}

void collect_keys(const Json& document, std::set<std::string>& names) {
    if (document.is_object()) {
        for (const auto& [key, value] : document.items()) names.insert(key);
    }
    if (document.is_structured()) {
        for (const Json& value : document) collect_keys(value, names);
    }
}

// What a schema could only say at length.
TEST(RenderSchema, TheParserRefusesWhatContradictsItself) {
    const char* const lights[] = {
        R"({"type": "disk"})",
        R"({"type": "sun"})",
        R"({"type": "point"})",
        R"({"type": "disk", "power": 1, "radiance": 1})",
        R"({"type": "sun", "power": 1})",
        R"({"type": "sphere", "power": 1, "width": 1})",
        R"({"type": "sphere", "power": 1, "radius": 0})",
        R"({"type": "disk", "power": 1, "width": 1})",
        R"({"type": "disk", "power": 1, "width": 1, "height": 1, "radius": 1})",
        R"({"type": "rectangle", "power": 1, "node": "a", "position": [0, 0, 0]})",
        R"({"type": "rectangle", "power": 1, "look_at": [0, 0, 0]})",
        R"({"type": "rectangle", "power": 1, "position": [0, 0, 0], "look_at": [0, 0, 0]})",
        R"({"type": "rectangle", "power": 1, "position": [0, 0, 0], "look_at": [0, 1, 0], "up": [0, 2, 0]})",
        R"({"type": "rectangle", "power": 1, "position": [0, 0, 0], "rotation": [0, 0, 0, 0]})",
        R"({"type": "rectangle", "power": 1, "position": [0, 0, 0], "rotation": [0, 0, 0, 1], "look_at": [0, 1, 0]})",
        R"({"type": "spot", "power": 1, "inner_cone_angle": 1, "outer_cone_angle": 0.5})",
        R"({"type": "point", "power": 1, "visible_to_camera": false})",
        R"({"type": "point", "ies": "x.ies", "radius": 1})",
        R"({"type": "point", "ies": "x.ies", "power": 1})",
        R"({"node": "a"})",
        R"({"radiance": 1})",
        R"({"intensity": 1, "power": 1})",
    };
    for (const std::string light : lights)
        EXPECT_TRUE(problems_of(R"({"lights": {"a": )" + light + "}}").has_errors()) << light;
}

TEST(RenderSchema, EveryKeyIsInAGoodDocument) {
    std::set<std::string> described;
    collect_property_names(schema(), described);
    std::set<std::string> tested;
    for (const char* text : kGood) collect_keys(Json::parse(text), tested);
    for (const std::string& name : described) EXPECT_TRUE(tested.contains(name)) << name;
}

TEST(RenderSchema, EveryKeyIsInTheDocumentation) {
    const std::string documentation = read_text(ETENDUE_SOURCE_DIR "/docs/render-json.md");
    std::set<std::string> described;
    collect_property_names(schema(), described);
    for (const std::string& name : described) EXPECT_NE(documentation.find(name), std::string::npos) << name;
}

TEST(RenderSchema, EveryPropertyIsDescribed) {
    for (const auto& [name, property] : schema()["properties"].items()) {
        EXPECT_TRUE(property.contains("description")) << name;
    }
}

TEST(RenderSchema, EverySceneOfTheTreeFollowsIt) {
    std::size_t found = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(ETENDUE_SOURCE_DIR "/scenes/")) {
        if (entry.path().filename() != "render.json") continue;
        ++found;
        const std::string text = read_text(entry.path());
        const std::vector<std::string> violations = schema_violations(schema(), Json::parse(text));
        EXPECT_TRUE(violations.empty()) << entry.path() << "\n" << join(violations);
        const ProblemList problems = problems_of(text);
        EXPECT_TRUE(problems.all().empty()) << entry.path() << "\n" << listing(problems);
    }
    if (found == 0) GTEST_SKIP() << "no render.json in scenes/";
}

}  // namespace
}  // namespace etendue
