// etendue profile: where the time of a render goes, next to what bare Embree needs for its rays.
#include "cli/command_options.h"
#include "cli/commands.h"
#include "cli/profile_accelerators.h"
#include "cli/settings_options.h"
#include "core/log.h"
#include "core/memory_nodes.h"
#include "core/process_time.h"
#include "core/source_date.h"
#include "core/standard_output.h"
#include "core/write_file.h"
#include "image/write.h"
#include "metrics/color_map.h"
#include "output/software_name.h"
#include "picture/render_setup.h"
#include "processor/ray_code.h"
#include "profile/profile_runs.h"
#include "render/progressive_render.h"
#include "report/profile_advice.h"
#include "report/profile_comparison.h"
#include "report/profile_figures.h"
#include "report/profile_report.h"
#include "session/interrupt.h"
#include "session/output_directory.h"
#include "session/phase_timer.h"
#include "session/prepared_scene.h"
#include "session/render_identity.h"

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>

namespace etendue {

namespace {

constexpr double kSecondsPerRun = 1.0;
constexpr int kDefaultRepetitions = 5;
constexpr const char* kData = "profile.json";

constexpr const char* kNoImage = "here no image file is written";

constexpr std::array kRefusedOptions{
    OptionOfRender{"--integrator", "here --integrators names those that are measured"},
    OptionOfRender{"--error", "here all runs end after --time or with --spp"},
    OptionOfRender{"--adaptive", "here all pixels get as many samples"},
    OptionOfRender{"--no-adaptive", "here all pixels get as many samples anyway"},
    OptionOfRender{"--min-spp", "here all pixels get as many samples"},
    OptionOfRender{"--robust", "here images are not looked at, and the mean is what is measured"},
    OptionOfRender{"--frames", "here --time-code names the moment"},
    OptionOfRender{"--brightest", "here no sample is listed"},
    OptionOfRender{"--aov", "here the image alone is measured"},
    OptionOfRender{"--aov-layout", "here the image alone is measured"},
    OptionOfRender{"--deep", "here the image alone is measured"},
    OptionOfRender{"--fps", "here --time-code names the moment, in seconds"},
    OptionOfRender{"--exposure", kNoImage},
    OptionOfRender{"--display", kNoImage},
    OptionOfRender{"--view", kNoImage},
    OptionOfRender{"--look", kNoImage},
    OptionOfRender{"--exr-space", kNoImage},
    OptionOfRender{"--aces-container", kNoImage},
    OptionOfRender{"--owner", kNoImage},
    OptionOfRender{"--comments", kNoImage},
    OptionOfRender{"--half", kNoImage},
    OptionOfRender{"--float", kNoImage}};

struct ProfileArguments {
    std::string scene;
    std::string output;
    std::vector<std::string> integrators{"path", "bdpt"};
    std::vector<int> threads;  ///< empty for 1 and all
    std::optional<double> seconds;
    int repetitions = kDefaultRepetitions;
    std::string against;
    std::vector<std::string> history;
    double tolerance = ProfileComparisonOptions{}.tolerance;
    AcceleratorArguments accelerators;
    SettingsOverrides overrides;
    std::string command;
    bool quiet = false;
    bool json = false;
};

std::vector<int> thread_counts(const ProfileArguments& arguments) {
    if (!arguments.threads.empty()) return arguments.threads;
    const ThreadPool all;
    return all.thread_count() > 1 ? std::vector{1, all.thread_count()} : std::vector{1};
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) throw IoError(fmt::format("cannot read {}", path.string()));
    return std::move(text).str();
}

/// Returns the processor's name as the system gives it; empty if the system gives none.
std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) {
            const std::size_t name = line.find_first_not_of(": \t", line.find(':'));
            return name == std::string::npos ? "" : line.substr(name);
        }
    return {};
}

/// Takes out of the settings what render.json may ask for and is not measured, with a note on each.
void leave_out_unmeasured(RenderSettings& settings, std::vector<std::string>& notes) {
    const auto note = [&](const char* what) { notes.push_back(fmt::format("{}: {}", settings.location.file, what)); };
    if (!settings.aovs.empty()) note("its layers are left out: the image alone is measured");
    if (settings.relative_error > 0.0) note("its error is not looked at: all pixels get as many samples");
    if (settings.robust_buckets > 0) note("its median of means is left out: the mean is what is measured");
    settings.aovs.clear();
    settings.relative_error = 0.0;
    settings.robust_buckets = 0;
}

