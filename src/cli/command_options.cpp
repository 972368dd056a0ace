#include "cli/command_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

std::vector<GivenOption> given_options(std::span<const CLI::Option* const> options) {
    std::vector<GivenOption> given;
    for (const CLI::Option* option : options) {
        if (option->count() == 0) continue;
        const std::string name = option->get_positional() ? "" : option->get_name();
        const bool is_flag = option->get_items_expected_max() == 0;
        if (is_flag)
            given.push_back({name, std::nullopt});
        else
            for (const std::string& value : option->results()) given.push_back({name, value});
    }
    return given;
}

void set_group(CLI::App& command, const std::string& group, std::initializer_list<const char*> options) {
    for (const char* option : options) command.get_option(option)->group(group);
}

void hide_options(CLI::App& command, std::span<const OptionOfRender> options) {
    for (const OptionOfRender& option : options) command.get_option(option.name)->group("");
}

void refuse_options(const CLI::App& command, std::span<const OptionOfRender> options) {
    for (const OptionOfRender& option : options)
        if (command.count(option.name) > 0)
            throw CLI::ValidationError(option.name, fmt::format("is for 'render'; {}", option.instead));
}

}  // namespace etendue
