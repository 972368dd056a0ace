// etendue: the command line.
#include "app/commands.h"
#include "app/interrupt.h"
#include "app/usage_error.h"
#include "core/error.h"
#include "core/log.h"
#include "film/film.h"
#include "output/software_name.h"
#include "processor/ray_code.h"

#include <algorithm>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace etendue;

/// Runs `action` and turns what it throws into messages and exit codes.
ExitCode run(const Action& action) {
    try {
        return action();
    } catch (const SceneError& error) {
        log_error("{}", error.what());
        return ExitCode::InvalidScene;
    } catch (const UsageError& error) {
        log_error("error: {}", error.what());
        return ExitCode::UsageError;
    } catch (const std::bad_alloc&) {
        log_error("error: there is not enough memory; a smaller --size or --crop needs less: {} bytes a pixel",
                  sizeof(PixelSum));
        return ExitCode::RenderFailed;
    } catch (const std::exception& error) {
        log_error("error: {}", error.what());
        return ExitCode::RenderFailed;
    }
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Etendue renders glTF 2.0 scenes to colour-managed EXR images.");
    app.name("etendue");
    std::string_view instruction_set;
    try {
        instruction_set = instruction_set_name(ray_code().instruction_set);
    } catch (const std::invalid_argument& error) {
        log_error("error: {}", error.what());
        return static_cast<int>(ExitCode::UsageError);
    }
    app.set_version_flag("--version", fmt::format("{} ({})", software_name(), instruction_set));
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 success, 1 rendering failed for at least one scene or images differ too much, 2 usage error,\n"
        "3 invalid scene, settings or images, 4 submitted images are not ready yet, 130/143 interrupted.\n\n"
        "Examples:\n"
        "  etendue render scenes/cornell-box\n"
        "  etendue batch scenes --quality draft -o out\n"
        "  etendue inspect model.glb\n"
        "  etendue diff box.exr reference.exr --metric flip --map flip.png\n"
        "  etendue view box.exr -o box.png --exposure 1\n"
        "  etendue compare scenes/caustic-glass --integrators path,bdpt -o report\n"
        "  etendue profile scenes/cornell-box -o profile\n"
        "  etendue denoise noisy.exr -o box.exr\n"
        "  etendue merge a.partial b.partial -o box.exr\n"
        "  etendue submit scenes -o /shared/out --scheduler slurm\n\n"
        "'etendue COMMAND --help' tells more.");
    Action action;
    add_render_command(app, action);
    add_batch_command(app, action);
    add_inspect_command(app, action);
    add_denoise_command(app, action);
    add_diff_command(app, action);
    add_view_command(app, action);
    add_compare_command(app, action);
    add_profile_command(app, action);
    add_merge_command(app, action);
    add_submit_command(app, action);
    // CLI11 would only say that a command is missing.
    if (argc > 1 && argv[1][0] != '-') {
        const std::vector<CLI::App*> commands = app.get_subcommands({});
        std::vector<std::string> names;
        names.reserve(commands.size());
        for (const CLI::App* command : commands) names.push_back(command->get_name());
        if (std::ranges::find(names, argv[1]) == names.end()) {
            const std::vector<std::string_view> known(names.begin(), names.end());
            log_error("error: there is no command '{}'; {}", argv[1], name_hint(argv[1], known));
            return static_cast<int>(ExitCode::UsageError);
        }
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error);
        return code == 0 ? 0 : static_cast<int>(ExitCode::UsageError);
    }
    install_interrupt_handlers();
    return static_cast<int>(run(action));
}
