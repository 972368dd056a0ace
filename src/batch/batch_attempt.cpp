#include "batch/batch_attempt.h"

#include "core/error.h"
#include "core/process_time.h"
#include "picture/output_paths.h"
#include "render/checkpoint.h"
#include "session/exit_code.h"
#include "session/image_job.h"
#include "session/interrupt.h"
#include "session/usage_error.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <new>
#include <optional>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;
constexpr std::chrono::milliseconds kBetweenLooks(100);
/// Without a sign of progress since it was told to stop, a child is ended: longer than any file takes to be written.
constexpr std::chrono::minutes kMostSilence(5);

std::vector<std::string> child_arguments(const BatchTask& task, const BatchOptions& options, const AttemptOptions& how,
                                         int threads) {
    std::vector<std::string> arguments = render_arguments(task, options, threads);
    arguments.insert(arguments.end(), {"--progress-fd", fmt::format("{}", ChildProcess::kProgressDescriptor),
                                       "--checkpoint-every", fmt::format("{}", options.checkpoint_minutes)});
    if (options.keep_sums_after)
        arguments.insert(arguments.end(), {"--keep-sums-after", fmt::format("{}", *options.keep_sums_after)});
    if (how.resume) arguments.emplace_back("--resume");
    if (how.force) arguments.emplace_back("--force");
    return arguments;
}

/// True if a failure with this message is one of memory.
bool tells_of_memory(const std::deque<std::string>& messages) {
    // Of this program, of the standard library, of the system, and of the loader, which starts programs.
    constexpr std::array<std::string_view, 7> kWords{
        "not enough memory",     "bad_alloc",          "annot allocate memory", "Resource temporarily unavailable",
        "pthread_create failed", "failed to map segm", "cannot map zero-fill"};
    return std::ranges::any_of(messages, [&](const std::string& line) {
        return std::ranges::any_of(kWords, [&](std::string_view w) { return line.find(w) != std::string::npos; });
    });
}

bool is_interrupt(const ChildEnd& end) {
    return end.signal == SIGINT || end.signal == SIGTERM || end.exit_code == static_cast<int>(ExitCode::Interrupted) ||
           end.exit_code == static_cast<int>(ExitCode::Terminated);
}

/// Says in `attempt` what the end of a child means that did not finish its image.
void judge_failure(const ChildProcess& child, const BatchOptions& options, Attempt& attempt) {
    const ChildEnd& end = child.end();
    attempt.log.assign(child.last_messages().begin(), child.last_messages().end());
    attempt.error = error_of(child.last_messages());
    attempt.was_said = !attempt.error.empty() && end.signal == 0;
    if (attempt.is_stalled)
        attempt.error = fmt::format("it was ended because it showed no progress for {:g} minutes (--stall-minutes){}",
                                    options.stall_minutes,
                                    attempt.phase.empty() ? "" : fmt::format(", in phase '{}'", attempt.phase));
    else if (!attempt.was_said)
        attempt.error = end_in_words(end);
    if (interrupt_requested() && is_interrupt(end)) {
        attempt.end = AttemptEnd::Interrupted;
        attempt.error.clear();
    } else if (options.max_memory && tells_of_memory(child.last_messages())) {
        attempt.end = AttemptEnd::Hopeless;
        attempt.was_said = false;
        attempt.error =
            fmt::format("it needs more memory than --max-memory {}: {}", options.max_memory_text, attempt.error);
    } else if (end.signal == 0 && end.exit_code == static_cast<int>(ExitCode::InvalidScene)) {
        attempt.end = AttemptEnd::Invalid;
    } else if (end.signal == 0 && end.exit_code == static_cast<int>(ExitCode::UsageError)) {
        attempt.end = AttemptEnd::Hopeless;
    } else if ((end.signal != 0 || !attempt.was_said) && options.max_memory) {
        attempt.error += fmt::format("; --max-memory {} may be the reason", options.max_memory_text);
    }
}

/// Calls something a few times a second, from a thread of its own, for as long as it lives.
class Repeater {
  public:
    explicit Repeater(const std::function<void()>& call)
        : thread_([call](const std::stop_token& stop) {
              std::mutex mutex;
              std::condition_variable_any waiting;
              std::unique_lock lock(mutex);
              while (!waiting.wait_for(lock, stop, kBetweenLooks, [&] { return stop.stop_requested(); })) call();
          }) {}

  private:
    std::jthread thread_;
};

}  // namespace

ChildAttempt::ChildAttempt(const BatchTask& task, const BatchOptions& options, const AttemptOptions& how, int threads)
    : options_(options), threads_(threads) {
    commands_.push_back({child_arguments(task, options, how, threads), "start", options.stall_minutes});
    if (options.denoise) {
        const std::string image = as_argument(task.job.output);
        const std::string denoised = as_argument(denoised_path(task.job.output));
        std::vector<std::string> arguments{"denoise", image, "-o", denoised, "--quiet"};
        if (threads > 0) arguments.insert(arguments.end(), {"--threads", fmt::format("{}", threads)});
        // Neither of the two tells of its progress.
        commands_.push_back({std::move(arguments), "denoise"});
        const std::string preview = fs::path(denoised).replace_extension(".png").string();
        if (options.overrides.png)
            commands_.push_back({.arguments = {"view", denoised, "-o", preview},
                                 .phase = "denoise",
                                 .shown_as = OutputPaths::beside(task.job.output).json});
    }
    start_next();
}

