// What the process says when it ends.
#pragma once

namespace etendue {

enum class ExitCode : int {
    Success = 0,
    RenderFailed = 1,  ///< at least one scene could not be rendered or written
    DiffFailed = 1,    ///< images were compared: a measure is above its limit, or pixels are not finite
    UsageError = 2,
    InvalidScene = 3,   ///< invalid scene or settings, or images that cannot be read or compared
    Unfinished = 4,     ///< some submitted images still wait or run, and none has failed
    Interrupted = 130,  ///< SIGINT
    Terminated = 143,   ///< SIGTERM
};

}  // namespace etendue
