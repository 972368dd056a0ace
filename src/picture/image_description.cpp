#include "picture/image_description.h"

#include "film/median_of_means.h"
#include "render/render.h"
#include "scene/canonical_settings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

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
    const float f_number = camera->focal_length / (2.0f * camera->lens_radius * kMillimetresPerMetre);
    if (std::isfinite(f_number)) frame.f_number = f_number;
}

}  // namespace

ImageDescription describe_settings(const SceneDesc& scene, const AovPlan& plan) {
    const RenderSettings& settings = scene.settings;
    ImageDescription description{.frame = {}, .aovs = plan.outputs, .has_halves = plan.has_halves, .statistics = {}};
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

namespace {

/// Returns whether all pixels of `film` have equally many samples, and all pixels of `half` have, too.
bool have_one_share(const Film& film, const Film& half) {
    const auto is_even = [](const Film& of) {
        const auto [least, most] = std::ranges::minmax(of.sums(), {}, &PixelSum::samples);
        return least.samples == most.samples;
    };
    return is_even(film) && is_even(half);
}

}  // namespace

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
    const bool has_halves = description.has_halves && state.every_other_pass && state.every_other_spp > 0 &&
                            state.every_other_spp < state.spp_done && description.buckets.count == 0;
    if (!has_halves || frame.layers.empty()) return;
    // The half has a different share of each pixel's samples if passes were for some pixels only, if one was cut short,
    // or if merged parts were of different samples.
    const bool is_uneven =
        !state.adaptive.is_uniform() || state.pass_size > 0 || !have_one_share(state.film, *state.every_other_pass);
    const std::optional<Film> evened =
        is_uneven ? std::optional(state.film.as_half(*state.every_other_pass)) : std::nullopt;
    const Film& half = evened ? *evened : *state.every_other_pass;
    frame.half_share =
        is_uneven ? 0.5f : static_cast<float>(state.every_other_spp) / static_cast<float>(state.spp_done);
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
