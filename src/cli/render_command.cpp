// etendue render: one scene.
#include "cli/command_options.h"
#include "cli/commands.h"
#include "cli/settings_options.h"
#include "core/log.h"
#include "core/standard_output.h"
#include "farm/probe.h"
#include "live/render_page.h"
#include "live/tev_viewer.h"
#include "loader/files.h"
#include "picture/aov_sources.h"
#include "picture/output_paths.h"
#include "render/checkpoint.h"
#include "session/image_job.h"
#include "session/interrupt.h"
#include "session/progress_display.h"
#include "session/progress_pipe.h"
#include "session/scene_render.h"
#include "session/usage_error.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

struct RenderArguments {
    SceneRenderRequest job;
    std::string scene;
    std::filesystem::path output;
    std::optional<int> first_frame;  ///< first frame of a sequence that is rendered in part
    int threads = 0;
    bool force = false;
    bool probe = false;
    bool json = false;
    std::string live;  ///< as `live_port` reads it
    std::optional<TevAddress> tev;
};

void report(const std::filesystem::path& output, const RenderStatistics& s) {
    if (s.samples == 0) return log_info("{}: interrupted before anything was rendered", output.string());
    const double seconds = std::max(s.render.wall, 1e-9);
    const std::string spp = s.adaptive ? fmt::format("{} to {} spp, {:.0f} on average,", s.adaptive->least,
                                                     s.adaptive->most, s.adaptive->mean)
                                       : fmt::format("{} spp", s.spp_done);
    log_info("{}: {}x{}, {} in {} ({:.2f} Msamples/s, {:.1f} Mrays/s){}{}", output.string(), s.width, s.height, spp,
             format_duration(s.render.wall), static_cast<double>(s.samples) / seconds * 1e-6,
             static_cast<double>(s.rays.total()) / seconds * 1e-6,
             s.relative_error ? fmt::format(", relative error about {:.2g}", *s.relative_error) : "",
             s.complete ? "" : fmt::format(", incomplete: {}", s.halt_reason));
}

/// NAME.exr, or NAME.partial if it is to be part of an image.
std::filesystem::path default_output(const RenderArguments& arguments, std::string name) {
    // In an output's name, a '#' stands for the frame's number.
    std::ranges::replace(name, '#', '_');
    const auto& samples = arguments.job.samples;
    return samples ? fmt::format("{}.{}-{}.partial", name, samples->begin, samples->end) : name + ".exr";
}

/// Returns the statistics of the only image as JSON text: for an image that is up to date, those of the earlier render.
std::string statistics_of(const ImageResult& result) {
    if (result.outcome != ImageOutcome::UpToDate || is_partial(result.job.output)) return to_json(result.statistics);
    const std::vector<unsigned char> bytes = read_bytes(OutputPaths::beside(result.job.output).json, kMaxJsonBytes);
    return {bytes.begin(), bytes.end()};
}

/// One image is rendered whether or not it is up to date, unless it is gone on with. Of a sequence, what an earlier run
/// has finished is left as it is.
ExitCode render_jobs(const RenderArguments& arguments, const std::vector<ImageJob>& jobs) {
    const ThreadPool threads(arguments.threads);
    const bool is_sequence = jobs.front().frame.has_value();
    const bool quiet = arguments.job.quiet;
    std::optional<RenderPage> page;
    if (const auto port = live_port(arguments.live)) page.emplace(*port);
    std::optional<TevViewer> tev;
    if (arguments.tev) tev.emplace(*arguments.tev);
    std::vector<ImageResult> results;
    std::set<std::string> told;
    std::optional<SomethingToKeep> kept_from_signals;
    bool has_refused = false;
    for (std::size_t i = 0; i < jobs.size() && !interrupt_requested(); ++i) {
        SceneRenderRequest request = arguments.job;
        request.force = arguments.force || (!is_sequence && !arguments.job.resume);
        if (is_sequence) request.title = fmt::format("[{}/{}] {}", i + 1, jobs.size(), jobs[i].name);
        request.told = &told;
        if (page) request.watchers.push_back(&*page);
        if (tev) request.watchers.push_back(&*tev);
        ImageResult result{jobs[i], ImageOutcome::Failed, {}, {}};
        try {
            result = run_job(jobs[i], std::move(request), threads);
        } catch (const RefusedCheckpoint& error) {
            // Later frames of the sequence may still be able to resume.
            if (!is_sequence) throw;
            has_refused = true;
            result.error = error.what();
            log_error("{}", error.what());
        }
        if (!quiet && result.outcome == ImageOutcome::UpToDate)
            log_info("{}: up to date", result.job.output.string());
        else if (!quiet && result.outcome != ImageOutcome::Failed)
            report(result.job.output, result.statistics);
        // Statistics of many frames are kept only for those who want them.
        if (!arguments.json) continue;
        results.push_back(std::move(result));
        if (!kept_from_signals) kept_from_signals.emplace();
    }
    // An interrupt may have come before the first.
    if (arguments.json && (is_sequence || !results.empty()))
        print_data(is_sequence ? to_json(results) : statistics_of(results.front()));
    if (interrupt_requested()) return interrupt_exit_code();
    return has_refused ? ExitCode::InvalidScene : ExitCode::Success;
}

