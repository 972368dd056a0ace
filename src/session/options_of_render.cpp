#include "session/options_of_render.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

void hide_options(CLI::App& command, std::span<const OptionOfRender> options) {
    for (const OptionOfRender& option : options) command.get_option(option.name)->group("");
}

void refuse_options(const CLI::App& command, std::span<const OptionOfRender> options) {
    for (const OptionOfRender& option : options)
        if (command.count(option.name) > 0)
            throw CLI::ValidationError(option.name, fmt::format("is for 'render'; {}", option.instead));
}

}  // namespace etendue
