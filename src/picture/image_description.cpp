#include "picture/image_description.h"

#include "core/error.h"
#include "film/median_of_means.h"
#include "output/input_file_json.h"
#include "render/render.h"
#include "scene/canonical_settings.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <exception>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

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
    f.look = json.value("look", "");  // this and the two below: parts of before they were known have none
    if (const Json& stops = json.at("exposure"); !stops.is_null()) f.exposure = stops.get<float>();
    f.output_space = json.value("output_space", "");
    f.aces_container = json.value("aces_container", false);
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
    aov.manifest = json.value("manifest", "");
    return aov;
}

Json to_object(const RenderStatistics& s) {
    return {{"scene", s.scene},
            {"frame", s.frame ? Json(*s.frame) : Json()},
            {"time_code", s.time_code ? Json(*s.time_code) : Json()},
            {"settings_hash", s.settings_hash},
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
    json.at("integrator_choice").get_to(s.integrator_choice);
    json.at("isa").get_to(s.isa);
    json.at("instruction_set").get_to(s.instruction_set);
    return s;
}

/// Red, green and blue of all pixels.
double sum_of(const std::vector<float>& image, std::size_t channels) {
    double total = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i)
        if (i % channels < 3) total += static_cast<double>(image[i]);
    return total;
}

/// Returns the share of all light, in [0, 1], that a limit took away into the light layer `layer` of `film`.
double removed_share(const Film& film, std::size_t layer) {
    const double removed = sum_of(film.resolve_light(layer), 3);
    return removed > 0.0 ? removed / (removed + sum_of(film.resolve(), 4)) : 0.0;
}

std::vector<BrightContribution> describe(std::span<const BrightSample> samples) {
    std::vector<BrightContribution> list;
    for (const BrightSample& sample : samples) {
        BrightContribution& c = list.emplace_back();
        c.x = sample.x;
        c.y = sample.y;
        c.sample_x = sample.sample_x;
        c.sample_y = sample.sample_y;
        c.sample = sample.sample;
        c.value = {sample.value.r, sample.value.g, sample.value.b};
        c.is_splat = sample.is_splat != 0;
        if (!sample.has_path()) continue;
        c.path = sample.word.data();
        c.s = sample.s;
        c.t = sample.t;
        c.edges = sample.edges;
    }
    return list;
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

/// Moves by `way`, then transforms by `m`.
Mat4f after_move(const Vec3d& way, Mat4f m) {
    if (way == Vec3d(0.0)) return m;
    for (int column = 0; column < 4; ++column) {
        double moved = static_cast<double>(m[3][column]);
        for (int axis = 0; axis < 3; ++axis) moved += way[axis] * static_cast<double>(m[axis][column]);
        m[3][column] = static_cast<float>(moved);
    }
    return m;
}

/// Tells `frame` which camera was chosen, and what is known of its lens.
void describe_lens(const SceneDesc& scene, OutputFrame& frame) {
    const std::string& name = scene.settings.camera;
    const CameraDesc* const first = scene.cameras.empty() ? nullptr : &scene.cameras.front();
    const CameraDesc* const camera = name.empty() ? first : find_camera(scene, name);
    if (camera == nullptr) return;
    frame.camera = camera->name;
    frame.focal_length = camera->focal_length;
    if (!(camera->lens_radius > 0.0f)) return;
    frame.focus_distance = camera->focus_distance;
    constexpr float kMillimetresPerMetre = 1000.0f;
    frame.f_number = camera->focal_length / (2.0f * camera->lens_radius * kMillimetresPerMetre);
}

}  // namespace

ImageDescription describe_settings(const SceneDesc& scene, const AovPlan& plan) {
    const RenderSettings& settings = scene.settings;
    ImageDescription description{.frame = {}, .aovs = plan.outputs, .statistics = {}};
    OutputFrame& frame = description.frame;
    frame.working_space = settings.color.working_space;
    frame.display = settings.color.display;
    frame.view = settings.color.view;
    frame.look = settings.color.look;
    frame.output_space = settings.color.output_space;
    frame.aces_container = settings.color.aces_container;
    frame.exposure = settings.color.exposure;
    frame.pixel_aspect = settings.film.pixel_aspect;
    describe_lens(scene, frame);
    frame.fps = settings.fps;
    frame.frame = settings.frame;
    frame.owner = settings.metadata.owner;
    frame.comments = settings.metadata.comments;
    frame.scene = scene.name;
    frame.sampler = settings.sampler == SamplerType::Random ? "random" : "sobol";
    frame.seed = settings.seed;
    description.aov_layout = settings.aov_layout;
    description.clamp_indirect = settings.clamp_indirect;
    if (plan.set) {
        description.buckets = plan.set->buckets;
        description.removed_light = plan.set->removed_light;
    }
    RenderStatistics& s = description.statistics;
    s.scene = scene.name;
    s.frame = settings.frame;
    s.time_code = settings.shown_time();
    s.light_units = light_units_name(settings.light_units);
    s.spp_requested = settings.spp;
    describe_integrator(description, settings);
    return description;
}

void describe_integrator(ImageDescription& description, const RenderSettings& settings) {
    description.frame.integrator = settings.integrator.type;
    description.statistics.settings = to_json_object(setting_texts(settings));
}

