#include "app/scene_render.h"

#include "app/interrupt.h"
#include "app/library_versions.h"
#include "app/progress_display.h"
#include "core/log.h"
#include "core/process_time.h"
#include "core/write_file.h"
#include "integrator/integrator.h"
#include "loader/loader.h"
#include "output/exr_driver.h"
#include "output/preview_driver.h"
#include "output/software_name.h"
#include "render/render.h"
#include "world/compile.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace etendue {

namespace {

/// Measures one phase on the clock and on the processors.
class PhaseTimer {
  public:
    [[nodiscard]] PhaseTime elapsed() const {
        return {std::chrono::duration<double>(Clock::now() - wall_).count(), process_cpu_seconds() - cpu_};
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point wall_ = Clock::now();
    double cpu_ = process_cpu_seconds();
};

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

FilterShape to_filter_shape(PixelFilterType type) {
    switch (type) {
        case PixelFilterType::BlackmanHarris:
            return FilterShape::BlackmanHarris;
        case PixelFilterType::Box:
            return FilterShape::Box;
        case PixelFilterType::Gaussian:
            return FilterShape::Gaussian;
        case PixelFilterType::Mitchell:
            return FilterShape::Mitchell;
    }
    return FilterShape::BlackmanHarris;
}

void report_problems(const ProblemList& problems, std::size_t& reported, bool quiet) {
    for (; reported < problems.all().size(); ++reported)
        if (!quiet) log_warning("{}", problems.all()[reported].str());
}

OutputFrame make_frame(const RenderResult& result, const Camera& camera, const std::string& name,
                       const RenderSettings& settings, const std::string& working_space) {
    const PixelRect& window = result.film.window();
    OutputFrame frame;
    frame.pixels = rgba_image(result.film);
    if (settings.film.crop) {
        frame.crop_x = window.x0;
        frame.crop_y = window.y0;
        frame.full_width = result.film.full_width();
        frame.full_height = result.film.full_height();
    }
    frame.working_space = working_space;
    frame.display = settings.color.display;
    frame.view = settings.color.view;
    frame.exposure = settings.color.exposure;
    frame.world_to_camera = world_to_camera(camera);
    frame.world_to_screen = world_to_screen(camera);
    frame.scene = name;
    frame.integrator = settings.integrator.type;
    frame.sampler = settings.sampler == SamplerType::Random ? "random" : "sobol";
    frame.spp = static_cast<int>(result.spp_done);
    frame.seed = settings.seed;
    frame.render_seconds = result.wall_seconds;
    frame.complete = result.halt_reason != HaltReason::Interrupted;
    frame.halt_reason = halt_reason_name(result.halt_reason);
    return frame;
}

void fill_render_statistics(const RenderResult& result, RenderStatistics& s) {
    const RenderCounters& c = result.counters;
    s.rays = {c.camera_rays, c.bounce_rays, c.shadow_rays};
    s.samples = c.samples;
    s.spp_done = static_cast<int>(result.spp_done);
    s.complete = result.halt_reason != HaltReason::Interrupted;
    s.halt_reason = halt_reason_name(result.halt_reason);
    s.render = {result.wall_seconds, result.cpu_seconds};
    s.dropped_samples = c.dropped;
    s.first_dropped = c.first_dropped;
}

/// After rendering, when the cache has held what it will. Look-ups that failed are an error to tell, not one to lose
/// the image for.
void fill_texture_statistics(const World& world, RenderStatistics& s) {
    const WorldStatistics from = world.statistics();
    s.textures = from.textures;
    s.texture_bytes = from.texture_bytes;
    s.textures_cached = from.textures_cached;
    s.texture_cache_budget = from.texture_cache_budget;
    s.failed_texture_lookups = from.failed_texture_lookups;
    if (from.failed_texture_lookups > 0)
        log_error("error: {} texture look-ups met broken pixels and read black: {}", from.failed_texture_lookups,
                  from.first_texture_failure);
}

/// Says where samples were dropped, with a command that renders just the first of those pixels.
void report_dropped(const RenderCounters& counters, const SceneRenderRequest& request, const RenderSettings& settings,
                    const std::string& working_space) {
    if (counters.dropped == 0) return;
    const DroppedSample& first = counters.first_dropped.front();
    std::string command = fmt::format(
        "etendue render {} --integrator {} --max-depth {} --size {}x{} --crop {},{},{},{} --spp {} --seed {} "
        "--working-space {}",
        quoted(request.scene.string()), settings.integrator.type, settings.integrator.max_depth, settings.film.width,
        settings.film.height, first.x, first.y, first.x + 1, first.y + 1, first.sample + 1, settings.seed,
        quoted(working_space));
    if (request.overrides.min_depth) command += fmt::format(" --min-depth {}", *request.overrides.min_depth);
    if (const auto& strategy = settings.integrator.strategy)
        command += fmt::format(" --strategy {},{}{}", (*strategy)[0], (*strategy)[1],
                               settings.integrator.weighted ? "" : " --unweighted");
    if (!settings.camera.empty()) command += " --camera " + quoted(settings.camera);
    if (settings.time_code) command += fmt::format(" --time-code {}", *settings.time_code);
    if (settings.frame) command += fmt::format(" --frames {} --fps {}", *settings.frame, settings.fps);
    if (settings.shutter.is_open())
        command += fmt::format(" --shutter {}:{}", settings.shutter.open, settings.shutter.close);
    if (!settings.animation.empty()) command += " --animation " + quoted(settings.animation);
    if (!settings.variant.empty()) command += " --variant " + quoted(settings.variant);
    if (request.overrides.light_units)
        command += fmt::format(" --light-units {}", light_units_name(settings.light_units));
    if (request.overrides.environment) command += " --environment " + quoted(*request.overrides.environment);
    log_warning(
        "warning: {} samples were not finite and were dropped; the first is sample {} of pixel ({}, {}). To see it "
        "alone: {}",
        counters.dropped, first.sample, first.x, first.y, command);
}

void require_all_writable(const OutputPaths& paths) {
    for (const std::filesystem::path& path : {paths.exr, paths.png, paths.json}) require_writable(path);
}

}  // namespace

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

void require_writable(const std::filesystem::path& file) {
    const std::filesystem::path parent = file.parent_path();
    const std::filesystem::path directory = parent.empty() ? "." : parent;
    if (!std::filesystem::is_directory(directory))
        throw IoError(fmt::format("cannot write {}: there is no directory {}", file.string(), directory.string()));
    if (std::filesystem::is_directory(file))
        throw IoError(fmt::format("cannot write {}: it is a directory", file.string()));
    if (access(directory.c_str(), W_OK | X_OK) != 0)
        throw IoError(fmt::format("cannot write {}: {} is not writable", file.string(), directory.string()));
}

RenderOptions make_render_options(const RenderSettings& settings) {
    const FilmSettings& film = settings.film;
    RenderOptions options;
    options.full_width = film.width;
    options.full_height = film.height;
    options.window = film.crop ? PixelRect{(*film.crop)[0], (*film.crop)[1], (*film.crop)[2], (*film.crop)[3]}
                               : PixelRect{0, 0, film.width, film.height};
    options.spp = static_cast<std::uint32_t>(settings.spp);
    options.seed = settings.seed;
    options.sequence = settings.sampler == SamplerType::Random ? SampleSequence::Random : SampleSequence::Sobol;
    options.filter = PixelFilter(to_filter_shape(film.filter), film.filter_radius);
    options.time_limit_seconds = settings.time_limit;
    return options;
}

IntegratorOptions integrator_options(const RenderSettings& settings) {
    const IntegratorSettings& s = settings.integrator;
    IntegratorOptions options{
        .lengths = {s.max_depth, s.min_depth, s.roulette_depth},
        .heuristic = s.heuristic == HeuristicType::Balance ? Heuristic::Balance : Heuristic::Power,
        .weighted = s.weighted,
        .cached_connections = s.cached_connections};
    if (s.strategy) options.strategy = Strategy{(*s.strategy)[0], (*s.strategy)[1]};
    return options;
}

bool has_strategies(const std::string& integrator) {
    const IntegratorEntry* const entry = find_integrator(integrator);
    return entry != nullptr && entry->has_strategies;
}

void require_strategies(const RenderSettings& settings, const SourceLocation& asked_for) {
    const std::string& type = settings.integrator.type;
    if (!has_strategies(type)) throw SceneError(asked_for, fmt::format("'{}' has no strategies; 'bdpt' does", type));
}

std::unique_ptr<const Integrator> create_integrator(const RenderSettings& settings) {
    const IntegratorSettings& s = settings.integrator;
    std::vector<std::string_view> names;
    for (const IntegratorEntry& entry : integrator_registry()) {
        names.push_back(entry.name);
        if (entry.name == s.type && s.min_depth > entry.longest_path)
            throw SceneError(settings.at("/integrator/min_depth"),
                             fmt::format("min_depth is {}, but the paths of '{}' have at most {} edges", s.min_depth,
                                         s.type, entry.longest_path));
    }
    auto integrator = make_integrator(s.type, integrator_options(settings));
    if (!integrator)
        throw SceneError(settings.at("/integrator/type"),
                         fmt::format("no integrator is named '{}'; {}", s.type, name_hint(s.type, names)));
    if (s.strategy) require_strategies(settings, settings.at("/integrator/strategy"));
    return integrator;
}

std::string resolve_colors(RenderSettings& settings, const ColorConfig& colors) {
    ColorSettings& s = settings.color;
    // The config knows names only; where they stood is known here.
    const auto located = [&](const char* pointer, const auto& look_up) {
        try {
            return look_up();
        } catch (const SceneError& error) {
            throw SceneError(settings.at(pointer), error.problems().all().front().message);
        }
    };
    s.working_space = located("/color/working_space", [&] {
        return s.working_space.empty() ? colors.default_working_space() : colors.resolve_space(s.working_space);
    });
    if (s.display.empty()) s.display = colors.default_display();
    if (s.view.empty()) s.view = located("/color/display", [&] { return colors.default_view(s.display); });
    (void)located("/color/view",
                  [&] { return colors.display_transform(s.working_space, s.display, s.view, s.exposure); });
    return s.working_space;
}

PreparedScene prepare_scene(const std::filesystem::path& path, const SettingsOverrides& overrides) {
    const PhaseTimer timer;
    LoadedScene loaded = load_scene(path, overrides.moment);
    PreparedScene prepared{std::move(loaded.scene), std::move(loaded.problems), {}};
    overrides.apply(prepared.scene);
    const std::filesystem::path colors = ColorConfig::environment_path();
    if (!colors.empty()) prepared.scene.inputs.push_back(colors);
    add_missing_camera_and_light(prepared.scene, prepared.problems);
    const ProblemList remaining = validate(prepared.scene);
    if (remaining.has_errors()) throw SceneError(remaining);
    apply_variant(prepared.scene);
    prepared.load = timer.elapsed();
    return prepared;
}

std::string settings_hash(const SceneDesc& scene, PixelDepth depth) {
    // FNV-1a, 64 bits, over the text form of the scene; nobody attacks it, it only has to tell settings apart.
    const std::string text = fmt::format("{}\n{}\n{}\n{}", software_name(), dump(scene), static_cast<int>(depth),
                                         ColorConfig::environment_path().string());
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return fmt::format("{:016x}", hash);
}

SceneRenderResult render_scene(PreparedScene prepared, const SceneRenderRequest& request, const ThreadPool& threads) {
    SceneDesc scene = std::move(prepared.scene);
    ProblemList problems = std::move(prepared.problems);
    std::size_t reported = 0;
    report_problems(problems, reported, request.quiet);

    const OutputPaths paths =
        OutputPaths::beside(request.output.empty() ? std::filesystem::path(scene.name + ".exr") : request.output);
    require_all_writable(paths);
    const bool shows_strategies = !request.strategies.output.empty();
    if (shows_strategies) {
        require_all_writable(OutputPaths::beside(request.strategies.output));
        require_strategies(scene.settings, {"--strategies-image", {}});
    }
    const RenderOptions options = make_render_options(scene.settings);
    const auto integrator = create_integrator(scene.settings);
    if (shows_strategies)
        check_strategies_request(request.strategies, paths, scene.settings, options, request.overrides.depth);
    // Before names are resolved: batch compares it with that of a scene that was only prepared.
    const std::string hash = settings_hash(scene, request.overrides.depth);
    const ColorConfig colors = ColorConfig::from_environment();
    const std::string working_space = resolve_colors(scene.settings, colors);

    SceneRenderResult result;
    RenderStatistics& statistics = result.statistics;
    statistics.scene = scene.name;
    statistics.frame = scene.settings.frame;
    statistics.time_code = scene.settings.shown_time();
    statistics.settings_hash = hash;
    statistics.light_units = light_units_name(scene.settings.light_units);
    statistics.width = options.window.width();
    statistics.height = options.window.height();
    statistics.full_width = options.full_width;
    statistics.full_height = options.full_height;
    statistics.spp_requested = scene.settings.spp;
    statistics.threads = threads.thread_count();
    statistics.isa = ray_tracer_info().isa;
    statistics.libraries = library_versions();
    statistics.load = prepared.load;

    const PhaseTimer build_timer;
    const std::string name = scene.name;
    const RenderSettings settings = scene.settings;
    const World world = compile_world(std::move(scene), colors, working_space, threads, problems);
    report_problems(problems, reported, request.quiet);
    const WorldStatistics world_statistics = world.statistics();
    statistics.build = build_timer.elapsed();
    statistics.bvh_bytes = world_statistics.bvh_bytes;
    statistics.bvh_build_seconds = world_statistics.bvh_build_seconds;
    statistics.triangles = world_statistics.triangles;
    statistics.instances = world_statistics.instances;
    statistics.lights = world_statistics.lights;

    if (!request.quiet)
        for (const auto& notes : {integrator->unreachable_light(world), integrator->ineffective_options(world)})
            for (const std::string& note : notes) log_warning("note: {}", note);

    const std::string title = request.title.empty() ? name : request.title;
    std::optional<ProgressDisplay> display(std::in_place, title, request.quiet);
    const RenderResult rendered = render(world, *integrator, options, threads, interrupt_requested(),
                                         [&](const RenderProgress& progress) { display->update(progress); });
    display.reset();
    fill_render_statistics(rendered, statistics);
    report_dropped(rendered.counters, request, settings, working_space);
    fill_texture_statistics(world, statistics);

    result.output = paths.exr;
    result.interrupted = rendered.halt_reason == HaltReason::Interrupted;
    // An earlier image is worth more than a black one.
    if (result.interrupted && rendered.counters.samples == 0) return result;

    const PhaseTimer write_timer;
    const OutputFrame frame = make_frame(rendered, world.camera(), name, settings, working_space);
    ExrDriver(paths.exr, colors, request.overrides.depth).write(frame);
    PreviewDriver(paths.png, colors).write(frame);
    if (shows_strategies && !result.interrupted)
        write_strategies_image(request.strategies, world, integrator_options(settings), options, frame, colors,
                               request.overrides.depth, threads, title, request.quiet);
    statistics.write = write_timer.elapsed();
    statistics.peak_memory_bytes = peak_memory_bytes();
    write_text(paths.json, to_json(statistics));
    return result;
}

}  // namespace etendue