/// Loading and compiling, phase by phase.
class LoadedScene {
  public:
    LoadedScene(const ProfileArguments& arguments, const ColorConfig& colors, const ThreadPool& threads,
                ProfileReport& report) {
        const NothingToKeep while_reading;
        report.load.push_back({"start of the process", seconds_since_process_start()});
        PreparedScene prepared = prepare_scene(arguments.scene, arguments.overrides);
        report.load.push_back({"files", prepared.load.wall});
        working_space = resolve_colors(prepared.scene.settings, colors);
        settings = prepared.scene.settings;
        inputs = prepared.scene.inputs;
        if (!arguments.against.empty()) inputs.emplace_back(arguments.against);
        inputs.insert(inputs.end(), arguments.history.begin(), arguments.history.end());
        names = scene_names(prepared.scene);
        leave_out_unmeasured(settings, report.notes);
        report.scene = prepared.scene.name;
        const PhaseTimer timer;
        world = std::make_unique<const World>(
            ray_code().compile_world(std::move(prepared.scene), colors, working_space, threads, prepared.problems, {}));
        double rest = timer.elapsed().wall;
        for (const CompilePhase& phase : world->statistics().compile_phases) {
            report.load.push_back({std::string(phase.name), phase.seconds});
            rest -= phase.seconds;
        }
        report.load.push_back({"light tree", rest});
        if (!arguments.quiet)
            for (const Problem& problem : prepared.problems.all()) log_warning("{}", problem.str());
    }

    RenderSettings settings;
    std::string working_space;
    SceneHitNames names;
    std::vector<std::filesystem::path> inputs;  ///< files that are read, earlier profiles among them
    std::unique_ptr<const World> world;
};

/// One sample of every pixel, as a user waits for it.
void time_first_pixels(const World& world, RenderSettings settings, const ProfileArguments& arguments,
                       const ThreadPool& threads, ProfileReport& report) {
    settings.integrator.type = arguments.integrators.front();
    const auto integrator = create_integrator(settings);
    ProgressiveRender render(world, *integrator, make_render_options(settings), threads);
    render.add_samples(1, [] { return interrupt_requested().load(); });
    report.load.push_back({"first sample of every pixel", render.state().wall_seconds});
    report.first_pixel_seconds = seconds_since_process_start();
}

/// Returns the settings that decide how much work a sample is, without those that each run sets itself.
std::map<std::string, std::string> settings_of_work(RenderSettings settings) {
    settings.integrator.type = "of each run";
    std::map<std::string, std::string> work = settings_identity(settings);
    work.erase("seed");
    if (settings.film.crop) work["crop"] = fmt::format("{}", fmt::join(*settings.film.crop, " "));
    if (settings.texture_memory) work["texture memory"] = fmt::format("{} bytes", *settings.texture_memory);
    return work;
}

void describe(ProfileReport& report, const ProfileArguments& arguments, const RenderSettings& settings,
              const World& world) {
    const WorldStatistics of_world = world.statistics();
    report.program = software_name();
    report.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(creation_time()));
    report.command = arguments.command;
    report.scene_path = arguments.scene;
    report.width = settings.film.width;
    report.height = settings.film.height;
    report.max_depth = settings.integrator.lengths.max_depth;
    report.seed = settings.seed;
    report.settings = settings_of_work(settings);
    report.processor = processor_name();
    report.processors = static_cast<int>(std::thread::hardware_concurrency());
    report.memory_nodes = std::max(1, static_cast<int>(memory_nodes().size()));
    report.isa = of_world.isa;
    report.ray_tracer = "Embree " + ray_tracer_version();
    report.bvh = {.build_seconds = of_world.bvh_build_seconds,
                  .triangles = of_world.triangles,
                  .instanced_triangles = of_world.instanced_triangles,
                  .instances = of_world.instances,
                  .bytes = of_world.bvh_bytes,
                  .quality = of_world.bvh_quality};
}

/// Adds a note to `report` for each run whose time stamps took 1% of the run's time or more, as measuring must not be
/// what is measured.
void note_costly_stamps(ProfileReport& report) {
    constexpr double kMostShare = 0.01;
    for (const ProfileRun& run : report.runs)
        if (run.timing_share >= kMostShare)
            report.notes.push_back(
                fmt::format("{}, threads: {}: the time stamps took {:.1f}% of the time, more than the 1% they should; "
                            "figures of its stages hold "
                            "them, and larger images or more samples make them less",
                            run.integrator, run.threads, 100.0 * run.timing_share));
}