void ChildAttempt::start_next() {
    Command& next = commands_.front();
    if (!next.shown_as.empty())
        for (std::string& word : display_arguments(next.shown_as)) next.arguments.push_back(std::move(word));
    child_ =
        std::make_unique<ChildProcess>(ChildOptions{.arguments = next.arguments, .memory_limit = options_.max_memory});
    attempt_ = {};
    last_sign_ = Clock::now();
    was_told_to_stop_ = false;
}

void ChildAttempt::wait_for_any(std::span<const ChildAttempt* const> attempts) {
    std::vector<const ChildProcess*> children;
    children.reserve(attempts.size());
    for (const ChildAttempt* const attempt : attempts) children.push_back(attempt->child_.get());
    ChildProcess::wait_for_any(children, kBetweenLooks);
}

bool ChildAttempt::go_on(const AttemptCallbacks& callbacks) {
    if (attempt_.phase.empty()) callbacks.on_progress({.phase = commands_.front().phase});
    const auto on_progress = [&](const std::string& line) {
        const std::optional<ChildProgress> progress = parse_progress(line);
        if (!progress) return;
        last_sign_ = Clock::now();
        attempt_.phase = progress->phase;
        callbacks.on_progress(*progress);
    };
    if (child_->wait(std::chrono::milliseconds(0), callbacks.on_message, on_progress)) {
        if (interrupt_requested() && !was_told_to_stop_) {
            // It may have got the signal itself, which is as good. A second one from the user ends this process, and
            // with it the child.
            child_->send(interrupt_exit_code() == ExitCode::Terminated ? SIGTERM : SIGINT);
            was_told_to_stop_ = true;
            last_sign_ = Clock::now();
        }
        end_if_silent();
        if (has_lock_ && !callbacks.keep_alive()) {
            has_lock_ = false;
            child_->send(SIGKILL);
        }
        return true;
    }
    judge();
    if (attempt_.end != AttemptEnd::Done) return false;
    commands_.pop_front();
    if (!std::exchange(has_rendered_, true)) rendered_at_ = Clock::now();
    if (!commands_.empty()) {
        start_next();
        return true;
    }
    if (options_.denoise) attempt_.denoise_seconds = seconds_since(rendered_at_);
    attempt_.threads = threads_;
    return false;
}

void ChildAttempt::end_if_silent() {
    // Libraries that were denied memory may wait for a lock for ever.
    const Clock::duration silence = Clock::now() - last_sign_;
    const std::chrono::duration<double, std::ratio<60>> limit(commands_.front().stall_minutes);
    attempt_.is_stalled = !was_told_to_stop_ && limit.count() > 0.0 && silence > limit;
    if (attempt_.is_stalled || (was_told_to_stop_ && silence > kMostSilence)) child_->send(SIGKILL);
}

void ChildAttempt::judge() {
    const ChildEnd& end = child_->end();
    if (end.signal == 0)
        attempt_.exit_code = end.exit_code;
    else
        attempt_.signal = signal_name(end.signal);
    if (!has_lock_)
        attempt_.end = AttemptEnd::LockLost;
    else if (end.signal == 0 && end.exit_code == 0)
        attempt_.end = AttemptEnd::Done;
    else
        judge_failure(*child_, options_, attempt_);
}

bool ChildAttempt::show_preview() {
    if (attempt_.phase != "render") return false;
    child_->send(SIGUSR1);
    return true;
}

void ChildAttempt::stop() {
    child_->send(SIGSTOP);
}

void ChildAttempt::go_on_after_stop() {
    child_->send(SIGCONT);
    last_sign_ = Clock::now();
}

Attempt attempt_here(const BatchTask& task, const BatchOptions& options, const AttemptOptions& how,
                     const std::string& title, const std::function<bool()>& keep_alive, const ThreadPool& threads) {
    Attempt attempt{.end = AttemptEnd::Done};
    std::atomic<bool> is_lost = false;
    const Repeater heart([&] {
        if (!is_lost && !keep_alive()) is_lost = true;
    });
    try {
        const ImageResult result = run_job(task.job,
                                           {.overrides = options.overrides,
                                            .checkpoint_minutes = options.checkpoint_minutes,
                                            .resume = how.resume,
                                            .keep_sums_after = options.keep_sums_after,
                                            .force = how.force,
                                            .quiet = options.quiet,
                                            .title = title,
                                            .command = options.command,
                                            .is_lost = &is_lost},
                                           threads);
        if (result.outcome == ImageOutcome::Interrupted) attempt.end = AttemptEnd::Interrupted;
    } catch (const LostRender&) {
        attempt.end = AttemptEnd::LockLost;
    } catch (const RefusedCheckpoint& error) {
        attempt.end = AttemptEnd::Invalid;
        attempt.phase = "resume";
        attempt.error = error.what();
    } catch (const SceneError& error) {
        attempt.end = AttemptEnd::Invalid;
        attempt.error = error.what();
    } catch (const UsageError& error) {
        attempt.end = AttemptEnd::Hopeless;
        attempt.error = error.what();
    } catch (const std::bad_alloc&) {
        attempt.end = AttemptEnd::Hopeless;
        attempt.error = "there is not enough memory";
    } catch (const std::exception& error) {
        attempt.end = AttemptEnd::Failed;
        attempt.error = error.what();
    }
    return attempt;
}

}  // namespace etendue
