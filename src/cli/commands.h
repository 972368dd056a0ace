// The subcommands. To add another, see CONTRIBUTING.md (A subcommand).
#pragma once

#include "session/exit_code.h"

#include <functional>

namespace CLI {
class App;
}

namespace etendue {

/// Carries out what a parsed command line asks for; empty if no subcommand ran (--help, --version).
using Action = std::function<ExitCode()>;

// Each adds one subcommand to `app` and sets `action` when it is chosen.
void add_render_command(CLI::App& app, Action& action);
void add_batch_command(CLI::App& app, Action& action);
void add_live_command(CLI::App& app, Action& action);
void add_inspect_command(CLI::App& app, Action& action);
void add_denoise_command(CLI::App& app, Action& action);
void add_diff_command(CLI::App& app, Action& action);
void add_view_command(CLI::App& app, Action& action);
void add_compare_command(CLI::App& app, Action& action);
void add_profile_command(CLI::App& app, Action& action);
void add_merge_command(CLI::App& app, Action& action);
void add_submit_command(CLI::App& app, Action& action);
void add_help_command(CLI::App& app, Action& action);

}  // namespace etendue
