#include "output/statistics.h"

#include "output/input_file_json.h"
#include "output/software_name.h"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::ordered_json;

double per_second(std::uint64_t count, double seconds) {
    return seconds > 0.0 ? static_cast<double>(count) / seconds : 0.0;
}

Json parsed_or_null(const std::string& text) {
    Json json = Json::parse(text, nullptr, false);
    return json.is_discarded() ? Json() : json;
}

Json to_object(const PhaseTime& time) {
    return {{"wall", time.wall}, {"cpu", time.cpu}};
}

Json to_object(const std::vector<DroppedSample>& samples) {
    Json list = Json::array();
    for (const DroppedSample& s : samples) list.push_back({{"x", s.x}, {"y", s.y}, {"sample", s.sample}});
    return list;
}

Json to_object(const std::vector<BrightContribution>& brightest) {
    Json list = Json::array();
    for (const BrightContribution& c : brightest) {
        Json json{{"pixel", {c.x, c.y}}, {"sample", c.sample}, {"value", c.value}};
        // A splat's sample is of the pixel whose light path it was.
        if (c.is_splat) json["sample_pixel"] = {c.sample_x, c.sample_y};
        json["strategy"] = c.path.empty() ? Json() : Json{c.s, c.t};
        json["edges"] = c.path.empty() ? Json() : Json(c.edges);
        json["path"] = c.path.empty() ? Json() : Json(c.path);
        list.push_back(std::move(json));
    }
    return list;
}

}  // namespace

std::string to_json(const RenderStatistics& s) {
    Json json;
    json["format"] = 1;  // docs/statistics.md says what that promises
    json["software"] = software_name();
    json["instruction_set"] = s.instruction_set;
    json["scene"] = s.scene;
    json["integrator"] = s.integrator;
    json["integrator_choice"] = s.integrator_choice.empty() ? Json() : Json(s.integrator_choice);
    json["camera"] = s.camera.empty() ? Json() : Json(s.camera);
    json["frame"] = s.frame ? Json(*s.frame) : Json();
    json["time_code"] = s.time_code ? Json(*s.time_code) : Json();
    json["command"] = s.command.empty() ? Json() : Json(s.command);
    json["settings"] = parsed_or_null(s.settings);
    json["requested_settings"] = parsed_or_null(s.requested_settings);
    json["settings_hash"] = s.settings_hash;
    json["inputs"] = s.inputs;
    json["layer_files"] = s.layer_files;
    json["strategies_image"] = s.strategies_image ? Json{{"file", s.strategies_image->file},
                                                         {"longest", s.strategies_image->longest},
                                                         {"weighted", s.strategies_image->weighted}}
                                                  : Json();
    json["file_sizes"] = s.file_sizes;
    json["light_units"] = s.light_units;
    json["exposure"] = {{"stops", s.exposure ? Json(*s.exposure) : Json()},
                        {"chosen", s.exposure_reason.empty() ? Json() : Json(s.exposure_reason)},
                        {"clipped_share", s.clipped_share ? Json(*s.clipped_share) : Json()}};
    json["size"] = {s.width, s.height};
    json["full_size"] = {s.full_width, s.full_height};
    json["complete"] = s.complete;
    json["halt_reason"] = s.halt_reason;
    json["estimated_relative_error"] = s.relative_error ? Json(*s.relative_error) : Json();
    json["spp"] = {{"requested", s.spp_requested}, {"done", s.spp_done}};
    json["adaptive"] = s.adaptive
                           ? Json{{"least", s.adaptive->least}, {"mean", s.adaptive->mean}, {"most", s.adaptive->most}}
                           : Json();
    json["samples"] = s.samples;
    json["samples_per_second"] = per_second(s.samples, s.render.wall);
    json["rays"] = {{"camera", s.rays.camera},
                    {"bounce", s.rays.bounce},
                    {"shadow", s.rays.shadow},
                    {"light_subpath", s.rays.light_subpath},
                    {"connection", s.rays.connection},
                    {"light_to_camera", s.rays.light_to_camera},
                    {"lamp_in_view", s.rays.lamp_in_view},
                    {"lamp_image", s.rays.lamp_image},
                    {"total", s.rays.total()}};
    json["rays_per_second"] = per_second(s.rays.total(), s.render.wall);
    json["seconds"] = {{"load", to_object(s.load)},
                       {"build", to_object(s.build)},
                       {"render", to_object(s.render)},
                       {"write", to_object(s.write)}};
    json["before"] = {{"seconds", s.seconds_before}, {"rays", s.rays_before}};
    json["peak_memory_bytes"] = s.peak_memory_bytes;
    json["bvh_bytes"] = s.bvh_bytes;
    json["bvh_build_seconds"] = s.bvh_build_seconds;
    json["bvh_triangles_per_second"] = per_second(s.triangles, s.bvh_build_seconds);
    json["triangles"] = s.triangles;
    json["instances"] = s.instances;
    json["lights"] = s.lights;
    json["textures"] = {{"count", s.textures},
                        {"held", s.textures_cached ? "cached" : "resident"},
                        {"bytes", s.texture_bytes},
                        {"cache_budget_bytes", s.texture_cache_budget},
                        {"failed_lookups", s.failed_texture_lookups}};
    json["missing_textures"] = s.missing_textures;
    json["warnings"] = s.warnings;
    json["dropped_samples"] = {{"count", s.dropped_samples}, {"first", to_object(s.first_dropped)}};
    json["clamp_indirect"] =
        s.clamp_indirect > 0.0f
            ? Json{{"limit", s.clamp_indirect}, {"removed_share", s.removed_share ? Json(*s.removed_share) : Json()}}
            : Json();
    json["robust"] = s.robust_buckets > 0
                         ? Json{{"estimate", "mon:" + std::to_string(s.robust_buckets)},
                                {"least_buckets", s.robust_filled},
                                {"removed_share", s.robust_removed_share ? Json(*s.robust_removed_share) : Json()}}
                         : Json();
    json["brightest"] = to_object(s.brightest);
    json["threads"] = s.threads;
    json["isa"] = s.isa;
    json["libraries"] = s.libraries;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace etendue
