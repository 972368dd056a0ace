#include "report/accelerator_json.h"
#include "report/json_values.h"
#include "report/profile_advice.h"
#include "report/profile_figures.h"
#include "report/profile_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

/// Writes numbers that are not finite as null.
using Json = nlohmann::ordered_json;

constexpr std::size_t kExpensiveTiles = 10;

std::string text_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool fits_a_line(const Json& json) {
    return std::none_of(json.begin(), json.end(), [](const Json& member) { return member.is_structured(); });
}

/// Appends `json` to `text`, with each part that has no parts of its own on one line: a run has thousands of tiles of
/// eight numbers each.
void write(std::string& text, const Json& json, std::size_t indent) {
    if (!json.is_structured() || fits_a_line(json)) {
        text += text_of(json);
        return;
    }
    text += json.is_object() ? '{' : '[';
    const char* separator = "\n";
    for (const auto& member : json.items()) {
        text += separator + std::string(indent + 1, ' ');
        if (json.is_object()) text += text_of(member.key()) + ": ";
        write(text, member.value(), indent + 1);
        separator = ",\n";
    }
    text += '\n' + std::string(indent, ' ');
    text += json.is_object() ? '}' : ']';
}

Json to_object(const RayKindReport& kind);
Json to_object(const TileReport& tile);
Json to_object(const TileCost& tile);
Json to_object(const LampReport& lamp);
Json to_object(const HitsReport& met);
Json to_object(const EarlierRun& run);
Json to_object(const EarlierProfile& profile);
Json to_object(const LongPathReport& path);
Json to_object(const ProfileRun& run);
Json to_object(const ComparedFigure& figure);
Json to_object(const ComparedRun& run);

template <typename Value>
Json array_of(const std::vector<Value>& values) {
    Json json = Json::array();
    for (const Value& value : values) json.push_back(to_object(value));
    return json;
}

Json named(const std::vector<NamedValue>& values, const char* unit) {
    Json json = Json::array();
    for (const NamedValue& value : values) json.push_back({{"name", value.name}, {unit, value.value}});
    return json;
}

/// Lists names and whole numbers, as `named` does for numbers of any kind.
Json counted(const std::vector<NamedValue>& values, const char* unit) {
    Json json = named(values, unit);
    for (Json& value : json)
        if (value[unit] >= 0.0 && value[unit] < 1e18)
            value[unit] = static_cast<std::uint64_t>(value[unit].get<double>());
    return json;
}

Json to_object(const RayKindReport& kind) {
    return {{"kind", kind.kind},           {"rays", kind.rays},
            {"seconds", kind.seconds},     {"rays_per_second", rays_per_second(kind)},
            {"hit_share", kind.hit_share}, {"recorded", kind.recorded},
            {"single", kind.single},       {"packet8", kind.packet8},
            {"packet16", kind.packet16},   {"packet_fill", kind.packet_fill}};
}

/// [x0, y0, x1, y1, thread, first sample, start, end, CPU seconds, samples]
Json to_object(const TileReport& tile) {
    return {tile.rect.x0,      tile.rect.y0, tile.rect.x1, tile.rect.y1,     tile.thread,
            tile.first_sample, tile.start,   tile.end,     tile.cpu_seconds, tile.samples};
}

Json to_object(const TileCost& tile) {
    return {{"rect", window(tile.rect)},
            {"cpu_seconds", tile.cpu_seconds},
            {"cpu_seconds_per_sample", tile.cpu_seconds_per_sample},
            {"share", tile.share}};
}

Json to_object(const LampReport& lamp) {
    return {{"name", lamp.name},
            {"shadow_rays", std::round(lamp.shadow_rays)},
            {"blocked", std::round(lamp.blocked)},
            {"seconds", lamp.seconds}};
}

Json to_object(const HitsReport& met) {
    return {{"name", met.name}, {"hits", std::round(met.hits)}, {"seconds", met.seconds}};
}

Json to_object(const EarlierRun& run) {
    return {{"integrator", run.integrator},
            {"threads", run.threads},
            {"cpu_seconds_per_sample", run.cpu_seconds_per_sample}};
}

Json to_object(const EarlierProfile& profile) {
    return {{"file", profile.file},
            {"created", profile.created},
            {"program", profile.program},
            {"runs", array_of(profile.runs)}};
}

Json to_object(const SceneHitsReport& hits) {
    return {{"materials", array_of(hits.materials)},
            {"objects", array_of(hits.objects)},
            {"textures", array_of(hits.textures)},
            {"lamps", array_of(hits.lamps)}};
}

Json to_object(const LongPathReport& path) {
    return {{"x", path.x}, {"y", path.y}, {"sample", path.sample}, {"vertices", path.vertices}};
}

