// The command line as a whole, before anything of it is parsed: for main(), for `etendue help` and for the manual.
#pragma once

#include "cli/commands.h"

#include <memory>
#include <string>

namespace CLI {
class App;
}

namespace etendue {

/// All commands and options of the program. Parsing sets `action`, which has to live as long as the result.
[[nodiscard]] std::unique_ptr<CLI::App> make_command_line(Action& action);

/// Throws UsageError with the nearest name if `app` has no command `name`.
void require_command(const CLI::App& app, const std::string& name);

}  // namespace etendue