void note_other_work(ProfileReport& report) {
    for (const ProfileRun& run : report.runs)
        for (const std::string& note : {busy_machine(run), disagreement_of_repetitions(run)})
            if (!note.empty()) report.notes.push_back(note);
}

/// Reads earlier profiles, the oldest first. Throws SceneError for one of other work.
std::vector<EarlierProfile> read_history(const std::vector<std::string>& files, const ProfileReport& now) {
    std::vector<EarlierProfile> history;
    for (const std::string& file : files) {
        const ProfileBaseline profile = parse_profile(read_text(file), file);
        if (const std::string difference = difference_of_work(profile, now); !difference.empty())
            throw SceneError({file, {}}, difference);
        EarlierProfile& entry = history.emplace_back(EarlierProfile{file, profile.created, profile.program, {}});
        for (const ProfileRun& run : profile.runs)
            entry.runs.push_back({run.integrator, run.threads, cpu_seconds_per_sample(run)});
    }
    std::ranges::stable_sort(history, {}, &EarlierProfile::created);
    return history;
}

void describe_memory(ProfileReport& report, const World& world, const ProfileRuns& runs) {
    const WorldStatistics of_world = world.statistics();
    const auto bytes = [](std::size_t value) { return static_cast<double>(value); };
    report.memory = {{"geometry", bytes(of_world.geometry_bytes)},
                     {"instances", bytes(of_world.instance_bytes)},
                     {"BVH", bytes(of_world.bvh_bytes)},
                     {"materials", bytes(of_world.material_bytes)},
                     {"textures", bytes(of_world.texture_bytes)},
                     {"lights", bytes(of_world.light_bytes)},
                     {"film", bytes(runs.film_bytes)},
                     {"tiles and splats", bytes(runs.tile_bytes)},
                     {"waves", bytes(runs.wave_bytes)}};
    report.peak_memory_bytes = runs.peak_memory_bytes;
}

std::string heat_map_stem(const std::string& integrator, int threads) {
    return fmt::format("heat-{}-{}", integrator, threads);
}

/// Writes the map's EXR, and keeps its picture for the page.
void write_costs(const std::filesystem::path& directory, const PixelRect& window, const CostMap& costs,
                 ProfileReport& report, ProfileImages& images) {
    ImageF both(window.width(), window.height(), 2);
    ImageF seconds(window.width(), window.height(), 1);
    for (std::size_t p = 0; p < costs.rays.size(); ++p) {
        both.pixels[2 * p] = costs.rays[p];
        both.pixels[2 * p + 1] = seconds.pixels[p] = costs.seconds[p];
    }
    // A few pixels that cost far more than all others would leave these black.
    std::vector<float> sorted = costs.seconds;
    const auto high = sorted.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(sorted.size() - 1) * 0.995);
    std::ranges::nth_element(sorted, high);
    const ImageF picture = paint_magma(seconds, static_cast<double>(*high));
    const auto most_threads = std::ranges::max_element(
        report.runs, {}, [&](const ProfileRun& run) { return run.integrator == costs.integrator ? run.threads : 0; });
    const std::filesystem::path stem = directory / heat_map_stem(costs.integrator, most_threads->threads);
    write_image(stem.string() + ".exr", both, {.depth = PixelDepth::Float, .channel_names = {"rays", "cpu_seconds"}});
    write_image(stem.string() + ".png", picture, {.depth = PixelDepth::UInt8});
    most_threads->heat_map = stem.filename().string() + ".exr";
    most_threads->heat_map_high = static_cast<double>(*high);
    images[heat_map_key(*most_threads)] = encode_png(picture);
}

/// Throws SceneError if the runs that `report` is to have cannot be compared.
void require_comparable(const ProfileBaseline& baseline, const ProfileReport& report, const ProfileArguments& arguments,
                        const std::vector<int>& threads) {
    ProfileReport planned = report;
    for (const std::string& integrator : arguments.integrators)
        for (const int count : threads) planned.runs.push_back({.integrator = integrator, .threads = count});
    const std::string refusal = refusal_to_compare(baseline, planned);
    if (!refusal.empty()) throw SceneError({arguments.against, {}}, refusal);
}

/// Names of those of earlier profiles; none if there is no such directory.
std::vector<std::string> heat_maps_in(const std::filesystem::path& directory) {
    const auto is_number = [](std::string_view text) {
        return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
    };
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(directory, none)) {
        const std::string extension = entry.path().extension().string();
        if (!entry.is_regular_file(none) || (extension != ".exr" && extension != ".png")) continue;
        const std::string stem = entry.path().stem().string();
        const bool is_ours = std::ranges::any_of(integrator_names(), [&](const std::string& integrator) {
            const std::string start = fmt::format("heat-{}-", integrator);
            return stem.starts_with(start) && is_number(std::string_view(stem).substr(start.size()));
        });
        if (is_ours) names.push_back(entry.path().filename().string());
    }
    return names;
}