Json to_object(const ProfileRun& run) {
    return {{"integrator", run.integrator},
            {"threads", run.threads},
            {"spp", run.spp},
            {"seconds", run.seconds},
            {"cpu_seconds", run.cpu_seconds},
            {"cpu_seconds_per_sample", cpu_seconds_per_sample(run)},
            {"instrumented_seconds", run.instrumented_seconds},
            {"instrumented_cpu_seconds", run.instrumented_cpu_seconds},
            {"samples", run.samples},
            {"samples_per_second", samples_per_second(run)},
            {"rays", run.rays},
            {"rays_per_second", rays_per_second(run)},
            {"efficiency_single", run.efficiency_single},
            {"efficiency_best", run.efficiency_best},
            {"parallel_efficiency", run.parallel_efficiency},
            {"load_imbalance", run.load_imbalance},
            {"tracing_share", tracing_share(run)},
            {"timing_share", run.timing_share},
            {"kinds", array_of(run.kinds)},
            {"stages", named(run.stages, "seconds")},
            {"costs", costs(run)},
            {"advice", advice(run)},
            {"scene_hits", to_object(run.scene_hits)},
            {"endings", counted(run.eye_paths.endings, "paths")},
            {"path_lengths", run.eye_paths.lengths},
            {"light_endings", counted(run.light_paths.endings, "paths")},
            {"light_path_lengths", run.light_paths.lengths},
            {"longest", array_of(run.longest)},
            {"shadow_unoccluded", run.shadow_unoccluded},
            {"light_sampling_used", run.light_sampling_used},
            {"bsdf_met_light", run.bsdf_met_light},
            {"bsdf_absorbed", run.bsdf_absorbed},
            {"hardware",
             {{"counters", counted(run.hardware.values, "count")}, {"unavailable", known(run.hardware.unavailable)}}},
            {"heat_map",
             {{"file", known(run.heat_map)}, {"key", heat_map_key(run)}, {"cpu_seconds_high", run.heat_map_high}}},
            {"expensive_tiles", array_of(most_expensive_tiles(run, kExpensiveTiles))},
            {"tiles", array_of(run.tiles)}};
}

Json to_object(const ComparedFigure& figure) {
    return {{"name", figure.name},
            {"unit", figure.unit},
            {"before", figure.before},
            {"now", figure.now},
            {"ratio", rate(figure.now, figure.before)}};
}

Json to_object(const ComparedRun& run) {
    return {{"integrator", run.integrator},
            {"threads", run.threads},
            {"verdict", verdict_name(run.verdict)},
            {"ratio", run.ratio},
            {"low", run.low},
            {"high", run.high},
            {"cpu_seconds_per_sample", {{"before", run.before}, {"now", run.now}}},
            {"repetitions", {{"before", run.repetitions_before}, {"now", run.repetitions_now}}},
            {"rays_per_second", array_of(run.rays_per_second)}};
}

Json to_object(const ProfileComparison& comparison) {
    return {{"baseline", {{"created", comparison.baseline_created}, {"program", comparison.baseline_program}}},
            {"refusal", known(comparison.refusal)},
            {"regression", comparison.has_regression()},
            {"tolerance", comparison.options.tolerance},
            {"confidence", comparison.options.confidence},
            {"notes", comparison.notes},
            {"runs", array_of(comparison.runs)},
            {"figures", array_of(comparison.figures)}};
}

Json to_object(const BvhReport& bvh) {
    const auto triangles = static_cast<double>(bvh.triangles);
    return {{"build_seconds", bvh.build_seconds},
            {"triangles", bvh.triangles},
            {"instanced_triangles", bvh.instanced_triangles},
            {"instances", bvh.instances},
            {"bytes", bvh.bytes},
            {"triangles_per_second", rate(triangles, bvh.build_seconds)},
            {"bytes_per_triangle", rate(static_cast<double>(bvh.bytes), triangles)},
            {"quality", bvh.quality}};
}

std::string lines(const Json& json) {
    std::string text;
    write(text, json, 0);
    return text + '\n';
}

}  // namespace

std::string to_json(const ProfileComparison& comparison) {
    return lines(to_object(comparison));
}

std::string to_json(const ProfileReport& report) {
    return lines({{"format", kProfileFormat},
                  {"program", report.program},
                  {"created", report.created},
                  {"command", report.command},
                  {"scene",
                   {{"name", report.scene},
                    {"path", report.scene_path},
                    {"width", report.width},
                    {"height", report.height},
                    {"crop", report.crop ? window(*report.crop) : Json()},
                    {"max_depth", report.max_depth},
                    {"seed", report.seed},
                    {"settings", report.settings}}},
                  {"machine",
                   {{"processor", report.processor},
                    {"processors", report.processors},
                    {"memory_nodes", report.memory_nodes},
                    {"isa", report.isa},
                    {"ray_tracer", report.ray_tracer}}},
                  {"load",
                   {{"phases", named(report.load, "seconds")},
                    {"seconds", sum_of(report.load)},
                    {"first_pixel_seconds", report.first_pixel_seconds}}},
                  {"bvh", to_object(report.bvh)},
                  {"memory", {{"owners", counted(report.memory, "bytes")}, {"peak_bytes", report.peak_memory_bytes}}},
                  {"notes", report.notes},
                  {"busy", known(busy_machine(report.runs))},
                  {"against", report.against ? to_object(*report.against) : Json()},
                  {"accelerators", report.accelerators ? accelerators_object(*report.accelerators) : Json()},
                  {"history", array_of(report.history)},
                  {"runs", array_of(report.runs)}});
}

}  // namespace etendue
