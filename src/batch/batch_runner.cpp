#include "batch/batch_runner.h"

#include "batch/batch_unit_report.h"
#include "core/byte_size.h"
#include "core/log.h"
#include "core/process_time.h"
#include "core/write_file.h"
#include "picture/output_paths.h"
#include "process/memory_left.h"
#include "session/checkpoint_files.h"
#include "session/exit_code.h"
#include "session/interrupt.h"
#include "session/up_to_date.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <exception>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <sys/poll.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

/// Pause after which it is looked again at what other processes make.
constexpr std::chrono::milliseconds kBetweenLooksAtHeld(500);

/// True if the attempt ended because the checkpoint that it was to go on with is of no use: it is damaged, or of
/// another render. What merely cannot be read, or used for want of memory, is worth another attempt.
bool was_refused(const Attempt& attempt) {
    return attempt.end == AttemptEnd::Invalid && attempt.phase == "resume";
}

/// True if what failed there is no better here: a disk that is full or a driver that crashes may be one machine's own.
bool would_fail_here(const LedgerHistory::Entry& failure, const std::string& host) {
    // If no process ended, nothing was tried. A wrong option of the other batch is no fault of the image.
    // Errors of an option's value end with InvalidScene, too, and begin with the option.
    if (!failure.exit_code && !failure.has_crashed) return false;
    const bool names_option = failure.error.starts_with("error: --");
    if (failure.exit_code == static_cast<int>(ExitCode::UsageError) || names_option) return false;
    return failure.host == host || failure.exit_code == static_cast<int>(ExitCode::InvalidScene);
}

}  // namespace

BatchRunner::BatchRunner(const BatchOptions& options, BatchTasks tasks, LedgerHistory& history, BatchProgress& progress,
                         BatchWatcher* watcher)
    : options_(options),
      tasks_(std::move(tasks.chosen)),
      history_(history),
      progress_(progress),
      locks_(options.output),
      record_(options, progress, watcher),
      jobs_(static_cast<std::size_t>(record_.report().jobs)) {
    if (options.in_process) threads_.emplace(options.threads);
    for (const BatchTask& task : tasks.left_out) left_out_.push_back(left_out_unit(task, options_, history_));
    record_.list_tasks(tasks_, left_out_);
}

const BatchPlan& BatchRunner::plan() {
    std::size_t reported = 0;
    plan_ = make_plan(std::move(tasks_), options_, history_,
                      [&](const std::string& what, const BatchPlan& so_far, std::size_t of) {
                          progress_.update({.done = so_far.size(), .of = of, .under_way = {{what, "planning"}}});
                          for (; reported < so_far.size(); ++reported)
                              record_.unit(reported) = planned_unit(so_far[reported], options_);
                          record_.write_reports(false);
                      });
    tasks_.clear();
    progress_.clear();
    if (interrupt_requested()) {
        record_.end_report(true);
        tidy();
        return plan_;
    }
    arrange(plan_, options_.order, options_.overrides.assets);
    record_.list_plan(plan_, left_out_);
    return plan_;
}

void BatchRunner::fail_all() {
    for (std::size_t i = 0; i < plan_.size(); ++i) {
        if (!plan_[i].is_stale()) continue;
        record_.unit(i).outcome = UnitOutcome::Failed;
        // If another batch is making this image, only that batch records how it ends.
        const LockAttempt got = locks_.take(plan_[i].task.id);
        if (!got.lock) continue;
        record_.end_attempt(i, plan_[i], {.end = AttemptEnd::Failed, .error = plan_[i].error}, 0.0, false);
    }
    record_.end_report(false);
    tidy();
}

void BatchRunner::run() {
    record_.begin_batch();
    first_frames_ = FirstFrames(plan_, options_.overrides);
    std::deque<std::size_t> waiting;
    for (std::size_t i = 0; i < plan_.size(); ++i)
        if (plan_[i].is_stale())
            waiting.push_back(i);
        else
            remove_checkpoints(i);
    make_images(std::move(waiting));
    progress_.clear();
    const bool is_interrupted = interrupt_requested();
    if (is_interrupted && options_.force)
        progress_.say("--force makes all images anew, also those that this batch has made, if it is started again");
    record_.end_batch(is_interrupted);
    tidy();
}

