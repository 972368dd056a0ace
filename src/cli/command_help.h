// What the help of a command says, as plain data: man pages and completions are written from it.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace etendue {

struct OptionHelp {
    enum class Value {
        None,    ///< a flag
        Number,  ///< nothing that a shell could complete
        Choice,  ///< one of `choices`
        Text,    ///< often a file
    };
    std::vector<std::string> names;  ///< with their dashes, short ones first; of an argument, its only name
    std::string group;               ///< heading that it stands under
    std::string terms;               ///< type, range, whether it is required: "FLOAT in [0 - 1] REQUIRED"
    std::string description;
    Value value = Value::None;
    std::vector<std::string> choices;  ///< the words that it accepts
};

struct CommandHelp {
    std::string name;     ///< "render"; of the program, "etendue"
    std::string summary;  ///< one line
    std::string footer;   ///< the rest: paragraphs, and headings over indented lines
    std::vector<OptionHelp> arguments;
    std::vector<OptionHelp> options;
    std::vector<CommandHelp> commands;
};

/// The help of `app` and its commands, without what --help hides.
[[nodiscard]] CommandHelp describe_command(const CLI::App& app);

/// The first clause of `text`, for where one line has to do.
[[nodiscard]] std::string first_clause(const std::string& text);

}  // namespace etendue
