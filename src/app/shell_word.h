// Commands to copy from a message into a shell.
#pragma once

#include <string>

namespace etendue {

/// `text` as one word of a shell's command line.
[[nodiscard]] std::string quoted(const std::string& text);

}  // namespace etendue
