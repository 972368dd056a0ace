// Commands to copy from a message into a shell, and for scripts to run.
#pragma once

#include <string>

namespace etendue {

/// `text` as one word of a shell's command line, and always on one line: with line breaks or other control characters
/// in it, it is written as bash, ksh and zsh read it, without them as all shells do.
[[nodiscard]] std::string quoted(const std::string& text);

}  // namespace etendue
