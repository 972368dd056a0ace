#include "output/statistics.h"

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

RenderStatistics make_statistics() {
    RenderStatistics s;
    s.scene = "cornell-box";
    s.frame = 7;
    s.time_code = 0.25;
    s.settings_hash = "0123abcd";
    s.settings = R"({"/spp": 8, "/color/exposure": 0.1})";
    s.requested_settings = R"({"/spp": 8})";
    s.command = "etendue render box";
    s.light_units = "radiometric";
    s.width = 64;
    s.height = 32;
    s.full_width = 128;
    s.full_height = 96;
    s.rays = {100, 250, 50};
    s.samples = 80;
    s.spp_requested = 16;
    s.spp_done = 8;
    s.complete = false;
    s.halt_reason = "time limit";
    s.integrator = "bdpt";
    s.relative_error = 0.125;
    s.adaptive = {.least = 8, .mean = 12.5, .most = 16};
    s.load = {0.25, 0.5};
    s.build = {1.0, 1.5};
    s.render = {2.0, 3.75};
    s.write = {0.125, 0.0625};
    s.seconds_before = 0.75;
    s.rays_before = 150;
    s.peak_memory_bytes = 5'000'000'000;
    s.bvh_bytes = 1234;
    s.bvh_build_seconds = 0.5;
    s.triangles = 36;
    s.instances = 1;
    s.lights = 2;
    s.textures = 4;
    s.texture_bytes = 5678;
    s.textures_cached = true;
    s.texture_cache_budget = 9000;
    s.failed_texture_lookups = 6;
    s.missing_textures = 7;
    s.warnings = {"warning: box.gltf#/images/0: it is missing"};
    s.camera = "front";
    s.integrator_choice = "'path', since nothing else is needed";
    s.dropped_samples = 3;
    s.first_dropped = {{1, 2, 3}, {4, 5, 6}};
    s.inputs = {{"textures/sky.exr", 12, 34, "0123"}};
    s.layer_files = {"box.depth.exr"};
    s.strategies_image = {"pyramid.exr", 5, false};
    s.clamp_indirect = 0.5f;
    s.removed_share = 0.25;
    s.robust_buckets = 5;
    s.robust_filled = 4;
    s.robust_removed_share = 0.125;
    s.brightest = {
        {.x = 7,
         .y = 8,
         .sample_x = 1,
         .sample_y = 2,
         .sample = 9,
         .value = {4.0f, 2.0f, 1.0f},
         .is_splat = true,
         .path = "C D S O",
         .s = 3,
         .t = 1,
         .edges = 3},
        {.x = 3, .y = 4, .sample_x = 3, .sample_y = 4, .sample = 5, .value = {1.0f, 1.0f, 0.5f}, .path = ""}};
    s.file_sizes = {{"box.exr", 2800}};
    s.exposure = 1.5f;
    s.exposure_reason = "it was dark";
    s.clipped_share = 0.25;
    s.threads = 2;
    s.isa = "avx2";
    s.instruction_set = "avx2";
    s.libraries = {{"embree", "3.13.5"}, {"oiio", "2.4.7"}};
    return s;
}

