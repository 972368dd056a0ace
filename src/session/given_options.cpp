#include "session/given_options.h"

#include "process/shell_word.h"

namespace etendue {

std::vector<GivenOption> without(std::vector<GivenOption> options, const std::string& name) {
    std::erase_if(options, [&](const GivenOption& option) { return option.name == name; });
    return options;
}

std::vector<GivenOption> merged(std::vector<GivenOption> common, std::span<const GivenOption> own) {
    for (const GivenOption& option : own) common = without(std::move(common), option.name);
    common.insert(common.end(), own.begin(), own.end());
    return common;
}

std::string command_line(const std::string& command, std::span<const GivenOption> options) {
    std::string line = command;
    for (const GivenOption& option : options) {
        if (!option.name.empty()) line += " " + option.name;
        if (option.value) line += " " + quoted(*option.value);
    }
    return line;
}

}  // namespace etendue