ExitCode run_render(const RenderArguments& arguments) {
    const NothingToKeep before_images;
    const std::string name = scene_name(arguments.scene);
    const std::filesystem::path output = arguments.output.empty() ? default_output(arguments, name) : arguments.output;
    std::vector<ImageJob> jobs = image_jobs(arguments.scene, output, name, arguments.job.overrides);
    if (arguments.first_frame)
        for (ImageJob& job : jobs) job.first_frame = arguments.first_frame;
    if (jobs.front().frame && !arguments.job.strategies.output.empty())
        throw SceneError({"--strategies-image", {}},
                         "it shows one image, and this is a sequence of frames: name the moment with --time-code");
    if (arguments.probe) {
        SettingsOverrides overrides = arguments.job.overrides;
        if (const auto& range = arguments.job.samples)
            overrides.give("--spp", std::to_string(range->end - range->begin));
        const std::string answer = probe(jobs.front(), overrides, ThreadPool(arguments.threads));
        // What was cut short says nothing about the image.
        if (interrupt_requested()) return interrupt_exit_code();
        print_data(answer);
        return ExitCode::Success;
    }
    return render_jobs(arguments, jobs);
}

/// Throws UsageError for names that cannot be.
void check_outputs(const RenderArguments& arguments) {
    const std::filesystem::path& output = arguments.output;
    const std::filesystem::path& pyramid = arguments.job.strategies.output;
    const bool partial = arguments.job.samples || is_partial(output);
    if (partial && !output.empty() && !is_partial(output))
        throw UsageError(
            fmt::format("--output '{}' must end in .partial: it holds a range of the samples, and "
                        "'etendue merge' makes the image",
                        output.string()));
    if (!partial && !output.empty() && output.extension() != ".exr")
        throw UsageError(
            fmt::format("--output '{}' must end in .exr, or in .partial for a part of an image to be "
                        "merged with others",
                        output.string()));
    if (!pyramid.empty() && pyramid.extension() != ".exr")
        throw UsageError(fmt::format("--strategies-image '{}' must end in .exr", pyramid.string()));
    if (partial && !pyramid.empty()) throw UsageError("--strategies-image shows an image, not a part of one");
    const std::optional<std::uint32_t> spp = arguments.job.overrides.spp();
    if (arguments.job.samples && spp && arguments.job.samples->end > *spp)
        throw UsageError(
            fmt::format("--samples {}:{} goes beyond the {} samples of --spp: a part has samples of the "
                        "image that --spp asks for, or leave --spp out",
                        arguments.job.samples->begin, arguments.job.samples->end, *spp));
    if (partial && (arguments.job.overrides.has("/time") || arguments.job.overrides.has("/error")))
        throw UsageError("--time and --error end an image; a part of one has the samples that --samples names");
}