void BatchRunner::make_images(std::deque<std::size_t> waiting) {
    std::vector<std::size_t> held;
    Clock::time_point looked_at_held = Clock::now();
    // The renders have process groups of their own, so that Ctrl-Z in a terminal does not reach them.
    std::optional<StopRequests> stops;
    if (!options_.in_process) stops.emplace();
    while (true) {
        if (stops && stops->take()) stop_with_work();
        begin_images(waiting, held);
        if (!work_.empty())
            look_after_work(held);
        else if (interrupt_requested() || (waiting.empty() && held.empty()))
            break;
        else if (waiting.empty())
            wait_for_others(held);
        // What others make is looked at again once nothing else waits.
        if (waiting.empty() && Clock::now() - looked_at_held >= kBetweenLooksAtHeld) {
            waiting.assign(held.begin(), held.end());
            held.clear();
            looked_at_held = Clock::now();
        }
    }
}

void BatchRunner::remove_checkpoints(std::size_t index) {
    const PlannedUnit& planned = plan_[index];
    const CheckpointFiles checkpoints(planned.task.job.output);
    if (!checkpoints.exist()) return;
    try {
        const LockAttempt got = locks_.take(planned.task.id);
        if (!got.lock) return;
        PlannedUnit now = planned;
        examine(now, options_, false, history_);
        if (!now.is_stale()) checkpoints.remove();
    } catch (const std::exception& error) {
        log_warning("warning: the checkpoint of {} is left: {}", planned.task.job.name, error.what());
    }
}

void BatchRunner::begin_images(std::deque<std::size_t>& waiting, std::vector<std::size_t>& held) {
    while (work_.size() < jobs_ && !interrupt_requested()) {
        const auto next = std::ranges::find_if(waiting, [&](std::size_t i) { return first_frames_.lets_begin(i); });
        if (next == waiting.end() || !has_room_for(*next)) break;
        const int threads = threads_for(waiting);
        const std::size_t index = *next;
        waiting.erase(next);
        const Beginning now = begin(index, threads);
        if (now == Beginning::UnderWay) continue;
        leave(index, now, held);
        if (now == Beginning::Over) record_.write_reports(false);
    }
}

void BatchRunner::leave(std::size_t index, Beginning how, std::vector<std::size_t>& held) {
    first_frames_.end(index, record_.unit(index).outcome != UnitOutcome::Failed);
    if (how == Beginning::Elsewhere) held.push_back(index);
    if (how == Beginning::Over) record_.count_done();
}

std::vector<JobShare> BatchRunner::shares() const {
    std::vector<JobShare> shares;
    for (const auto& work : work_)
        shares.push_back({.need = memory_need(plan_[work->index], options_),
                          .has = work->attempt ? work->attempt->memory_bytes() : 0,
                          .threads = work->threads});
    return shares;
}

std::uint64_t BatchRunner::memory_left_now() const {
    return memory_left(shares(), free_memory_bytes(), options_.jobs_memory);
}

bool BatchRunner::has_room_for(std::size_t index) {
    // One by itself may have all that there is: nothing would be won by waiting.
    if (work_.empty()) return true;
    const std::uint64_t need = memory_need(plan_[index], options_);
    const std::uint64_t left = memory_left_now();
    if (need <= left) return true;
    if (!std::exchange(has_waited_for_memory_, true))
        progress_.say(fmt::format(
            "{}: waits for memory, as others will: {}, and there are {} beside what is rendered",
            record_.unit(index).name,
            need == kAllMemory ? "nobody knows how much it needs" : fmt::format("it may need {}B", to_byte_size(need)),
            to_byte_size(left) + "B"));
    return false;
}

int BatchRunner::threads_for(const std::deque<std::size_t>& waiting) const {
    if (jobs_ == 1) return record_.report().threads;
    std::vector<std::uint64_t> needs;
    for (const std::size_t index : waiting) {
        if (needs.size() == jobs_) break;
        if (first_frames_.lets_begin(index)) needs.push_back(memory_need(plan_[index], options_));
    }
    return threads_of_next(shares(), needs, memory_left_now(), jobs_, record_.report().threads);
}

