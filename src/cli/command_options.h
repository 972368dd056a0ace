// The options of a command line: which were given, and which of `render` another command takes no notice of.
#pragma once

#include "live/tev_viewer.h"
#include "session/given_options.h"

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace etendue {

/// Returns those among `options` that were given, in their order, without those that the help does not show.
[[nodiscard]] std::vector<GivenOption> given_options(std::span<const CLI::Option* const> options);

/// Adds --live[=PORT], whose text arrives in `live`; `help` says what the page shows.
void add_live_option(CLI::App& command, std::string& live, const std::string& help);

/// Returns the port that the text of --live asks for, 0 for one that is free; nothing without the option.
[[nodiscard]] std::optional<int> live_port(const std::string& live);

/// Adds --tev HOST:PORT, which arrives in `address`; `help` says what tev gets.
void add_tev_option(CLI::App& command, std::optional<TevAddress>& address, const std::string& help);

/// Adds --threads, which arrives in `threads`; 0 is one per processor.
void add_threads_option(CLI::App& command, int& threads);

/// Adds --output DIR, which must be given and arrives in `directory`; `help` says what is written there.
void add_directory_option(CLI::App& command, std::string& directory, const std::string& help);

/// Throws a validation error for `option` if `names` has a name twice, because what has one name could not be told
/// apart.
void require_different(const std::string& option, const std::vector<std::string>& names);

/// Puts options of the command under one heading of its help.
void set_group(CLI::App& command, const std::string& group, std::initializer_list<const char*> options);

/// Lets `old_name`, which the help does not show, do what the option `name` of the command does, with a note.
void add_old_name(CLI::App& command, const std::string& old_name, const std::string& name);

/// Puts the time of each of many renders, which arrives in `seconds`, in the place of --time of one image; --seconds is
/// its old name.
void replace_time_option(CLI::App& command, std::optional<double>& seconds, const std::string& help);

/// Names an option that a command has among those that override render.json, and takes no notice of.
struct OptionOfRender {
    const char* name;     ///< "--time"
    const char* instead;  ///< how the command decides about that, as the end of a sentence
};

/// Leaves them out of the help of `command`.
void hide_options(CLI::App& command, std::span<const OptionOfRender> options);

/// Throws CLI::ValidationError if one of them was given.
void refuse_options(const CLI::App& command, std::span<const OptionOfRender> options);

}  // namespace etendue