void describe_camera(ImageDescription& description, const World& world) {
    description.frame.world_to_camera = after_move(-world.origin(), world_to_camera(world.camera().model()));
    if (const auto to_screen = world_to_screen(world.camera().model()))
        description.frame.world_to_screen = after_move(-world.origin(), *to_screen);
}

std::string to_text(const ImageDescription& description) {
    Json aovs = Json::array();
    for (const AovOutput& aov : description.aovs) aovs.push_back(to_object(aov));
    const Json json{
        {"frame", to_object(description.frame)},
        {"aovs", std::move(aovs)},
        {"aov_layout", static_cast<int>(description.aov_layout)},
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

void describe_state(ImageDescription& description, const RenderState& state, bool complete,
                    const std::string& halt_reason) {
    const Film& film = state.film;
    const PixelRect& window = film.window();
    OutputFrame& frame = description.frame;
    frame.pixels = rgba_image(film);
    if (description.buckets.count > 0) frame.pixels.pixels = median_of_means(film, description.buckets);
    const bool is_cropped = window != PixelRect{0, 0, film.full_width(), film.full_height()};
    frame.crop_x = window.x0;
    frame.crop_y = window.y0;
    frame.full_width = is_cropped ? film.full_width() : 0;
    frame.full_height = is_cropped ? film.full_height() : 0;
    frame.spp = static_cast<int>(state.spp_done);
    frame.render_seconds = state.wall_seconds;
    frame.complete = complete;
    frame.halt_reason = halt_reason;

    RenderStatistics& s = description.statistics;
    frame.settings = s.settings;
    frame.command = s.command;
    const RenderCounters& c = state.counters;
    s.integrator = frame.integrator;
    s.width = window.width();
    s.height = window.height();
    s.full_width = film.full_width();
    s.full_height = film.full_height();
    s.rays = {.camera = c.rays[RayKind::Primary],
              .bounce = c.rays[RayKind::Bounce],
              .shadow = c.rays[RayKind::Shadow],
              .light_subpath = c.rays[RayKind::LightSubpath],
              .connection = c.rays[RayKind::Connection],
              .light_to_camera = c.rays[RayKind::LightToCamera],
              .lamp_in_view = c.rays[RayKind::LampInView],
              .lamp_image = c.rays[RayKind::LampImage]};
    s.samples = c.samples;
    s.spp_done = static_cast<int>(state.spp_done);
    s.complete = complete;
    s.halt_reason = halt_reason;
    s.render = {state.wall_seconds, state.cpu_seconds};
    s.dropped_samples = c.dropped;
    s.first_dropped = c.first_dropped;
    s.relative_error = relative_error(state);
    s.clamp_indirect = description.clamp_indirect;
    if (description.removed_light) s.removed_share = removed_share(film, *description.removed_light);
    s.robust_buckets = static_cast<int>(description.buckets.count);
    s.robust_filled = static_cast<int>(std::min<std::uint64_t>(
        description.buckets.count, std::ranges::min(film.sums(), {}, &PixelSum::samples).samples));
    if (const double mean = sum_of(film.resolve(), 4); s.robust_buckets > 0 && mean > 0.0)
        s.robust_removed_share = 1.0 - sum_of(frame.pixels.pixels, 4) / mean;
    s.brightest = describe(c.brightest.samples());
    s.adaptive.reset();
    if (!state.adaptive.is_uniform()) {
        // As the pixels have them, those of a pass that was stopped too.
        const auto [least, most] = std::ranges::minmax(film.sums(), {}, &PixelSum::samples);
        s.adaptive = {static_cast<std::uint32_t>(least.samples),
                      static_cast<double>(c.samples) / static_cast<double>(window.area()),
                      static_cast<std::uint32_t>(most.samples)};
    }
}

std::optional<std::string> few_buckets(const RenderStatistics& statistics) {
    if (statistics.robust_filled >= statistics.robust_buckets) return std::nullopt;
    return fmt::format("mon:{} has only {} means to take the median of where pixels have as few samples",
                       statistics.robust_buckets, statistics.robust_filled);
}

void resolve_layers(ImageDescription& description, const RenderState& state) {
    OutputFrame& frame = description.frame;
    frame.layers.clear();
    for (const AovOutput& aov : description.aovs) {
        if (aov.kind == AovKind::Deep)
            frame.deep = resolve_deep_pixels(state.film);
        else
            frame.layers.push_back(resolve_layer(state.film, aov));
    }
    // Means of half of the samples are no halves of a median of means.
    const bool has_halves = state.every_other_pass && state.every_other_spp > 0 && description.buckets.count == 0;
    if (!has_halves || frame.layers.empty()) return;
    const bool is_adaptive = !state.adaptive.is_uniform();
    const std::optional<Film> evened =
        is_adaptive ? std::optional(state.film.as_half(*state.every_other_pass)) : std::nullopt;
    const Film& half = evened ? *evened : *state.every_other_pass;
    frame.half_share =
        is_adaptive ? 0.5f : static_cast<float>(state.every_other_spp) / static_cast<float>(state.spp_done);
    OutputLayer image{
        .name = std::string(kHalf), .channels = "RGBA", .is_color = true, .is_half = true, .pixels = rgba_image(half)};
    frame.layers.push_back(std::move(image));
    for (const AovOutput& aov : description.aovs) {
        if (!has_half(aov)) continue;
        frame.layers.push_back(resolve_layer(half, aov));
        frame.layers.back().name = half_name(aov);
        frame.layers.back().is_half = true;
    }
}

}  // namespace etendue
