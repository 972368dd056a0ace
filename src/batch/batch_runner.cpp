#include "batch/batch_runner.h"

#include "batch/batch_statistics.h"
#include "core/byte_size.h"
#include "core/log.h"
#include "core/process_time.h"
#include "core/write_file.h"
#include "output/software_name.h"
#include "process/memory_left.h"
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

/// Pause after which it is looked again at what other processes make.
constexpr std::chrono::milliseconds kBetweenLooksAtHeld(500);

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
      locks_(options.output),
      jobs_(1) {
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
    jobs_ = options.jobs > 0 ? static_cast<std::size_t>(options.jobs) : usual_jobs(report_.threads);
    report_.jobs = static_cast<int>(jobs_);
    for (const BatchTask& task : tasks_) report_.units.push_back(unknown_unit(task, options_));
    for (const BatchTask& task : tasks.left_out) left_out_.push_back(left_out_unit(task, options_, history_));
    report_.units.insert(report_.units.end(), left_out_.begin(), left_out_.end());
    write_reports(true);
}

const BatchPlan& BatchRunner::plan() {
    std::size_t reported = 0;
    plan_ = make_plan(std::move(tasks_), options_, history_,
                      [&](const std::string& what, const BatchPlan& so_far, std::size_t of) {
                          progress_.update({.done = so_far.size(), .of = of, .under_way = {{what, "planning"}}});
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
    report_.seconds_left = time_left_.left();
    books_.append({.kind = LedgerEventKind::BatchStarted, .units = plan_.size()});
    std::deque<std::size_t> waiting;
    for (std::size_t i = 0; i < plan_.size(); ++i)
        if (plan_[i].is_stale())
            waiting.push_back(i);
        else
            remove_checkpoints(i);
    std::vector<std::size_t> held;
    Clock::time_point looked_at_held = Clock::now();
    while (true) {
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

void BatchRunner::begin_images(std::deque<std::size_t>& waiting, std::vector<std::size_t>& held) {
    while (work_.size() < jobs_ && !waiting.empty() && !interrupt_requested() && has_room_for(waiting.front())) {
        const int threads = threads_for(waiting);
        const std::size_t index = waiting.front();
        waiting.pop_front();
        switch (begin(index, threads)) {
            case Beginning::UnderWay:
                break;
            case Beginning::Over:
                ++done_;
                write_reports(false);
                break;
            case Beginning::Elsewhere:
                held.push_back(index);
        }
    }
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
            report_.units[index].name,
            need == kAllMemory ? "nobody knows how much it needs" : fmt::format("it may need {}B", to_byte_size(need)),
            to_byte_size(left) + "B"));
    return false;
}

int BatchRunner::threads_for(const std::deque<std::size_t>& waiting) const {
    if (jobs_ == 1) return report_.threads;
    std::vector<std::uint64_t> needs;
    for (std::size_t i = 0; i < std::min(waiting.size(), jobs_); ++i)
        needs.push_back(memory_need(plan_[waiting[i]], options_));
    return threads_of_next(shares(), needs, memory_left_now(), jobs_, report_.threads);
}

BatchRunner::Beginning BatchRunner::begin(std::size_t index, int threads) {
    BatchUnit& unit = report_.units[index];
    const PlannedUnit& planned = plan_[index];
    unit.error.clear();  // what was foreseen is found out now
    const auto all = static_cast<double>(std::max(static_cast<std::size_t>(report_.threads), jobs_));
    time_left_.begin(index, planned.error.empty() ? planned.estimated_seconds : 0.0, threads / all);
    try {
        if (invalid_scenes_.contains(planned.task.job.scene)) {
            give_up(index);
            return Beginning::Over;
        }
        LockAttempt got = locks_.take(planned.task.id);
        if (got.lock) return begin_under(std::move(*got.lock), index, threads);
        unit.host = got.holder.str();
        leave_to_others(index);
        return Beginning::Elsewhere;
    } catch (const std::exception& error) {
        // Without the lock, the ledger is not told: what becomes of the image is its owner's to say.
        finish(index, {.end = AttemptEnd::Failed, .error = error.what()}, 0.0);
        return Beginning::Over;
    }
}

BatchRunner::Beginning BatchRunner::begin_under(BatchLock lock, std::size_t index, int threads) {
    auto work = std::make_unique<Work>(Work{.index = index, .lock = std::move(lock), .threads = threads});
    try {
        if (was_made_elsewhere(index, work->lock)) return Beginning::Over;
        fs::create_directories(plan_[index].task.job.output.parent_path());
        const bool is_forced = plan_[index].reason == kForced;
        work->how = {.resume = !is_forced, .force = is_forced};
        report_.units[index].host = report_.host;
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
    end_record(index, failure, 0.0, false);
    finish(index, failure, 0.0);
}

void BatchRunner::leave_to_others(std::size_t index) {
    const PlannedUnit& planned = plan_[index];
    report_.units[index].outcome = UnitOutcome::RunningElsewhere;
    time_left_.end(index, std::nullopt);
    time_left_.add(planned.error.empty() ? planned.estimated_seconds : 0.0);
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
    time_left_.end(index, std::nullopt);
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

BatchRunner::Beginning BatchRunner::make(Work& work) {
    while (true) {
        const std::optional<Attempt> ended = start_attempt(work);
        if (!ended) return Beginning::UnderWay;
        if (const std::optional<Beginning> end = conclude(work, *ended)) return *end;
    }
}

std::optional<Attempt> BatchRunner::start_attempt(Work& work) {
    BatchUnit& unit = report_.units[work.index];
    const BatchTask& task = plan_[work.index].task;
    ++unit.attempts;
    begin_record(work.index, work.lock);
    work.start = Clock::now();
    unit.outcome = UnitOutcome::Running;
    write_reports(false);
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
        task, options_, work.how, fmt::format("[{}/{}] {}", done_ + 1, stale_, task.job.name),
        [&] {
            // Nothing else touches the report while the image is rendered.
            write_reports(false);
            return work.lock.keep_alive();
        },
        *threads_);
}

std::optional<BatchRunner::Beginning> BatchRunner::conclude(Work& work, const Attempt& result) {
    BatchUnit& unit = report_.units[work.index];
    unit.fraction.reset();
    unit.seconds_left.reset();
    const double seconds = seconds_since(work.start);
    if (result.end == AttemptEnd::LockLost) {
        leave_to_others(work.index);
        return Beginning::Elsewhere;
    }
    const bool is_refused = was_refused(result);
    const bool again =
        !interrupt_requested() && (is_refused || (result.end == AttemptEnd::Failed && work.retries < options_.retries));
    end_record(work.index, result, seconds, again);
    if (!again) {
        finish(work.index, result, seconds);
        return Beginning::Over;
    }
    if (!is_refused) ++work.retries;
    work.how.resume = !is_refused;
    if (work.attempt && work.attempt->has_rendered()) work.how.force = false;  // what failed came after the image
    progress_.say(fmt::format("{}: {}; {}", unit.name, failure_in_words(result),
                              is_refused ? "begins anew without the checkpoint"
                                         : fmt::format("tries again ({} of {})", work.retries, options_.retries)));
    return std::nullopt;
}

void BatchRunner::look_after_work(std::vector<std::size_t>& held) {
    std::vector<const ChildAttempt*> attempts;
    for (const auto& work : work_) attempts.push_back(work->attempt.get());
    ChildAttempt::wait_for_any(attempts);
    pass_on_preview_request();
    std::vector<BatchProgressLine::UnderWay> under_way;
    for (auto& work : work_) {
        const std::size_t index = work->index;
        Beginning now = Beginning::UnderWay;
        try {
            const bool goes_on = work->attempt->go_on(
                {.on_message = [&](const std::string& line) { pass_on(plan_[index].task.job, line); },
                 .on_progress = [&](const ChildProgress& progress) { work->progress = progress; },
                 .keep_alive = [&] { return work->lock.keep_alive(); }});
            if (goes_on)
                follow(*work);
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
        if (now == Beginning::Elsewhere) held.push_back(index);
        if (now == Beginning::Over) ++done_;
    }
    std::erase(work_, nullptr);
    for (const auto& work : work_) {
        const ChildProgress& progress = work->progress;
        const double percent = std::floor(progress.fraction * 100.0);
        under_way.push_back({report_.units[work->index].name,
                             progress.phase == "render" ? fmt::format("{:.0f}%", percent) : progress.phase});
    }
    if (!under_way.empty()) show(std::move(under_way));
    write_reports(false);
}

void BatchRunner::pass_on_preview_request() {
    if (!preview_requested()) return;
    bool is_shown = false;
    for (const auto& work : work_) is_shown = work->attempt->show_preview() || is_shown;
    // Until one renders, there is nothing to show.
    if (is_shown) clear_preview_request();
}

void BatchRunner::pass_on(const ImageJob& job, const std::string& line) {
    // What `render` says when it is done, the batch says in its own words.
    if (line.starts_with(job.output.string() + ": ")) return;
    const bool is_of_scene = line.starts_with("note: ") || line.starts_with("warning: ") || line.starts_with("error: ");
    if (is_of_scene && !said_[job.scene].insert(line).second) return;
    progress_.say(fmt::format("{}: {}", job.name, line));
}

void BatchRunner::follow(const Work& work) {
    constexpr double kLeastFraction = 0.02;
    BatchUnit& unit = report_.units[work.index];
    const ChildProgress& now = work.progress;
    const double seconds = seconds_since(work.start);
    const bool renders = now.phase == "render";
    const double fraction = renders ? now.fraction : 0.0;
    time_left_.follow(work.index, seconds, fraction);
    if (renders) {
        unit.fraction = fraction;
        const std::uint64_t pixels = static_cast<std::uint64_t>(unit.width) * static_cast<std::uint64_t>(unit.height);
        if (pixels > 0) unit.spp = static_cast<int>(now.samples / pixels);
    }
    if (fraction > kLeastFraction)
        unit.seconds_left = now.seconds * (1.0 - fraction) / fraction;
    else if (unit.estimated_seconds)
        unit.seconds_left = std::max(0.0, *unit.estimated_seconds * report_.threads / work.threads - seconds);
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
    time_left_.end(index, std::nullopt);
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
    time_left_.end(index, result.end == AttemptEnd::Done ? std::optional(seconds) : std::nullopt);
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

void BatchRunner::show(std::vector<BatchProgressLine::UnderWay> under_way) {
    report_.seconds_left = time_left_.left();
    progress_.update({.done = done_,
                      .failed = failed_,
                      .of = stale_,
                      .under_way = std::move(under_way),
                      .left = report_.seconds_left});
}

void BatchRunner::wait_for_others(const std::vector<std::size_t>& held) {
    const BatchUnit& first = report_.units[held.front()];
    if (!std::exchange(has_waited_, true))
        progress_.say(fmt::format("waiting for what other batch processes make: {} by {}{}", first.name, first.host,
                                  held.size() > 1 ? fmt::format(", and {} more", held.size() - 1) : ""));
    show({{first.name, "made by " + first.host}});
    write_reports(false);
    ::poll(nullptr, 0, static_cast<int>(kBetweenLooksAtHeld.count()));
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
