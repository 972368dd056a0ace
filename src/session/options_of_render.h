// Options of `render` that another command has among those that override render.json, and takes no notice of.
#pragma once

#include <span>

namespace CLI {
class App;
}

namespace etendue {

struct OptionOfRender {
    const char* name;     ///< "--time"
    const char* instead;  ///< how the command decides about that, as the end of a sentence
};

/// Leaves them out of the help of `command`.
void hide_options(CLI::App& command, std::span<const OptionOfRender> options);

/// Throws CLI::ValidationError if one of them was given.
void refuse_options(const CLI::App& command, std::span<const OptionOfRender> options);

}  // namespace etendue
