#include "picture/description_text.h"

#include "core/error.h"
#include "output/input_file_json.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;

Json to_object(const Mat4f& matrix) {
    Json numbers = Json::array();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) numbers.push_back(matrix[row][column]);
    return numbers;
}

Mat4f to_matrix(const Json& numbers) {
    Mat4f matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = numbers.at(static_cast<std::size_t>(i)).get<float>();
    return matrix;
}

Json to_object(const OutputFrame& f) {
    return {{"pixel_aspect", f.pixel_aspect},
            {"working_space", f.working_space},
            {"display", f.display},
            {"view", f.view},
            {"look", f.look},
            {"exposure", f.exposure ? Json(*f.exposure) : Json()},
            {"output_space", f.output_space},
            {"aces_container", f.aces_container},
            {"world_to_camera", to_object(f.world_to_camera)},
            {"world_to_screen", f.world_to_screen ? to_object(*f.world_to_screen) : Json()},
            {"camera", f.camera},
            {"focal_length", f.focal_length},
            {"f_number", f.f_number},
            {"focus_distance", f.focus_distance},
            {"fps", f.fps},
            {"frame", f.frame ? Json(*f.frame) : Json()},
            {"owner", f.owner},
            {"comments", f.comments},
            {"scene", f.scene},
            {"integrator", f.integrator},
            {"sampler", f.sampler},
            {"seed", f.seed}};
}

OutputFrame to_frame(const Json& json) {
    OutputFrame f;
    json.at("pixel_aspect").get_to(f.pixel_aspect);
    json.at("working_space").get_to(f.working_space);
    json.at("display").get_to(f.display);
    json.at("view").get_to(f.view);
    json.at("look").get_to(f.look);
    if (const Json& stops = json.at("exposure"); !stops.is_null()) f.exposure = stops.get<float>();
    json.at("output_space").get_to(f.output_space);
    json.at("aces_container").get_to(f.aces_container);
    f.world_to_camera = to_matrix(json.at("world_to_camera"));
    if (const Json& matrix = json.at("world_to_screen"); !matrix.is_null()) f.world_to_screen = to_matrix(matrix);
    json.at("camera").get_to(f.camera);
    json.at("focal_length").get_to(f.focal_length);
    json.at("f_number").get_to(f.f_number);
    json.at("focus_distance").get_to(f.focus_distance);
    json.at("fps").get_to(f.fps);
    if (const Json& number = json.at("frame"); !number.is_null()) f.frame = number.get<int>();
    json.at("owner").get_to(f.owner);
    json.at("comments").get_to(f.comments);
    json.at("scene").get_to(f.scene);
    json.at("integrator").get_to(f.integrator);
    json.at("sampler").get_to(f.sampler);
    json.at("seed").get_to(f.seed);
    return f;
}

Json to_object(const AovOutput& aov) {
    return {{"name", aov.name},        {"channels", aov.channels},     {"kind", static_cast<int>(aov.kind)},
            {"first", aov.first},      {"background", aov.background}, {"is_float", aov.is_float},
            {"manifest", aov.manifest}};
}

AovOutput to_aov(const Json& json) {
    AovOutput aov;
    json.at("name").get_to(aov.name);
    json.at("channels").get_to(aov.channels);
    aov.kind = static_cast<AovKind>(std::clamp(json.at("kind").get<int>(), 0, static_cast<int>(AovKind::Deep)));
    json.at("first").get_to(aov.first);
    json.at("background").get_to(aov.background);
    json.at("is_float").get_to(aov.is_float);
    json.at("manifest").get_to(aov.manifest);
    return aov;
}

Json to_object(const RenderStatistics& s) {
    return {{"scene", s.scene},
            {"frame", s.frame ? Json(*s.frame) : Json()},
            {"time_code", s.time_code ? Json(*s.time_code) : Json()},
            {"settings_hash", s.settings_hash},
            {"hash_of_whole", s.hash_of_whole},
            {"settings", s.settings},
            {"requested_settings", s.requested_settings},
            {"command", s.command},
            {"inputs", s.inputs},
            {"light_units", s.light_units},
            {"spp_requested", s.spp_requested},
            {"triangles", s.triangles},
            {"instances", s.instances},
            {"lights", s.lights},
            {"missing_textures", s.missing_textures},
            {"warnings", s.warnings},
            {"camera", s.camera},
            {"integrator_choice", s.integrator_choice},
            {"isa", s.isa},
            {"instruction_set", s.instruction_set}};
}