/// "0:64" to that range. Throws CLI::ValidationError.
SampleRange parse_sample_range(const std::string& text) {
    constexpr std::uint32_t kMost = 1u << 24;
    SampleRange range;
    const char* const end = text.data() + text.size();
    const auto [colon, first_error] = std::from_chars(text.data(), end, range.begin);
    if (first_error == std::errc{} && colon != end && *colon == ':') {
        const auto [rest, error] = std::from_chars(colon + 1, end, range.end);
        if (error == std::errc{} && rest == end && range.begin < range.end && range.end <= kMost) return range;
    }
    throw CLI::ValidationError("--samples",
                               fmt::format("'{}' is no A:B with 0 <= A < B <= {}: samples A to B - 1", text, kMost));
}

/// How to stop, to go on and to split.
void add_continuation_options(CLI::App& command, const std::shared_ptr<RenderArguments>& arguments) {
    command
        .add_option(
            "--checkpoint-every", arguments->job.checkpoint_minutes,
            "Minutes between checkpoints, NAME.checkpoint beside the image; 0 (default) for none but the one of "
            "an interrupted render")
        ->check(real_range(0.0, 1e6));
    command.add_flag(
        "--resume", arguments->job.resume,
        "Go on with the checkpoint, if there is one, to the same image bit for bit; leave an image or a part that is "
        "up to date");
    command.add_flag_callback(
        "--keep-sums", [arguments] { arguments->job.keep_sums_after = 0.0; },
        "Keep the sums of the finished image, NAME.sums: with --resume, more samples go on from them");
    command
        .add_option("--keep-sums-after", arguments->job.keep_sums_after,
                    "Keep the sums only of a render that takes at least so long, in seconds")
        ->check(real_range(0.0, 1e9));
    command.add_option_function<std::string>(
        "--samples", [arguments](const std::string& text) { arguments->job.samples = parse_sample_range(text); },
        "Render samples A to B-1 of every pixel, A:B, into a part of the image for 'etendue merge'");
    command.add_flag("--probe", arguments->probe,
                     "Render for about a second, write no file, and print as JSON what the image would take");
    command
        .add_option(
            "--progress-fd", arguments->job.progress_descriptor,
            "Write progress as JSON lines to this open file descriptor, in place of the bar. For a program that "
            "looks after this one: a second Ctrl-C or SIGTERM is then as the first, only SIGKILL ends at once")
        ->check(CLI::Range(3, 1 << 20));
}

void add_strategies_options(CLI::App& command, const std::shared_ptr<RenderArguments>& arguments) {
    auto* strategies = command.add_option_function<std::string>(
        "--strategies-image", [arguments](const std::string& path) { arguments->job.strategies.output = path; },
        "Also write the images of all strategies of bdpt, one by one: an EXR with a part for each and a labelled PNG. "
        "They stay in memory until all are rendered, about 24 bytes a pixel and strategy, with --float 32");
    command
        .add_option("--strategies-depth", arguments->job.strategies.longest,
                    "Longest paths whose strategies are shown (default: 8, or --max-depth if that is less)")
        ->check(CLI::Range(1, 64))
        ->needs(strategies);
    command
        .add_flag_callback(
            "--strategies-unweighted", [arguments] { arguments->job.strategies.weighted = false; },
            "Show each as if it were the only one")
        ->needs(strategies);
}

void set_render_groups(CLI::App& command) {
    set_group(command, "Going on and parts",
              {"--checkpoint-every", "--resume", "--keep-sums", "--keep-sums-after", "--samples", "--force"});
    set_group(command, "Strategies of bdpt and vcm",
              {"--strategies-image", "--strategies-depth", "--strategies-unweighted"});
}

