// What the process says when it ends.
#pragma once

namespace etendue {

enum class ExitCode : int {
    Success = 0,
    RenderFailed = 1,  ///< at least one scene could not be rendered or written
    UsageError = 2,
    InvalidScene = 3,   ///< invalid scene or settings
    Interrupted = 130,  ///< SIGINT
    Terminated = 143,   ///< SIGTERM
};

}  // namespace etendue
