// One attempt at one image of a batch.
#pragma once

#include "batch/batch_child.h"
#include "batch/batch_options.h"
#include "batch/batch_units.h"
#include "core/parallel.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

enum class AttemptEnd {
    Done,
    Failed,       ///< another attempt may do better
    Hopeless,     ///< it would fail in the same way again
    Invalid,      ///< it would fail in the same way again, and so would other images of the scene
    Interrupted,  ///< by the user; what was rendered is kept
    LockLost,     ///< another process has taken the image over
};

struct Attempt {
    AttemptEnd end = AttemptEnd::Failed;
    std::optional<int> exit_code{};  ///< exit code of its process, if it had one that ended by itself
    std::string signal{};            ///< "SIGSEGV", if that ended it
    std::string error{};             ///< unless it is done or interrupted; any number of lines
    bool was_said = false;           ///< `error` is what its process had said, and `on_message` was told
    std::vector<std::string> log{};  ///< the last lines of its process, oldest first
    std::string phase{};      ///< the last that its process told of; here, only "resume" if the checkpoint was refused
    bool is_stalled = false;  ///< it was ended because its process did not go on
};

struct AttemptOptions {
    bool resume = true;  ///< go on with the checkpoint, if there is one
    bool force = false;  ///< also if the image is up to date
};

/// Holds the functions that are called while an attempt goes on.
struct AttemptCallbacks {
    std::function<void(const std::string& line)> on_message;  ///< takes each message of the process
    std::function<void(const ChildProgress&)> on_progress;
    std::function<bool()> keep_alive;  ///< a few times a second; false if the attempt must end at once
};

/// Renders the image in a process of its own. Throws IoError if there can be none.
[[nodiscard]] Attempt attempt_in_child(const BatchTask& task, const BatchOptions& options, const AttemptOptions& how,
                                       const AttemptCallbacks& callbacks);

/// Takes the noise out of the image, which has been rendered, by `etendue denoise`, and shows the result as a PNG
/// unless the batch is to write none. Throws IoError if there can be no process.
[[nodiscard]] Attempt denoise_in_child(const BatchTask& task, const BatchOptions& options,
                                       const AttemptCallbacks& callbacks);

/// Renders it here. `title` stands before the progress bar; `keep_alive` is called from a thread of its own;
/// once it is false, rendering ends soon, and nothing is written any more.
[[nodiscard]] Attempt attempt_here(const BatchTask& task, const BatchOptions& options, const AttemptOptions& how,
                                   const std::string& title, const std::function<bool()>& keep_alive,
                                   const ThreadPool& threads);

}  // namespace etendue