TEST(StatisticsJson, HasEveryField) {
    const auto json = nlohmann::json::parse(to_json(make_statistics()));
    const auto expected = nlohmann::json::parse(R"({
        "format": 1, "scene": "cornell-box", "integrator": "bdpt", "integrator_choice": "'path', since nothing else is needed", "camera": "front", "frame": 7, "time_code": 0.25, "settings_hash": "0123abcd",
        "settings": {"/spp": 8, "/color/exposure": 0.1}, "requested_settings": {"/spp": 8},
        "command": "etendue render box",
        "inputs": [{"path": "textures/sky.exr", "size": 12, "modified": 34, "content": "0123"}],
        "layer_files": ["box.depth.exr"],
        "strategies_image": {"file": "pyramid.exr", "longest": 5, "weighted": false},
        "file_sizes": {"box.exr": 2800}, "light_units": "radiometric",
        "exposure": {"stops": 1.5, "chosen": "it was dark", "clipped_share": 0.25}, "size": [64, 32], "full_size": [128, 96],
        "complete": false, "halt_reason": "time limit", "estimated_relative_error": 0.125,
        "spp": {"requested": 16, "done": 8}, "adaptive": {"least": 8, "mean": 12.5, "most": 16},
        "samples": 80, "samples_per_second": 40.0,
        "rays": {"camera": 100, "bounce": 250, "shadow": 50, "light_subpath": 0, "connection": 0,
                 "light_to_camera": 0, "lamp_in_view": 0, "lamp_image": 0, "total": 400}, "rays_per_second": 200.0,
        "seconds": {"load": {"wall": 0.25, "cpu": 0.5}, "build": {"wall": 1.0, "cpu": 1.5},
                    "render": {"wall": 2.0, "cpu": 3.75}, "write": {"wall": 0.125, "cpu": 0.0625}},
        "before": {"seconds": 0.75, "rays": 150},
        "peak_memory_bytes": 5000000000, "bvh_bytes": 1234, "bvh_build_seconds": 0.5,
        "bvh_triangles_per_second": 72.0, "triangles": 36, "instances": 1, "lights": 2,
        "textures": {"count": 4, "held": "cached", "bytes": 5678, "cache_budget_bytes": 9000, "failed_lookups": 6},
        "missing_textures": 7, "warnings": ["warning: box.gltf#/images/0: it is missing"],
        "dropped_samples": {"count": 3, "first": [{"x": 1, "y": 2, "sample": 3}, {"x": 4, "y": 5, "sample": 6}]},
        "clamp_indirect": {"limit": 0.5, "removed_share": 0.25},
        "robust": {"estimate": "mon:5", "least_buckets": 4, "removed_share": 0.125},
        "brightest": [{"pixel": [7, 8], "sample": 9, "value": [4.0, 2.0, 1.0], "sample_pixel": [1, 2],
                       "strategy": [3, 1], "edges": 3, "path": "C D S O"},
                      {"pixel": [3, 4], "sample": 5, "value": [1.0, 1.0, 0.5], "strategy": null, "edges": null,
                       "path": null}],
        "threads": 2, "isa": "avx2", "instruction_set": "avx2", "libraries": {"embree": "3.13.5", "oiio": "2.4.7"}})");
    for (const auto& [key, value] : expected.items()) {
        ASSERT_TRUE(json.contains(key)) << key;
        EXPECT_EQ(json.at(key), value) << key;
    }
    EXPECT_EQ(json.size(), expected.size() + 1) << "all of the above and the software";
    EXPECT_EQ(json.at("software").get<std::string>().substr(0, 8), "Etendue ");
}

TEST(StatisticsJson, BeginsWithItsFormat) {
    EXPECT_TRUE(to_json({}).starts_with("{\n  \"format\": 1,"));
}

/// The keys of `json`, and those of the objects in it that do not have names of the user's.
void add_keys(const nlohmann::json& json, std::set<std::string>& keys) {
    if (json.is_array())
        for (const auto& entry : json) add_keys(entry, keys);
    if (!json.is_object()) return;
    for (const auto& [key, value] : json.items()) {
        keys.insert(key);
        const bool has_names =
            key == "settings" || key == "requested_settings" || key == "file_sizes" || key == "libraries";
        if (!has_names) add_keys(value, keys);
    }
}

TEST(StatisticsJson, ItsPageHasEveryKey) {
    std::ifstream stream(ETENDUE_SOURCE_DIR "/docs/statistics.md");
    const std::string page(std::istreambuf_iterator<char>(stream), {});
    std::set<std::string> keys;
    add_keys(nlohmann::json::parse(to_json(make_statistics())), keys);
    EXPECT_GT(keys.size(), 70u);
    for (const std::string& key : keys) EXPECT_NE(page.find("`" + key + "`"), std::string::npos) << key;
}

TEST(StatisticsJson, EmptyStatisticsHaveNoRatesAndNoHoles) {
    const auto json = nlohmann::json::parse(to_json({}));
    EXPECT_EQ(json.at("rays_per_second"), 0.0);
    EXPECT_EQ(json.at("samples_per_second"), 0.0);
    EXPECT_EQ(json.at("textures").at("held"), "resident");
    EXPECT_TRUE(json.at("dropped_samples").at("first").is_array());
    EXPECT_TRUE(json.at("libraries").is_object());
}

TEST(StatisticsJson, TextFilesEndInANewline) {
    EXPECT_EQ(to_json({}).back(), '\n');
}

TEST(StatisticsJson, BrokenTextIsRepaired) {
    RenderStatistics s;
    s.scene = "caf\xe9 \"x\"\n";
    EXPECT_TRUE(nlohmann::json::accept(to_json(s)));
}

}  // namespace

}  // namespace etendue
