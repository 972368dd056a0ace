// etendue render: one scene.
#include "app/commands.h"
#include "app/image_job.h"
#include "app/interrupt.h"
#include "app/progress_display.h"
#include "app/scene_render.h"
#include "core/log.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

struct RenderArguments {
    SceneRenderRequest request;
    std::string scene;
    std::string output;
    int threads = 0;
    bool force = false;
    bool json = false;
};

void report(const std::filesystem::path& output, const RenderStatistics& s) {
    const double seconds = std::max(s.render.wall, 1e-9);
    log_info("{}: {}x{}, {} spp in {} ({:.2f} Msamples/s, {:.1f} Mrays/s){}", output.string(), s.width, s.height,
             s.spp_done, format_duration(s.render.wall), static_cast<double>(s.samples) / seconds * 1e-6,
             static_cast<double>(s.rays.total()) / seconds * 1e-6,
             s.complete ? "" : fmt::format(", incomplete: {}", s.halt_reason));
}

/// One image: rendered whether or not it is up to date.
ExitCode render_image(const RenderArguments& arguments, const ThreadPool& threads) {
    const SceneRenderResult result =
        render_scene(prepare_scene(arguments.scene, arguments.request.overrides), arguments.request, threads);
    if (!arguments.request.quiet) report(result.output, result.statistics);
    if (arguments.json) std::fputs(to_json(result.statistics).c_str(), stdout);
    return result.interrupted ? interrupt_exit_code() : ExitCode::Success;
}

/// A sequence: what an earlier run has finished is left as it is.
ExitCode render_frames(const RenderArguments& arguments, const std::vector<ImageJob>& jobs, const ThreadPool& threads) {
    const bool quiet = arguments.request.quiet;
    std::vector<ImageResult> results;
    for (std::size_t i = 0; i < jobs.size() && !interrupt_requested(); ++i) {
        const std::string title = fmt::format("[{}/{}] {}", i + 1, jobs.size(), jobs[i].name);
        ImageResult result = run_job(
            jobs[i],
            {.overrides = arguments.request.overrides, .force = arguments.force, .quiet = quiet, .title = title},
            threads);
        if (!quiet && result.outcome == ImageOutcome::UpToDate)
            log_info("{}: up to date", result.job.output.string());
        else if (!quiet)
            report(result.job.output, result.statistics);
        // Statistics of many frames are kept only for those who want them.
        if (arguments.json) results.push_back(std::move(result));
    }
    if (arguments.json) std::fputs(to_json(results).c_str(), stdout);
    return interrupt_requested() ? interrupt_exit_code() : ExitCode::Success;
}

ExitCode run_render(const RenderArguments& arguments) {
    const ThreadPool threads(arguments.threads);
    const std::string name = scene_name(arguments.scene);
    const std::filesystem::path output =
        arguments.output.empty() ? std::filesystem::path(name + ".exr") : arguments.request.output;
    const std::vector<ImageJob> jobs = image_jobs(arguments.scene, output, name, arguments.request.overrides);
    if (jobs.front().frame && !arguments.request.strategies.output.empty())
        throw SceneError({"--strategies-image", {}},
                         "it shows one image, and this is a sequence of frames: name the moment with --time-code");
    return jobs.front().frame ? render_frames(arguments, jobs, threads) : render_image(arguments, threads);
}

}  // namespace

void add_render_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<RenderArguments>();
    CLI::App* command = app.add_subcommand(
        "render", "Render one scene to NAME.exr, NAME.png and NAME.json, or its frames to NAME.0001.exr ...");
    command->add_option("scene", arguments->scene, "Scene directory, .gltf or .glb")->required();
    command->add_option("-o,--output", arguments->output,
                        "EXR file to write; PNG and JSON go beside it (default: NAME.exr in the current directory). "
                        "Frames of a sequence have their number in place of #### or before the extension");
    arguments->request.overrides.add_options(*command);
    command->add_option("--threads", arguments->threads, "Threads to use (default: one per processor)")
        ->check(CLI::Range(1, 4096));
    auto* strategies = command->add_option_function<std::string>(
        "--strategies-image", [arguments](const std::string& path) { arguments->request.strategies.output = path; },
        "Also write the images of all strategies of bdpt, one by one: an EXR with a part for each and a labelled PNG. "
        "They stay in memory until all are rendered, about 24 bytes a pixel and strategy, with --float 32");
    command
        ->add_option("--strategies-depth", arguments->request.strategies.longest,
                     "Longest paths whose strategies are shown (default: 8, or --max-depth if that is less)")
        ->check(CLI::Range(1, 64))
        ->needs(strategies);
    command
        ->add_flag_callback(
            "--strategies-unweighted", [arguments] { arguments->request.strategies.weighted = false; },
            "Show each as if it were the only one")
        ->needs(strategies);
    command->add_flag("--force", arguments->force, "Of a sequence, render again what is up to date");
    command->add_flag("--quiet", arguments->request.quiet, "No progress, notes or warnings; errors only");
    command->add_flag("--json", arguments->json, "Print the statistics as JSON on stdout; of a sequence, an array");
    command->footer(
        "Options override render.json. Of a sequence, frames that are newer than all of their inputs and were made "
        "with\n"
        "the same settings are skipped: what was interrupted goes on when it is started again.\n\n"
        "Examples:\n"
        "  etendue render scenes/cornell-box -o box.exr\n"
        "  etendue render scenes/cornell-box --quality draft --integrator naive --seed 7\n"
        "  etendue render model.glb --environment studio.hdr --size 800x600 --spp 256 --exposure 0.5\n"
        "  etendue render fox.glb --time-code 0.35 --animation Run\n"
        "  etendue render fox.glb --frames 0:23 --fps 30 -o run/fox.####.exr --shutter 0:0.0167\n"
        "  etendue render scenes/caustic-glass --integrator bdpt --strategies-image pyramid.exr --strategies-depth 5\n"
        "  etendue render scenes/veach-mis --crop 100,100,200,200 --time 60 --json --quiet");
    command->callback([arguments, &action] {
        action = [arguments] {
            arguments->request.scene = arguments->scene;
            arguments->request.output = arguments->output;
            const std::filesystem::path& pyramid = arguments->request.strategies.output;
            for (const auto& [option, path] :
                 {std::pair{"--output", arguments->request.output}, std::pair{"--strategies-image", pyramid}})
                if (!path.empty() && path.extension() != ".exr") {
                    log_error("error: {} '{}' must end in .exr", option, path.string());
                    return ExitCode::UsageError;
                }
            return run_render(*arguments);
        };
    });
}

}  // namespace etendue