BatchRunner::Beginning BatchRunner::begin(std::size_t index, int threads) {
    const PlannedUnit& planned = plan_[index];
    const auto all = static_cast<double>(std::max(static_cast<std::size_t>(record_.report().threads), jobs_));
    record_.begin(index, planned, threads / all);
    try {
        if (invalid_scenes_.contains(planned.task.job.scene)) {
            record_.give_up(index, planned);
            return Beginning::Over;
        }
        LockAttempt got = locks_.take(planned.task.id);
        if (got.lock) return begin_under(std::move(*got.lock), index, threads);
        record_.unit(index).host = got.holder.str();
        record_.leave_to_others(index, planned);
        return Beginning::Elsewhere;
    } catch (const std::exception& error) {
        // Without the lock, the ledger is not told: what becomes of the image is its owner's to say.
        record_.end(index, planned, {.end = AttemptEnd::Failed, .error = error.what()}, 0.0);
        return Beginning::Over;
    }
}

BatchRunner::Beginning BatchRunner::begin_under(BatchLock lock, std::size_t index, int threads) {
    auto work = std::make_unique<Work>(Work{.index = index, .lock = std::move(lock), .threads = threads});
    try {
        if (was_made_elsewhere(index, work->lock)) return Beginning::Over;
        fs::create_directories(plan_[index].task.job.output.parent_path());
        const bool is_forced = plan_[index].reason == kForced;
        work->how = {.resume = !is_forced && plan_[index].resumes, .force = is_forced};
        record_.unit(index).host = record_.report().host;
        const Beginning beginning = make(*work);
        if (beginning == Beginning::UnderWay) work_.push_back(std::move(work));
        return beginning;
    } catch (const std::exception& error) {
        fail(index, error.what());
        return Beginning::Over;
    }
}

void BatchRunner::fail(std::size_t index, const std::string& error) {
    const Attempt failure{.end = AttemptEnd::Failed, .error = error};
    record_.end_attempt(index, plan_[index], failure, 0.0, false);
    record_.end(index, plan_[index], failure, 0.0);
}

bool BatchRunner::was_made_elsewhere(std::size_t index, const BatchLock& lock) {
    PlannedUnit& planned = plan_[index];
    if (FileStamp::of(OutputPaths::beside(planned.task.job.output).json) != planned.seen) {
        // Whatever is there now was made after this batch began: that will do, even if it was asked for by force.
        examine(planned, options_, false, history_);
        record_.unit(index).reason = planned.reason;
    }
    history_.read_new();
    const LedgerHistory::Entry* const last = history_.find(planned.task.id);
    if (!planned.is_stale()) {
        planned.denoise_seconds = last != nullptr ? last->denoise_seconds : std::nullopt;
        // Its owner may have died between the last of the files and the ledger.
        const bool was_told = last != nullptr && last->kind == LedgerEventKind::UnitFinished;
        record_.end_as_made_elsewhere(index, planned, lock, lock.dead_owner() && !was_told);
        return true;
    }
    const bool has_failed = last != nullptr && last->is_recent && last->is_final &&
                            last->kind == LedgerEventKind::UnitFailed && !lock.dead_owner() &&
                            would_fail_here(*last, record_.report().host);
    if (has_failed)
        record_.end(index, planned,
                    {.end = AttemptEnd::Failed, .error = fmt::format("another batch process failed: {}", last->error)},
                    0.0);
    return has_failed;
}

BatchRunner::Beginning BatchRunner::make(Work& work) {
    while (true) {
        const std::optional<Attempt> ended = start_attempt(work);
        if (!ended) return Beginning::UnderWay;
        if (const std::optional<Beginning> end = conclude(work, *ended)) return *end;
    }
}

std::optional<Attempt> BatchRunner::start_attempt(Work& work) {
    const BatchTask& task = plan_[work.index].task;
    record_.begin_attempt(work.index, plan_[work.index], work.lock);
    work.start = Clock::now();
    record_.write_reports(false);
    if (options_.denoise)
        if (std::string why = why_not_denoised(task, options_); !why.empty())
            return Attempt{.end = AttemptEnd::Hopeless, .error = std::move(why)};
    if (!options_.in_process) {
        const int threads = options_.threads > 0 || jobs_ > 1 ? work.threads : 0;
        work.attempt = std::make_unique<ChildAttempt>(task, options_, work.how, threads);
        return std::nullopt;
    }
    progress_.clear();
    return attempt_here(
        task, options_, work.how, record_.numbered(task.job.name),
        [&] {
            // Nothing else touches the report while the image is rendered.
            record_.write_reports(false);
            return work.lock.keep_alive();
        },
        *threads_);
}

