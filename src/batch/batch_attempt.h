// One attempt at one image of a batch.
#pragma once

#include "batch/batch_child.h"
#include "batch/batch_options.h"
#include "batch/batch_units.h"
#include "core/parallel.h"
#include "process/child_process.h"

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
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
    std::optional<double> denoise_seconds{};  ///< seconds from the end of rendering on, if noise was taken out
    int threads = 0;                          ///< threads of that; 0: one per processor
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

/// An attempt at an image in processes of their own, one after the other: it is rendered, and if the batch is to, freed
/// of its noise by `etendue denoise` and shown as a PNG. All attempts are kept going by one thread.
class ChildAttempt {
  public:
    /// Starts to render the image with `threads` threads, or one per processor if that is 0. `options` outlives it.
    /// Throws IoError if there can be no process.
    ChildAttempt(const BatchTask& task, const BatchOptions& options, const AttemptOptions& how, int threads);

    /// Waits until one of them has something to tell, a signal arrives here, or a tenth of a second is over.
    static void wait_for_any(std::span<const ChildAttempt* const> attempts);

    /// Hands over what the process has told, and does what is to be done with it: an interruption is passed on, and it
    /// is ended if it shows no progress. Returns false once the attempt is over. Throws IoError if the next process
    /// cannot be started.
    [[nodiscard]] bool go_on(const AttemptCallbacks& callbacks);

    /// Lets it write a preview if it is rendering; returns whether it is.
    bool show_preview();

    /// Suspends its process until `go_on_after_stop` is called.
    void stop();
    void go_on_after_stop();

    /// Returns the bytes of memory that its process has now.
    [[nodiscard]] std::uint64_t memory_bytes() const { return child_->own_memory_bytes(); }

    /// Valid once `go_on` has returned false.
    [[nodiscard]] const Attempt& result() const { return attempt_; }
    /// Returns whether the image is rendered, whatever became of what follows.
    [[nodiscard]] bool has_rendered() const { return has_rendered_; }

  private:
    using Clock = std::chrono::steady_clock;
    struct Command {
        std::vector<std::string> arguments{};
        std::string phase{};               ///< shown until the process tells of one
        double stall_minutes = 0.0;        ///< minutes without progress after which it is ended; 0: never
        std::filesystem::path shown_as{};  ///< NAME.json of the image whose view it takes; empty for none
    };

    void start_next();
    /// Ends the process if it has been silent for too long.
    void end_if_silent();
    void judge();

    const BatchOptions& options_;
    int threads_;
    std::deque<Command> commands_;  ///< from the one that runs on
    std::unique_ptr<ChildProcess> child_;
    Attempt attempt_;
    bool has_rendered_ = false;
    Clock::time_point rendered_at_{};  ///< once it is rendered
    Clock::time_point last_sign_;      ///< last sign of its going on
    bool was_told_to_stop_ = false;
    bool has_lock_ = true;
};

/// Renders it here. `title` stands before the progress bar; `keep_alive` is called from a thread of its own;
/// once it is false, rendering ends soon, and nothing is written any more.
[[nodiscard]] Attempt attempt_here(const BatchTask& task, const BatchOptions& options, const AttemptOptions& how,
                                   const std::string& title, const std::function<bool()>& keep_alive,
                                   const ThreadPool& threads);

}  // namespace etendue
