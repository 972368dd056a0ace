#include "batch/batch_runner.h"

#include "batch/batch_statistics.h"
#include "core/log.h"
#include "core/process_time.h"
#include "core/write_file.h"
#include "output/software_name.h"
#include "process/process_owner.h"
#include "session/checkpoint_files.h"
#include "session/exit_code.h"
#include "session/interrupt.h"
#include "session/progress_display.h"
#include "session/up_to_date.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <sys/poll.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

/// Returns what is known of a unit before it was looked at.
BatchUnit unknown_unit(const BatchTask& task, const BatchOptions& options) {
    const ImageJob& job = task.job;
    BatchUnit unit{.name = job.name,
                   .scene = job.scene.string(),
                   .frame = job.frame,
                   .variant = job.variant.value_or(""),
                   .camera = job.camera.value_or(""),
                   .image = job.output.lexically_relative(options.output).string()};
    const fs::path shown = options.denoise ? denoised_path(unit.image) : fs::path(unit.image);
    if (options.overrides.png) unit.preview = fs::path(shown).replace_extension(".png").string();
    return unit;
}

/// Returns what is known of a unit before anything is done.
BatchUnit planned_unit(const PlannedUnit& planned, const BatchOptions& options) {
    BatchUnit unit = unknown_unit(planned.task, options);
    unit.outcome = planned.is_stale() ? UnitOutcome::NotStarted : UnitOutcome::UpToDate;
    unit.reason = planned.reason;
    unit.estimated_seconds = planned.estimated_seconds;
    if (unit.camera.empty()) unit.camera = planned.outline.camera;
    if (!planned.is_stale()) {
        read_statistics(OutputPaths::beside(planned.task.job.output).json, unit);
        return unit;
    }
    unit.error = planned.error;
    unit.width = planned.outline.width;
    unit.height = planned.outline.height;
    unit.spp_requested = planned.outline.spp;
    unit.integrator = planned.outline.integrator;
    return unit;
}

/// Returns what is known of a unit that is left as it is, without loading its scene.
BatchUnit left_out_unit(const BatchTask& task, const BatchOptions& options, const LedgerHistory& history) {
    BatchUnit unit = unknown_unit(task, options);
    unit.is_chosen = false;
    unit.outcome = UnitOutcome::NotChosen;
    const OutputPaths paths = OutputPaths::beside(task.job.output, options.overrides.png);
    const LedgerHistory::Entry* const last = history.find(task.id);
    if (last != nullptr && last->kind == LedgerEventKind::UnitFailed) {
        unit.outcome = UnitOutcome::Failed;
        unit.error = last->error;
    } else if (!why_unfinished(paths) && !why_outdated(paths, task.job.scene)) {
        unit.outcome = UnitOutcome::UpToDate;
        read_statistics(paths.json, unit);
    }
    return unit;
}

/// True if the attempt ended because the checkpoint that it was to go on with is of no use: it is damaged, or of
/// another render. What merely cannot be read, or used for want of memory, is worth another attempt.
bool was_refused(const Attempt& attempt) {
    return attempt.end == AttemptEnd::Invalid && attempt.phase == "resume";
}

/// True if what failed there is no better here: a disk that is full or a driver that crashes may be one machine's own.
bool would_fail_here(const LedgerHistory::Entry& failure, const std::string& host) {
    return failure.host == host || failure.exit_code == static_cast<int>(ExitCode::InvalidScene);
}

}  // namespace

BatchRunner::BatchRunner(const BatchOptions& options, BatchTasks tasks, LedgerHistory& history, BatchProgress& progress,
                         BatchWatcher* watcher)
    : options_(options),
      tasks_(std::move(tasks.chosen)),
      history_(history),
      progress_(progress),
      watcher_(watcher),
      books_(options.output),
      locks_(options.output) {
    if (options.in_process) threads_.emplace(options.threads);
    fs::path output = fs::absolute(options.output).lexically_normal();
    if (!output.has_filename()) output = output.parent_path();
    report_.title = output.filename().string();
    report_.output_directory = output.string();
    report_.program = software_name();
    report_.command = options.command;
    report_.started = utc_time();
    report_.host = this_process().host;
    report_.threads = options.threads > 0 ? options.threads : ThreadPool(0).thread_count();
    for (const BatchTask& task : tasks_) report_.units.push_back(unknown_unit(task, options_));
    for (const BatchTask& task : tasks.left_out) left_out_.push_back(left_out_unit(task, options_, history_));
    report_.units.insert(report_.units.end(), left_out_.begin(), left_out_.end());
    write_reports(true);
}