std::optional<BatchRunner::Beginning> BatchRunner::conclude(Work& work, const Attempt& result) {
    BatchUnit& unit = record_.unit(work.index);
    unit.fraction.reset();
    unit.seconds_left.reset();
    const double seconds = seconds_since(work.start);
    if (result.end == AttemptEnd::LockLost) {
        record_.leave_to_others(work.index, plan_[work.index]);
        return Beginning::Elsewhere;
    }
    const bool is_refused = was_refused(result);
    const bool again =
        !interrupt_requested() && (is_refused || (result.end == AttemptEnd::Failed && work.retries < options_.retries));
    record_.end_attempt(work.index, plan_[work.index], result, seconds, again);
    if (!again) {
        if (result.end == AttemptEnd::Invalid) invalid_scenes_.insert(plan_[work.index].task.job.scene);
        record_.end(work.index, plan_[work.index], result, seconds);
        return Beginning::Over;
    }
    if (!is_refused) ++work.retries;
    work.how.resume = !is_refused;
    if (work.attempt && work.attempt->has_rendered()) work.how.force = false;  // what failed came after the image
    progress_.say(fmt::format("{}: {}; {}", unit.name, record_.failure_in_words(result),
                              is_refused ? "begins anew without the checkpoint"
                                         : fmt::format("tries again ({} of {})", work.retries, options_.retries)));
    return std::nullopt;
}

void BatchRunner::look_after_work(std::vector<std::size_t>& held) {
    std::vector<const ChildAttempt*> attempts;
    for (const auto& work : work_) attempts.push_back(work->attempt.get());
    ChildAttempt::wait_for_any(attempts);
    pass_on_preview_request();
    for (auto& work : work_) {
        const std::size_t index = work->index;
        Beginning now = Beginning::UnderWay;
        try {
            const bool goes_on = work->attempt->go_on(
                {.on_message = [&](const std::string& line) { record_.pass_on(plan_[index].task.job, line); },
                 .on_progress = [&](const ChildProgress& progress) { work->progress = progress; },
                 .keep_alive = [&] { return work->lock.keep_alive(); }});
            if (goes_on)
                record_.follow(index, work->progress, seconds_since(work->start), work->threads);
            else if (const std::optional<Beginning> end = conclude(*work, work->attempt->result()))
                now = *end;
            else
                now = make(*work);
        } catch (const std::exception& error) {
            fail(index, error.what());
            now = Beginning::Over;
        }
        if (now == Beginning::UnderWay) continue;
        work.reset();
        leave(index, now, held);
    }
    std::erase(work_, nullptr);
    show_work();
    record_.write_reports(false);
}

void BatchRunner::show_work() {
    std::vector<BatchProgressLine::UnderWay> under_way;
    for (const auto& work : work_) {
        const ChildProgress& progress = work->progress;
        const double percent = std::floor(progress.fraction * 100.0);
        under_way.push_back({record_.unit(work->index).name,
                             progress.phase == "render" ? fmt::format("{:.0f}%", percent) : progress.phase});
    }
    if (!under_way.empty()) record_.show(std::move(under_way));
}

void BatchRunner::pass_on_preview_request() {
    if (!preview_requested()) return;
    bool is_shown = false;
    for (const auto& work : work_) is_shown = work->attempt->show_preview() || is_shown;
    // Until one renders, there is nothing to show.
    if (is_shown) clear_preview_request();
}

void BatchRunner::stop_with_work() {
    for (const auto& work : work_) work->attempt->stop();
    ::raise(SIGSTOP);
    for (const auto& work : work_) work->attempt->go_on_after_stop();
}

void BatchRunner::wait_for_others(const std::vector<std::size_t>& held) {
    const BatchUnit& first = record_.unit(held.front());
    if (!std::exchange(has_waited_, true))
        progress_.say(fmt::format("waiting for what other batch processes make: {} by {}{}", first.name, first.host,
                                  held.size() > 1 ? fmt::format(", and {} more", held.size() - 1) : ""));
    record_.show({{first.name, "made by " + first.host}});
    record_.write_reports(false);
    ::poll(nullptr, 0, static_cast<int>(kBetweenLooksAtHeld.count()));
}

void BatchRunner::tidy() const {
    try {
        locks_.tidy();
        remove_abandoned_files(options_.output);
    } catch (const std::exception& error) {
        log_warning("warning: {}", error.what());
    }
}

}  // namespace etendue
