// etendue help: what --help says, of the program or of a command.
#include "cli/command_line.h"
#include "cli/commands.h"
#include "core/standard_output.h"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

namespace etendue {

namespace {

/// Returns what --help prints for `command`, or for the program if `command` is empty, from a command line of its own,
/// because CLI11 words help for the command that was parsed last.
std::string help_text(const std::string& command) {
    Action none;
    const std::unique_ptr<CLI::App> app = make_command_line(none);
    if (command.empty()) return app->help();
    require_command(*app, command);
    return app->get_subcommand(command)->help(app->get_name());
}

}  // namespace

void add_help_command(CLI::App& app, Action& action) {
    auto name = std::make_shared<std::string>();
    CLI::App* command = app.add_subcommand("help", "Print what --help prints, of the program or of a command");
    command->add_option("COMMAND", *name, "Command to tell of (default: the program)");
    command->footer(
        "Examples:\n"
        "  etendue help\n"
        "  etendue help render");
    command->callback([name, &action] {
        action = [name] {
            print_text(help_text(*name));
            return ExitCode::Success;
        };
    });
}

}  // namespace etendue