RenderStatistics to_statistics(const Json& json) {
    RenderStatistics s;
    json.at("scene").get_to(s.scene);
    if (!json.at("frame").is_null()) s.frame = json.at("frame").get<int>();
    if (!json.at("time_code").is_null()) s.time_code = json.at("time_code").get<double>();
    json.at("settings_hash").get_to(s.settings_hash);
    json.at("hash_of_whole").get_to(s.hash_of_whole);
    json.at("settings").get_to(s.settings);
    json.at("requested_settings").get_to(s.requested_settings);
    json.at("command").get_to(s.command);
    json.at("inputs").get_to(s.inputs);
    json.at("light_units").get_to(s.light_units);
    json.at("spp_requested").get_to(s.spp_requested);
    json.at("triangles").get_to(s.triangles);
    json.at("instances").get_to(s.instances);
    json.at("lights").get_to(s.lights);
    json.at("missing_textures").get_to(s.missing_textures);
    s.warnings = json.value("warnings", std::vector<std::string>());
    s.camera = json.value("camera", "");
    json.at("integrator_choice").get_to(s.integrator_choice);
    json.at("isa").get_to(s.isa);
    json.at("instruction_set").get_to(s.instruction_set);
    return s;
}

/// True if `aov` is made of what the layers have.
bool is_in(const LayerLayout& layout, const AovOutput& aov) {
    const std::size_t channels = aov.channels.size();
    const auto has = [&](std::size_t count, std::size_t wanted) {
        return aov.first < count && wanted <= count - aov.first;
    };
    switch (aov.kind) {
        case AovKind::Layer:
            return channels == 3 && has(layout.light, 1);
        case AovKind::Values:
            return channels > 0 && has(layout.values, channels);
        case AovKind::Nearest:
            return channels > 0 && has(layout.nearest, channels);
        case AovKind::Samples:
            return channels == 1;
        case AovKind::Variance:
            return channels == 3 && layout.has_moments;
        case AovKind::Rays:
            return channels == 1 && layout.has_ray_counts;
        case AovKind::Mean:
            return channels == 3;
        case AovKind::Matte:
            return channels > 0 && channels % 2 == 0 && channels / 2 <= layout.matte_slots && has(layout.mattes, 1);
        case AovKind::Deep:
            return layout.is_deep;
    }
    return false;
}

/// Files are named by layers.
bool is_layer_name(const std::string& name) {
    return !name.empty() && std::ranges::all_of(name, [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    });
}

/// Anybody can write a file: throws std::invalid_argument if `description` speaks of layers that are not there.
void require_fitting(const ImageDescription& description, const LayerLayout& layout) {
    for (const AovOutput& aov : description.aovs) {
        if (!is_layer_name(aov.name)) throw std::invalid_argument("a layer has a name that none may have");
        if (!is_in(layout, aov)) throw std::invalid_argument(fmt::format("it does not have the layer '{}'", aov.name));
    }
    const BucketLayers& buckets = description.buckets;
    const bool has_buckets =
        buckets.first_light <= layout.light && buckets.count <= layout.light - buckets.first_light &&
        buckets.first_value <= layout.values && buckets.count <= (layout.values - buckets.first_value) / 2;
    if (buckets.count > 0 && !has_buckets)
        throw std::invalid_argument(fmt::format("it does not have {} buckets", buckets.count));
    if (description.removed_light && *description.removed_light >= layout.light)
        throw std::invalid_argument("it does not have the layer of what a limit took away");
}

}  // namespace

std::string to_text(const ImageDescription& description) {
    Json aovs = Json::array();
    for (const AovOutput& aov : description.aovs) aovs.push_back(to_object(aov));
    const Json json{
        {"frame", to_object(description.frame)},
        {"aovs", std::move(aovs)},
        {"aov_layout", static_cast<int>(description.aov_layout)},
        {"has_halves", description.has_halves},
        {"buckets", {description.buckets.count, description.buckets.first_light, description.buckets.first_value}},
        {"clamp_indirect", description.clamp_indirect},
        {"removed_light", description.removed_light ? Json(*description.removed_light) : Json()},
        {"float", description.depth == PixelDepth::Float},
        {"statistics", to_object(description.statistics)}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

ImageDescription parse_description(const std::string& text, const LayerLayout& layout,
                                   const std::filesystem::path& file) {
    try {
        const Json json = Json::parse(text);
        ImageDescription description{
            .frame = to_frame(json.at("frame")), .aovs = {}, .statistics = to_statistics(json.at("statistics"))};
        for (const Json& aov : json.at("aovs")) description.aovs.push_back(to_aov(aov));
        const int files = json.at("aov_layout").get<int>();
        const Json& buckets = json.at("buckets");
        description.buckets = {buckets.at(0).get<std::size_t>(), buckets.at(1).get<std::size_t>(),
                               buckets.at(2).get<std::size_t>()};
        json.at("has_halves").get_to(description.has_halves);
        json.at("clamp_indirect").get_to(description.clamp_indirect);
        if (const Json& layer = json.at("removed_light"); !layer.is_null())
            description.removed_light = layer.get<std::size_t>();
        description.depth = json.at("float").get<bool>() ? PixelDepth::Float : PixelDepth::Half;
        description.aov_layout = kAovLayoutNames.at(static_cast<std::size_t>(files)).second;
        require_fitting(description, layout);
        return description;
    } catch (const std::exception& error) {
        throw IoError(fmt::format("{} does not say what image it is part of: {}", file.string(), error.what()));
    }
}

ImageDescription description_of(const Checkpoint& kept, const std::filesystem::path& file) {
    return parse_description(kept.description, kept.state.film.layers().layout(), file);
}

}  // namespace etendue
