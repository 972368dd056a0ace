// etendue live: a scene to look around in, in a browser.
#include "cli/command_options.h"
#include "cli/commands.h"
#include "cli/settings_options.h"
#include "live/explorer.h"
#include "live/explorer_page.h"
#include "live/tev_viewer.h"
#include "session/interrupt.h"
#include "session/prepared_scene.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace etendue {

namespace {

struct LiveArguments {
    std::string scene;
    SettingsOverrides overrides;
    int port = 0;
    std::optional<TevAddress> tev;
    int threads = 0;
    std::vector<GivenOption> given;  ///< options that `render` understands, too
};

ExitCode run_live(const LiveArguments& arguments) {
    const ThreadPool threads(arguments.threads);
    std::optional<TevViewer> tev;
    if (arguments.tev) tev.emplace(*arguments.tev);
    Explorer::TakeImage take;
    if (tev)
        take = [&tev](const std::string& name, const OutputFrame& frame) {
            tev->show(name, frame);
            return !tev->is_lost();
        };
    std::optional<NothingToKeep> while_reading(std::in_place);
    Explorer explorer(prepare_scene(arguments.scene, arguments.overrides), arguments.given, threads, std::move(take));
    while_reading.reset();
    ExplorerPage page(arguments.port, explorer);
    explorer.run([&] { return page.is_ended() || interrupt_requested(); });
    return page.is_ended() ? ExitCode::Success : interrupt_exit_code();
}

}  // namespace

void add_live_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<LiveArguments>();
    CLI::App* command =
        app.add_subcommand("live", "Look around in a scene in a browser, with one integrator or two side by side");
    add_scene_argument(*command, arguments->scene);
    command
        ->add_option("--port", arguments->port,
                     "Port of 127.0.0.1 that the page is on; 0 (default) for one that is free")
        ->check(CLI::Range(0, 65535));
    add_tev_option(*command, arguments->tev, "Send the images, too,");
    add_settings_options(*command, arguments->overrides);
    add_threads_option(*command, arguments->threads);
    command->footer(
        "A line on stderr has the address of the page. The page moves the camera, chooses integrators and shows the\n"
        "command that renders what it shows. The program ends with the page's button or Ctrl-C, and writes no file.\n\n"
        "Examples:\n"
        "  etendue live scenes/cornell-box\n"
        "  etendue live scenes/caustic-glass --integrator bdpt --size 640x360\n"
        "  etendue live model.glb --environment studio.hdr --port 8080\n"
        "  etendue live scenes/cornell-box --tev 127.0.0.1:14158");
    command->callback([arguments, command, &action] {
        const std::vector<const CLI::Option*> all = std::as_const(*command).get_options();
        arguments->given = without(without(given_options(all), "--port"), "--tev");
        action = [arguments] { return run_live(*arguments); };
    });
}

}  // namespace etendue
