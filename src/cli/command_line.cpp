#include "cli/command_line.h"

#include "cli/command_help.h"
#include "cli/help_text.h"
#include "core/error.h"
#include "output/software_name.h"
#include "processor/ray_code.h"
#include "session/usage_error.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

std::unique_ptr<CLI::App> make_command_line(Action& action) {
    auto app = std::make_unique<CLI::App>("Etendue renders glTF 2.0 scenes to colour-managed EXR images.");
    app->name("etendue");
    app->formatter_fn([](const CLI::App* shown, const std::string& name, CLI::AppFormatMode) {
        const CommandHelp help = describe_command(*shown);
        std::string usage = name + " [OPTIONS]";
        for (const OptionHelp& argument : help.arguments) usage += " " + argument.names.front();
        if (!help.commands.empty()) usage += " SUBCOMMAND";
        return help_text(help, usage, help_width());
    });
    app->set_version_flag("--version",
                          fmt::format("{} ({})", software_name(), instruction_set_name(ray_code().instruction_set)));
    app->require_subcommand(1);
    app->footer(
        "Exit codes: 0 success, 1 rendering failed for at least one scene, images differ too much, or a run is slower "
        "than\n"
        "that of --against, 2 usage error, 3 invalid scene, settings or images, 4 submitted images are not ready yet, "
        "130/143 interrupted.\n\n"
        "Examples:\n"
        "  etendue render scenes/cornell-box\n"
        "  etendue batch scenes --quality draft -o out\n"
        "  etendue live scenes/cornell-box\n"
        "  etendue inspect model.glb\n"
        "  etendue diff box.exr reference.exr --metric flip --map flip.png\n"
        "  etendue view box.exr -o box.png --exposure 1\n"
        "  etendue compare scenes/caustic-glass --integrators path,bdpt -o report\n"
        "  etendue profile scenes/cornell-box -o profile\n"
        "  etendue denoise noisy.exr -o box.exr\n"
        "  etendue merge a.partial b.partial -o box.exr\n"
        "  etendue submit scenes -o /shared/out --scheduler slurm\n\n"
        "'etendue help COMMAND' tells more.");
    add_render_command(*app, action);
    add_batch_command(*app, action);
    add_live_command(*app, action);
    add_inspect_command(*app, action);
    add_denoise_command(*app, action);
    add_diff_command(*app, action);
    add_view_command(*app, action);
    add_compare_command(*app, action);
    add_profile_command(*app, action);
    add_merge_command(*app, action);
    add_submit_command(*app, action);
    add_help_command(*app, action);
    return app;
}

void require_command(const CLI::App& app, const std::string& name) {
    const std::vector<const CLI::App*> commands = app.get_subcommands({});
    std::vector<std::string> names;
    names.reserve(commands.size());
    for (const CLI::App* command : commands) names.push_back(command->get_name());
    if (std::ranges::find(names, name) != names.end()) return;
    const std::vector<std::string_view> known(names.begin(), names.end());
    throw UsageError(fmt::format("there is no command '{}'; {}", name, name_hint(name, known)));
}

}  // namespace etendue