const BatchPlan& BatchRunner::plan() {
    std::size_t reported = 0;
    plan_ = make_plan(std::move(tasks_), options_, history_,
                      [&](const std::string& what, const BatchPlan& so_far, std::size_t of) {
                          progress_.update({.done = so_far.size(), .of = of, .current = what, .state = "planning"});
                          for (; reported < so_far.size(); ++reported)
                              report_.units[reported] = planned_unit(so_far[reported], options_);
                          write_reports(false);
                      });
    tasks_.clear();
    progress_.clear();
    if (interrupt_requested()) {
        report_.interrupted = true;
        abandon();
        return plan_;
    }
    arrange(plan_, options_.order);
    report_.units.clear();
    for (const PlannedUnit& unit : plan_) {
        report_.units.push_back(planned_unit(unit, options_));
        if (!unit.is_stale()) continue;
        ++stale_;
        time_left_.add(unit.error.empty() ? unit.estimated_seconds : 0.0);
        std::istringstream lines(unit.error);
        for (std::string line; std::getline(lines, line);) said_[unit.task.job.scene].insert(line);
    }
    report_.units.insert(report_.units.end(), left_out_.begin(), left_out_.end());
    return plan_;
}

void BatchRunner::abandon() {
    report_.state = BatchState::Ended;
    report_.ended = utc_time();
    write_reports(true);
    tidy();
}

void BatchRunner::fail_all() {
    for (std::size_t i = 0; i < plan_.size(); ++i) {
        if (!plan_[i].is_stale()) continue;
        report_.units[i].outcome = UnitOutcome::Failed;
        end_record(i, {.end = AttemptEnd::Failed, .error = plan_[i].error}, 0.0, false);
    }
    abandon();
}

