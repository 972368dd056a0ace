// etendue render: one scene.
#include "app/commands.h"
#include "app/interrupt.h"
#include "app/progress_display.h"
#include "app/scene_render.h"
#include "core/log.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

struct RenderArguments {
    SceneRenderRequest request;
    std::string scene;
    std::string output;
    int threads = 0;
    bool json = false;
};

void report(const SceneRenderResult& result) {
    const RenderStatistics& s = result.statistics;
    const double seconds = std::max(s.render.wall, 1e-9);
    log_info("{}: {}x{}, {} spp in {} ({:.2f} Msamples/s, {:.1f} Mrays/s){}", result.output.string(), s.width, s.height,
             s.spp_done, format_duration(s.render.wall), static_cast<double>(s.samples) / seconds * 1e-6,
             static_cast<double>(s.rays.total()) / seconds * 1e-6,
             s.complete ? "" : fmt::format(", incomplete: {}", s.halt_reason));
}

ExitCode run_render(const RenderArguments& arguments) {
    const ThreadPool threads(arguments.threads);
    const SceneRenderResult result =
        render_scene(prepare_scene(arguments.scene, arguments.request.overrides), arguments.request, threads);
    if (!arguments.request.quiet) report(result);
    if (arguments.json) std::fputs(to_json(result.statistics).c_str(), stdout);
    return result.interrupted ? interrupt_exit_code() : ExitCode::Success;
}

}  // namespace

void add_render_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<RenderArguments>();
    CLI::App* command = app.add_subcommand("render", "Render one scene to NAME.exr, NAME.png and NAME.json");
    command->add_option("scene", arguments->scene, "Scene directory, .gltf or .glb")->required();
    command->add_option("-o,--output", arguments->output,
                        "EXR file to write; PNG and JSON go beside it (default: NAME.exr in the current directory)");
    arguments->request.overrides.add_options(*command);
    command->add_option("--threads", arguments->threads, "Threads to use (default: one per processor)")
        ->check(CLI::Range(1, 4096));
    command->add_flag("--quiet", arguments->request.quiet, "No progress, notes or warnings; errors only");
    command->add_flag("--json", arguments->json, "Print the statistics as JSON on stdout");
    command->footer(
        "Options override render.json.\n\n"
        "Examples:\n"
        "  etendue render scenes/cornell-box -o box.exr\n"
        "  etendue render scenes/cornell-box --quality draft --integrator naive --seed 7\n"
        "  etendue render model.glb --environment studio.hdr --size 800x600 --spp 256 --exposure 0.5\n"
        "  etendue render fox.glb --time-code 0.35 --animation Run\n"
        "  etendue render scenes/veach-mis --crop 100,100,200,200 --time 60 --json --quiet");
    command->callback([arguments, &action] {
        action = [arguments] {
            arguments->request.scene = arguments->scene;
            arguments->request.output = arguments->output;
            if (!arguments->output.empty() && arguments->request.output.extension() != ".exr") {
                log_error("error: --output '{}' must end in .exr", arguments->output);
                return ExitCode::UsageError;
            }
            return run_render(*arguments);
        };
    });
}

}  // namespace etendue