ExitCode run_profile(const ProfileArguments& arguments) {
    ProfileReport report;
    std::optional<ProfileBaseline> baseline;
    if (!arguments.against.empty()) baseline = parse_profile(read_text(arguments.against), arguments.against);
    const FlushDenormals flush_denormals;
    const ColorConfig colors = ColorConfig::from_environment();
    const std::vector<int> threads = thread_counts(arguments);
    const ThreadPool all(std::ranges::max(threads));
    const LoadedScene loaded(arguments, colors, all, report);
    describe(report, arguments, loaded.settings, *loaded.world);
    if (baseline) require_comparable(*baseline, report, arguments, threads);
    require_acceleratable(*loaded.world, accelerator_kinds(arguments.accelerators.names));
    report.history = read_history(arguments.history, report);
    const std::filesystem::path directory = arguments.output;
    std::vector<std::string> names{kData, "trace.json", "index.html", "profile.csv"};
    for (const std::string& name : accelerator_pictures(arguments.accelerators)) names.push_back(name);
    for (const std::string& name : heat_maps_in(directory)) names.push_back(name);
    for (const std::string& integrator : arguments.integrators)
        for (const int count : threads)
            for (const char* extension : {".exr", ".png"})
                names.push_back(heat_map_stem(integrator, count) + extension);
    const std::vector<std::filesystem::path> files = prepare_directory(directory, names, loaded.inputs);
    time_first_pixels(*loaded.world, loaded.settings, arguments, all, report);

    const ProfileRequest request{.integrators = arguments.integrators,
                                 .threads = threads,
                                 .seconds = arguments.seconds.value_or(kSecondsPerRun),
                                 .spp = arguments.overrides.spp(),
                                 .repetitions = arguments.repetitions,
                                 .quiet = arguments.quiet};
    ProfileRuns measured = measure_runs(*loaded.world, loaded.names, loaded.settings, request);
    if (measured.interrupted) return interrupt_exit_code();
    report.runs = std::move(measured.runs);
    note_costly_stamps(report);
    note_other_work(report);
    describe_memory(report, *loaded.world, measured);
    if (baseline) report.against = compare_profiles(*baseline, report, {.tolerance = arguments.tolerance});
    ProfileImages images;
    const FilmSettings& film = loaded.settings.film;
    const auto compile = [&](SceneDesc scene) {
        ProblemList none;
        return ray_code().compile_world(std::move(scene), colors, loaded.working_space, all, none, {});
    };
    if (!measure_and_write_accelerators(*loaded.world, arguments.accelerators, measured.rays, film.width, film.height,
                                        compile, directory, report, images))
        return interrupt_exit_code();
    const auto write_report = [&] {
        write_text(files[0], to_json(report));
        write_text(files[1], to_chrome_trace(report));
        write_text(files[2], make_profile_page(report, images));
        write_text(files[3], to_csv(report));
    };
    // Those of runs that are made again are written anew.
    std::error_code ignored;  // one that stays is only one too many
    for (const std::string& name : heat_maps_in(directory)) std::filesystem::remove(directory / name, ignored);
    write_report();
    // What was measured must not be lost with pictures that cannot be written.
    std::exception_ptr failure;
    try {
        for (const CostMap& costs : measured.costs)
            write_costs(directory, make_render_options(loaded.settings).window, costs, report, images);
        write_report();
    } catch (const std::exception&) {
        failure = std::current_exception();
    }
    if (arguments.json)
        print_data(to_json(report));
    else if (!arguments.quiet)
        print_text(to_table(report));
    if (failure) std::rethrow_exception(failure);
    if (!arguments.quiet) log_info("{}", files[2].string());
    if (!report.against || !report.against->has_regression()) return ExitCode::Success;
    log_error("error: {}: slower than that: {}", arguments.against, fmt::join(report.against->slower_runs(), ", "));
    return ExitCode::DiffFailed;
}

