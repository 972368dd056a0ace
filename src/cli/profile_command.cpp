// etendue profile: where the time of a render goes, next to what bare Embree needs for its rays.
#include "cli/command_options.h"
#include "cli/commands.h"
#include "cli/profile_accelerators.h"
#include "cli/profile_description.h"
#include "cli/profile_heat_maps.h"
#include "cli/settings_options.h"
#include "core/log.h"
#include "core/process_time.h"
#include "core/standard_output.h"
#include "core/write_file.h"
#include "picture/render_setup.h"
#include "processor/ray_code.h"
#include "profile/profile_runs.h"
#include "render/progressive_render.h"
#include "report/profile_comparison.h"
#include "report/profile_figures.h"
#include "report/profile_report.h"
#include "session/interrupt.h"
#include "session/output_directory.h"
#include "session/phase_timer.h"
#include "session/prepared_scene.h"

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
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
        inputs = prepared.scene.files_to_keep();
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
    std::vector<std::filesystem::path> inputs;  ///< files that no output may replace, earlier profiles among them
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

/// Reads earlier profiles, the oldest first. Throws SceneError for one of other work.
std::vector<EarlierProfile> read_history(const std::vector<std::string>& files, const ProfileReport& now) {
    std::vector<EarlierProfile> history;
    for (const std::string& file : files) {
        const ProfileBaseline profile = parse_profile(read_text(file), file);
        if (const std::string difference = difference_of_work(profile, now, "the earlier profile"); !difference.empty())
            throw SceneError({file, {}}, difference);
        EarlierProfile& entry = history.emplace_back(EarlierProfile{file, profile.created, profile.program, {}});
        for (const ProfileRun& run : profile.runs)
            entry.runs.push_back({run.integrator, run.threads, cpu_seconds_per_sample(run)});
    }
    std::ranges::stable_sort(history, {}, &EarlierProfile::created);
    return history;
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

/// Returns the paths of what is written into the output directory, which is made: the report as JSON, as a trace, as a
/// page and as a table, and then pictures.
std::vector<std::filesystem::path> prepare_profile_files(const ProfileArguments& arguments,
                                                         const std::vector<int>& threads,
                                                         const std::vector<std::filesystem::path>& inputs) {
    const std::filesystem::path directory = arguments.output;
    std::vector<std::string> names{kData, "trace.json", "index.html", "profile.csv"};
    for (const std::vector<std::string>& pictures :
         {accelerator_pictures(arguments.accelerators), heat_maps_in(directory),
          heat_map_files(arguments.integrators, threads)})
        names.insert(names.end(), pictures.begin(), pictures.end());
    return prepare_directory(directory, names, inputs);
}

/// Measures the accelerators if that is asked for. Returns false if it was interrupted.
bool run_accelerators(const ProfileArguments& arguments, const LoadedScene& loaded, const RecordedRays& rays,
                      const ColorConfig& colors, const ThreadPool& threads, ProfileReport& report,
                      ProfileImages& images) {
    const auto compile = [&](SceneDesc scene) {
        ProblemList none;
        return ray_code().compile_world(std::move(scene), colors, loaded.working_space, threads, none, {});
    };
    const FilmSettings& film = loaded.settings.film;
    return measure_and_write_accelerators(*loaded.world, arguments.accelerators, rays, film.width, film.height, compile,
                                          arguments.output, report, images);
}

void write_report(const std::vector<std::filesystem::path>& files, const ProfileReport& report,
                  const ProfileImages& images) {
    write_text(files[0], to_json(report));
    write_text(files[1], to_chrome_trace(report));
    write_text(files[2], make_profile_page(report, images));
    write_text(files[3], to_csv(report));
}

/// Writes the maps in place of those of earlier profiles, and the report before and after. Returns what kept the maps
/// from being written, because what was measured must not be lost with pictures; null if nothing did.
std::exception_ptr write_with_heat_maps(const ProfileArguments& arguments,
                                        const std::vector<std::filesystem::path>& files, const PixelRect& window,
                                        const std::vector<CostMap>& costs, ProfileReport& report,
                                        ProfileImages& images) {
    const std::filesystem::path directory = arguments.output;
    std::error_code ignored;  // one that stays is only one too many
    for (const std::string& name : heat_maps_in(directory)) std::filesystem::remove(directory / name, ignored);
    const std::vector<std::string> drawn = accelerator_pictures(arguments.accelerators);
    for (const std::string& name : accelerator_pictures({.names = accelerator_names()}))
        if (std::ranges::find(drawn, name) == drawn.end()) std::filesystem::remove(directory / name, ignored);
    write_report(files, report, images);
    try {
        for (const CostMap& map : costs) write_heat_map(directory, window, map, report, images);
        write_report(files, report, images);
    } catch (const std::exception&) {
        return std::current_exception();
    }
    return nullptr;
}

/// Says which runs have become slower than those of --against, if any have.
ExitCode compare_with_earlier(const ProfileArguments& arguments, const ProfileReport& report) {
    if (!report.against || !report.against->has_regression()) return ExitCode::Success;
    const std::vector<std::string> slower = report.against->slower_runs();
    log_error("error: {} {} become slower than in {}", fmt::join(slower, ", "), slower.size() == 1 ? "has" : "have",
              arguments.against);
    return ExitCode::DiffFailed;
}

ExitCode run_profile(const ProfileArguments& arguments) {
    ProfileReport report{.command = arguments.command, .scene_path = arguments.scene};
    std::optional<ProfileBaseline> baseline;
    if (!arguments.against.empty()) baseline = parse_profile(read_text(arguments.against), arguments.against);
    const FlushDenormals flush_denormals;
    const ColorConfig colors = ColorConfig::from_environment();
    const std::vector<int> threads = thread_counts(arguments);
    const ThreadPool all(std::ranges::max(threads));
    const LoadedScene loaded(arguments, colors, all, report);
    describe(report, loaded.settings, *loaded.world);
    if (baseline) require_comparable(*baseline, report, arguments, threads);
    require_acceleratable(*loaded.world, accelerator_kinds(arguments.accelerators.names));
    report.history = read_history(arguments.history, report);
    const std::vector<std::filesystem::path> files = prepare_profile_files(arguments, threads, loaded.inputs);
    time_first_pixels(*loaded.world, loaded.settings, arguments, all, report);

    ProfileRuns measured = measure_runs(*loaded.world, loaded.names, loaded.settings,
                                        {.integrators = arguments.integrators,
                                         .threads = threads,
                                         .seconds = arguments.seconds.value_or(kSecondsPerRun),
                                         .spp = arguments.overrides.spp(),
                                         .repetitions = arguments.repetitions,
                                         .quiet = arguments.quiet});
    if (measured.interrupted) return interrupt_exit_code();
    report.runs = std::move(measured.runs);
    note_doubtful_runs(report);
    describe_memory(report, *loaded.world, measured);
    if (baseline) report.against = compare_profiles(*baseline, report, {.tolerance = arguments.tolerance});
    ProfileImages images;
    if (!run_accelerators(arguments, loaded, measured.rays, colors, all, report, images)) return interrupt_exit_code();
    const std::exception_ptr failure = write_with_heat_maps(
        arguments, files, make_render_options(loaded.settings).window, measured.costs, report, images);
    if (arguments.json)
        print_data(to_json(report));
    else if (!arguments.quiet)
        print_text(to_table(report));
    if (failure) std::rethrow_exception(failure);
    if (!arguments.quiet) log_info("{}", files[2].string());
    return compare_with_earlier(arguments, report);
}

void add_profile_options(CLI::App& command, ProfileArguments& arguments) {
    add_scene_argument(command, arguments.scene);
    add_directory_option(
        command, arguments.output,
        "Directory for profile.json, profile.csv, index.html, trace.json and heat maps; made if it is missing");
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
                    "--against ignores slowdowns up to this share of the time (default: 0.02, which is 2%)")
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
        require_different("--integrators", arguments->integrators);
        if (std::set(arguments->threads.begin(), arguments->threads.end()).size() != arguments->threads.size())
            throw CLI::ValidationError("--threads", "a number of threads is given twice");
        const std::vector<const CLI::Option*> all = std::as_const(*command).get_options();
        arguments->command = command_line("etendue profile", given_options(all));
        if (!arguments->against.empty() && arguments->repetitions < 2)
            throw CLI::ValidationError("--against",
                                       "takes --repeat 2 or more: of one repetition nothing can be concluded");
        action = [arguments] { return run_profile(*arguments); };
    });
}

}  // namespace etendue