std::string render_footer() {
    return "Options override render.json. Of a sequence, frames whose inputs have not changed and that were made with\n"
           "the same settings are skipped. Ctrl-C writes a checkpoint and the image so far, marked incomplete: "
           "--resume goes\n"
           "on from there. SIGUSR1 writes NAME.preview.png and goes on. --spp, --time and --error can be combined: the "
           "first\n"
           "that is reached ends the render.\n\n"
           "Examples:\n"
           "  etendue render scenes/cornell-box -o box.exr\n"
           "  etendue render scenes/cornell-box --live\n"
           "  etendue render scenes/cornell-box --tev 127.0.0.1:14158\n"
           "  etendue render scenes/cornell-box --quality draft --integrator naive --seed 7\n"
           "  etendue render model.glb --environment studio.hdr --size 800x600 --spp 256 --exposure 0.5\n"
           "  etendue render model.glb --display 'Display P3 - Display' --look 'ACES 1.3 Reference Gamut Compression'\n"
           "  etendue render model.glb -o plate.exr --aces-container\n"
           "  etendue render fox.glb --time-code 0.35 --animation Run\n"
           "  etendue render fox.glb --frames 0:23 --fps 30 -o run/fox.####.exr --shutter 0:0.0167\n"
           "  etendue render scenes/caustic-glass --integrator bdpt --strategies-image pyramid.exr --strategies-depth "
           "5\n"
           "  etendue render scenes/cornell-box --spp 65536 --error 0.02 --checkpoint-every 10 --resume\n"
           "  etendue render scenes/cornell-box --samples 0:128 -o a.partial   # and 128:256 elsewhere, then 'merge'\n"
           "  etendue render scenes/caustic-glass --robust mon:7 --aov mean --brightest 20\n"
           "  etendue render scenes/caustic-glass --integrator bdpt --aov passes --aov 'caustics=lpe:C D S+ L'\n"
           "  etendue render scenes/veach-mis --crop 100,100,200,200 --time 60 --json --quiet\n\n"
           "Layers for --aov:\n" +
           list_aov_sources();
}

}  // namespace

void add_render_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<RenderArguments>();
    CLI::App* command = app.add_subcommand(
        "render", "Render one scene to NAME.exr, NAME.png and NAME.json, or its frames to NAME.0001.exr ...");
    add_scene_argument(*command, arguments->scene);
    command
        ->add_option("-o,--output", arguments->output,
                     "EXR file to write; PNG and JSON go beside it (default: NAME.exr in the current directory). "
                     "Frames of a sequence have their number in place of #### or before the extension. A .partial "
                     "holds a part of an image (a range of --samples, or a --crop) for 'etendue merge'")
        // As a script gives it whose variable is not set: the default would be somewhere else.
        ->check([](const std::string& path) { return path.empty() ? std::string("'' is not a file name") : ""; });
    add_settings_options(*command, arguments->job.overrides);
    add_png_option(*command, arguments->job.overrides);
    command
        ->add_option(
            "--first-frame", arguments->first_frame,
            "First frame of the whole sequence, if --frames is only a part of it. 'auto' chooses the integrator "
            "at that frame (default: the first of --frames)")
        ->check(CLI::Range(-999999, 999999));
    add_threads_option(*command, arguments->threads);
    add_continuation_options(*command, arguments);
    add_strategies_options(*command, arguments);
    command->add_flag(
        "--force", arguments->force,
        "Render finished frames and images again, and replace any part; with --resume, a checkpoint is still gone on "
        "with");
    add_tev_option(*command, arguments->tev, "Send the image as it grows, with its layers,");
    add_live_option(*command, arguments->live, "Show the image in a browser as it grows");
    command->add_flag("--quiet", arguments->job.quiet, "No progress, notes or warnings; errors only");
    command->add_flag("--json", arguments->json, "Print the statistics as JSON on stdout; of a sequence, an array");
    command->footer(render_footer());
    set_render_groups(*command);
    command->callback([arguments, command, &action] {
        // A PNG is written beside each image, and who asks for it gets it.
        std::filesystem::path& output = arguments->output;
        if (output.extension() == ".png" && !arguments->job.samples && arguments->job.overrides.png)
            output.replace_extension(".exr");
        const std::vector<const CLI::Option*> all = std::as_const(*command).get_options();
        arguments->job.command = command_line("etendue render", given_options(all));
        action = [arguments] {
            check_outputs(*arguments);
            if (arguments->job.progress_descriptor >= 0) {
                require_progress_reader(arguments->job.progress_descriptor);
                take_all_interrupts_for_one();
            }
            return run_render(*arguments);
        };
    });
}

}  // namespace etendue
