// Why the operating system did not do something.
#pragma once

#include <string>

namespace etendue {

/// The system's message of the number `error`, as errno has it. Where a file would have become larger than the process
/// may make one, it names that limit.
[[nodiscard]] std::string system_error_text(int error);

}  // namespace etendue