void add_profile_options(CLI::App& command, ProfileArguments& arguments) {
    add_scene_argument(command, arguments.scene);
    command
        .add_option("-o,--output", arguments.output,
                    "Directory for profile.json, profile.csv, index.html, trace.json and heat maps; made if it is "
                    "missing")
        ->required()
        ->check(CLI::Validator([](const std::string& text) { return std::string(text.empty() ? "it is empty" : ""); },
                               "DIR"));
    command
        .add_option("--integrators", arguments.integrators,
                    "Algorithms to measure, separated by commas (default: path,bdpt)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember(integrator_names()));
    command
        .add_option("--threads", arguments.threads,
                    "Numbers of threads to measure each on, separated by commas (default: 1 and one per processor)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(1, 4096));
    command
        .add_option("--repeat", arguments.repetitions,
                    "Repetitions of each integrator on each number of threads (default: 5)")
        ->check(CLI::Range(1, 1000));
    auto* against = command
                        .add_option("--against", arguments.against,
                                    "An earlier profile.json: exit code 1 if any run takes significantly more "
                                    "processor time")
                        ->check(CLI::ExistingFile);
    command
        .add_option("--tolerance", arguments.tolerance,
                    "How much slower counts as none for --against, as a share of the time (default: 0.02, which is 2%)")
        ->check(real_range(0.0, 10.0))
        ->needs(against);
    add_accelerator_options(command, arguments.accelerators);
    command
        .add_option("--history", arguments.history,
                    "An earlier profile.json of the same work, to be shown with this one on the page; may be repeated")
        ->allow_extra_args(false)
        ->check(CLI::ExistingFile);
    command.add_flag("--quiet", arguments.quiet, "No progress, notes or tables; errors only");
    command.add_flag("--json", arguments.json, "Print profile.json on stdout in place of the tables");
}

void set_profile_groups(CLI::App& command) {
    set_group(command, "What is measured",
              {"--integrators", "--threads", "--time", "--repeat", "--accelerators", "--growth"});
    set_group(command, "What it is compared with", {"--against", "--tolerance", "--history"});
    set_group(command, "What is said", {"--quiet", "--json"});
    command.get_option("--spp")->description("Samples per pixel of each repetition, in place of --time");
}

void require_different_names(const std::vector<std::string>& names) {
    std::set<std::string> known;
    for (const std::string& name : names)
        if (!known.insert(name).second) throw CLI::ValidationError("--integrators", "'" + name + "' is named twice");
}

void require_useful_baseline(const ProfileArguments& arguments) {
    if (arguments.against.empty()) return;
    if (arguments.repetitions < 2)
        throw CLI::ValidationError("--against", "takes --repeat 2 or more: of one repetition nothing can be concluded");
}

}  // namespace

void add_profile_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<ProfileArguments>();
    CLI::App* command =
        app.add_subcommand("profile", "Measure where the time of a render goes, and how fast Embree alone would be");
    add_profile_options(*command, *arguments);
    add_settings_options(*command, arguments->overrides);
    replace_time_option(*command, arguments->seconds,
                        "Time of each repetition, in seconds, about; --spp says how many samples instead (default: 1)");
    hide_options(*command, kRefusedOptions);
    set_profile_groups(*command);
    command->footer(
        "Repetitions of all runs take turns. A last one of each has its stages timed and some of its rays recorded,\n"
        "which bare Embree then traces again: what it needs for them, over what the render took, is the efficiency.\n"
        "trace.json opens in Perfetto or chrome://tracing. Other options override render.json.\n"
        "Exit code 1 if --against finds a run that has become slower, 3 if the two profiles are of different work.\n\n"
        "Examples:\n"
        "  etendue profile scenes/cornell-box -o profile\n"
        "  etendue profile scenes/caustic-glass --integrators bdpt --threads 1,2 --time 5 -o profile\n"
        "  etendue profile scenes/diamond --accelerators embree,bvh,kdtree,grid,brute --growth 100000 -o profile\n"
        "  etendue profile scenes/cornell-box --against before/profile.json --repeat 15 -o after");
    command->callback([arguments, command, &action] {
        refuse_options(*command, kRefusedOptions);
        if (arguments->overrides.spp() && arguments->seconds)
            throw CLI::ValidationError("--time", "cannot be given with --spp: one of them ends a render");
        require_different_names(arguments->integrators);
        if (std::set(arguments->threads.begin(), arguments->threads.end()).size() != arguments->threads.size())
            throw CLI::ValidationError("--threads", "a number of threads is given twice");
        const std::vector<const CLI::Option*> all = std::as_const(*command).get_options();
        arguments->command = command_line("etendue profile", given_options(all));
        require_useful_baseline(*arguments);
        action = [arguments] { return run_profile(*arguments); };
    });
}

}  // namespace etendue