void BatchRunner::run() {
    report_.state = BatchState::Running;
    report_.seconds_left = time_left_.left(0.0, 0.0);
    books_.append({.kind = LedgerEventKind::BatchStarted, .units = plan_.size()});
    std::vector<std::size_t> pending;
    for (std::size_t i = 0; i < plan_.size(); ++i)
        if (plan_[i].is_stale())
            pending.push_back(i);
        else
            remove_checkpoints(i);
    while (!pending.empty() && !interrupt_requested()) {
        std::vector<std::size_t> held;
        for (const std::size_t index : pending)
            if (interrupt_requested() || !work_on(index)) held.push_back(index);
        // What others make is looked at again once there is nothing else to do.
        if (held.size() == pending.size()) wait_for_others(held);
        pending = std::move(held);
    }
    progress_.clear();
    report_.interrupted = interrupt_requested();
    report_.ended = utc_time();
    report_.state = BatchState::Ended;
    report_.seconds_left.reset();
    if (report_.interrupted && options_.force)
        progress_.say("--force makes all images anew, also those that this batch has made, if it is started again");
    books_.append({.kind = LedgerEventKind::BatchFinished,
                   .seconds = seconds_since(start_),
                   .units = plan_.size(),
                   .rendered = totals(report_).rendered,
                   .failed = failed_,
                   .not_tried = not_tried_});
    write_reports(true);
    tidy();
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

bool BatchRunner::work_on(std::size_t index) {
    BatchUnit& unit = report_.units[index];
    const PlannedUnit& planned = plan_[index];
    unit.error.clear();  // what was foreseen is found out now
    time_left_.begin(planned.error.empty() ? planned.estimated_seconds : 0.0);
    bool is_over = true;
    try {
        if (invalid_scenes_.contains(planned.task.job.scene)) {
            give_up(index);
        } else if (LockAttempt got = locks_.take(planned.task.id); got.lock) {
            is_over = work_under(*got.lock, index);
        } else {
            unit.outcome = UnitOutcome::RunningElsewhere;
            unit.host = got.holder.str();
            is_over = false;
        }
    } catch (const std::exception& error) {
        // Without the lock, the ledger is not told: what becomes of the image is its owner's to say.
        finish(index, {.end = AttemptEnd::Failed, .error = error.what()}, 0.0);
    }
    if (is_over) {
        ++done_;
        write_reports(false);
    } else {
        if (unit.outcome == UnitOutcome::Running) unit.outcome = UnitOutcome::RunningElsewhere;
        time_left_.end(std::nullopt);
        time_left_.add(planned.error.empty() ? planned.estimated_seconds : 0.0);
    }
    return is_over;
}

bool BatchRunner::work_under(BatchLock& lock, std::size_t index) try {
    if (was_made_elsewhere(index, lock)) return true;
    fs::create_directories(plan_[index].task.job.output.parent_path());
    return make(index, lock);
} catch (const std::exception& error) {
    const Attempt failure{.end = AttemptEnd::Failed, .error = error.what()};
    end_record(index, failure, 0.0, false);
    finish(index, failure, 0.0);
    return true;
}

bool BatchRunner::was_made_elsewhere(std::size_t index, const BatchLock& lock) {
    PlannedUnit& planned = plan_[index];
    BatchUnit& unit = report_.units[index];
    const fs::path statistics = OutputPaths::beside(planned.task.job.output).json;
    if (FileStamp::of(statistics) != planned.seen) {
        // Whatever is there now was made after this batch began: that will do, even if it was asked for by force.
        examine(planned, options_, false, history_);
        unit.reason = planned.reason;
    }
    if (planned.is_stale()) {
        history_.read_new();
        const LedgerHistory::Entry* const last = history_.find(planned.task.id);
        const bool has_failed = last != nullptr && last->is_recent && last->is_final &&
                                last->kind == LedgerEventKind::UnitFailed && !lock.dead_owner() &&
                                would_fail_here(*last, report_.host);
        if (has_failed)
            finish(index,
                   {.end = AttemptEnd::Failed, .error = fmt::format("another batch process failed: {}", last->error)},
                   0.0);
        return has_failed;
    }
    unit.outcome = UnitOutcome::UpToDate;
    read_statistics(statistics, unit);
    time_left_.end(std::nullopt);
    // Its owner died between the last of the files and the ledger.
    history_.read_new();
    const LedgerHistory::Entry* const last = history_.find(planned.task.id);
    const bool was_told = last != nullptr && last->kind == LedgerEventKind::UnitFinished;
    if (lock.dead_owner() && !was_told)
        books_.append({.kind = LedgerEventKind::UnitFinished,
                       .unit = planned.task.id,
                       .scene = unit.scene,
                       .taken_over_from = lock.dead_owner()->str()});
    progress_.say(fmt::format("[{}/{}] {}: made by another batch process", done_ + 1, stale_, unit.name));
    return true;
}

std::string BatchRunner::failure_in_words(const Attempt& attempt) const {
    return attempt.was_said && !options_.quiet ? "failed" : "failed: " + attempt.error;
}

bool BatchRunner::make(std::size_t index, BatchLock& lock) {
    const PlannedUnit& planned = plan_[index];
    BatchUnit& unit = report_.units[index];
    unit.host = report_.host;
    const bool is_forced = planned.reason == kForced;
    AttemptOptions how{.resume = !is_forced, .force = is_forced};
    int retries = 0;
    while (true) {
        ++unit.attempts;
        begin_record(index, lock);
        const Clock::time_point start = Clock::now();
        unit.outcome = UnitOutcome::Running;
        write_reports(false);
        Attempt result = attempt(index, how, lock);
        if (result.end == AttemptEnd::Done) how.force = false;  // whatever fails now, the image is there
        if (result.end == AttemptEnd::Done && options_.denoise) result = denoise(index, lock);
        unit.fraction.reset();
        unit.seconds_left.reset();
        const double seconds = seconds_since(start);
        if (result.end == AttemptEnd::LockLost) return false;
        const bool is_refused = was_refused(result);
        const bool again =
            !interrupt_requested() && (is_refused || (result.end == AttemptEnd::Failed && retries < options_.retries));
        end_record(index, result, seconds, again);
        if (!again) {
            finish(index, result, seconds);
            return true;
        }
        if (!is_refused) ++retries;
        how.resume = !is_refused;
        progress_.say(fmt::format("{}: {}; {}", unit.name, failure_in_words(result),
                                  is_refused ? "begins anew without the checkpoint"
                                             : fmt::format("tries again ({} of {})", retries, options_.retries)));
    }
}

Attempt BatchRunner::attempt(std::size_t index, const AttemptOptions& how, BatchLock& lock) {
    const BatchTask& task = plan_[index].task;
    if (options_.denoise)
        if (std::string why = why_not_denoised(task, options_); !why.empty())
            return {.end = AttemptEnd::Hopeless, .error = std::move(why)};
    if (options_.in_process) {
        progress_.clear();
        return attempt_here(
            task, options_, how, fmt::format("[{}/{}] {}", done_ + 1, stale_, task.job.name),
            [&] {
                // Nothing else touches the report while the image is rendered.
                write_reports(false);
                return lock.keep_alive();
            },
            *threads_);
    }
    const Clock::time_point start = Clock::now();
    ChildProgress last{.phase = "start"};
    const AttemptCallbacks callbacks{.on_message = [&](const std::string& line) { pass_on(task.job, line); },
                                     .on_progress = [&](const ChildProgress& progress) { last = progress; },
                                     .keep_alive =
                                         [&] {
                                             follow(index, last, seconds_since(start));
                                             return lock.keep_alive();
                                         }};
    return attempt_in_child(task, options_, how, callbacks);
}

Attempt BatchRunner::denoise(std::size_t index, BatchLock& lock) {
    const BatchTask& task = plan_[index].task;
    const Clock::time_point start = Clock::now();
    return denoise_in_child(task, options_,
                            {.on_message = [&](const std::string& line) { pass_on(task.job, line); },
                             .on_progress = [](const ChildProgress&) {},
                             .keep_alive =
                                 [&] {
                                     follow(index, {.phase = "denoise"}, seconds_since(start));
                                     return lock.keep_alive();
                                 }});
}

void BatchRunner::pass_on(const ImageJob& job, const std::string& line) {
    // What `render` says when it is done, the batch says in its own words.
    if (line.starts_with(job.output.string() + ": ")) return;
    const bool is_of_scene = line.starts_with("note: ") || line.starts_with("warning: ") || line.starts_with("error: ");
    if (is_of_scene && !said_[job.scene].insert(line).second) return;
    progress_.say(fmt::format("{}: {}", job.name, line));
}

void BatchRunner::follow(std::size_t index, const ChildProgress& now, double seconds) {
    constexpr double kLeastFraction = 0.02;
    BatchUnit& unit = report_.units[index];
    const bool renders = now.phase == "render";
    const double fraction = renders ? now.fraction : 0.0;
    show(unit.name, renders ? fmt::format("{:.0f}%", std::floor(fraction * 100.0)) : now.phase, seconds, fraction);
    if (renders) {
        unit.fraction = fraction;
        const std::uint64_t pixels = static_cast<std::uint64_t>(unit.width) * static_cast<std::uint64_t>(unit.height);
        if (pixels > 0) unit.spp = static_cast<int>(now.samples / pixels);
    }
    if (fraction > kLeastFraction)
        unit.seconds_left = now.seconds * (1.0 - fraction) / fraction;
    else if (unit.estimated_seconds)
        unit.seconds_left = std::max(0.0, *unit.estimated_seconds - seconds);
    write_reports(false);
}

void BatchRunner::begin_record(std::size_t index, const BatchLock& lock) {
    const PlannedUnit& planned = plan_[index];
    books_.append({.kind = LedgerEventKind::UnitStarted,
                   .unit = planned.task.id,
                   .scene = planned.task.job.scene.string(),
                   .attempt = report_.units[index].attempts,
                   .reason = planned.reason,
                   .taken_over_from = lock.dead_owner() ? lock.dead_owner()->str() : ""});
}

void BatchRunner::give_up(std::size_t index) {
    BatchUnit& unit = report_.units[index];
    unit.outcome = UnitOutcome::NotStarted;
    unit.error = "not tried: another image of the scene has shown that it is invalid";
    ++not_tried_;
    books_.append({.kind = LedgerEventKind::UnitNotTried,
                   .unit = plan_[index].task.id,
                   .scene = unit.scene,
                   .error = unit.error});
}

void BatchRunner::end_record(std::size_t index, const Attempt& result, double seconds, bool again) {
    const auto kind_of = [](AttemptEnd end) {
        if (end == AttemptEnd::Done) return LedgerEventKind::UnitFinished;
        return end == AttemptEnd::Interrupted ? LedgerEventKind::UnitInterrupted : LedgerEventKind::UnitFailed;
    };
    books_.append({.kind = kind_of(result.end),
                   .unit = plan_[index].task.id,
                   .scene = report_.units[index].scene,
                   .attempt = report_.units[index].attempts,
                   .exit_code = result.exit_code,
                   .signal = result.signal,
                   .error = result.error,
                   .log = result.log,
                   .seconds = seconds,
                   .again = again});
}

void BatchRunner::finish(std::size_t index, const Attempt& result, double seconds) {
    const ImageJob& job = plan_[index].task.job;
    BatchUnit& unit = report_.units[index];
    unit.signal = result.signal;
    unit.log = result.log;
    time_left_.end(result.end == AttemptEnd::Done ? std::optional(seconds) : std::nullopt);
    switch (result.end) {
        case AttemptEnd::Done:
            unit.outcome = UnitOutcome::Rendered;
            read_statistics(OutputPaths::beside(job.output).json, unit);
            progress_.say(
                fmt::format("[{}/{}] {}: rendered in {}", done_ + 1, stale_, unit.name, format_duration(seconds)));
            return;
        case AttemptEnd::Interrupted:
            unit.outcome = UnitOutcome::Interrupted;
            read_statistics(OutputPaths::beside(job.output).json, unit);
            progress_.say(fmt::format("{}: interrupted, goes on when the batch is started again", unit.name));
            return;
        case AttemptEnd::Invalid:
            invalid_scenes_.insert(job.scene);
            break;
        default:
            break;
    }
    unit.outcome = UnitOutcome::Failed;
    unit.error = result.error;
    ++failed_;
    progress_.say_error(fmt::format("[{}/{}] {}: {}", done_ + 1, stale_, unit.name, failure_in_words(result)));
}

void BatchRunner::show(const std::string& name, const std::string& state, double seconds, double fraction) {
    report_.seconds_left = time_left_.left(seconds, fraction);
    progress_.update({.done = done_,
                      .failed = failed_,
                      .of = stale_,
                      .current = name,
                      .state = state,
                      .left = report_.seconds_left});
}

void BatchRunner::wait_for_others(const std::vector<std::size_t>& held) {
    constexpr std::chrono::milliseconds kBetweenTries(500);
    const BatchUnit& first = report_.units[held.front()];
    if (!std::exchange(has_waited_, true))
        progress_.say(fmt::format("waiting for what other batch processes make: {} by {}{}", first.name, first.host,
                                  held.size() > 1 ? fmt::format(", and {} more", held.size() - 1) : ""));
    show(first.name, "made by " + first.host, 0.0, 0.0);
    write_reports(false);
    ::poll(nullptr, 0, static_cast<int>(kBetweenTries.count()));
}

void BatchRunner::write_reports(bool in_any_case) {
    const bool is_due = in_any_case || books_.are_reports_due();
    const bool is_wanted = watcher_ != nullptr && (in_any_case || watcher_->wants_report());
    if (!is_due && !is_wanted) return;
    report_.seconds = seconds_since(start_);
    report_.written = utc_time();
    if (is_wanted) watcher_->show(report_);
    if (is_due) books_.write_reports(report_);
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
