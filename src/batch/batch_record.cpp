#include "batch/batch_record.h"

#include "batch/batch_jobs.h"
#include "batch/batch_statistics.h"
#include "batch/batch_unit_report.h"
#include "core/parallel.h"
#include "core/process_time.h"
#include "core/write_file.h"
#include "output/software_name.h"
#include "picture/output_paths.h"
#include "process/process_owner.h"
#include "session/progress_display.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <sstream>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns the seconds that an image is expected to take; 0 if it will fail.
std::optional<double> expected_seconds(const PlannedUnit& planned) {
    return planned.error.empty() ? planned.estimated_seconds : 0.0;
}

/// Returns the time of the image that the table and the page show, and how much of it is older than this attempt; the
/// attempt's own time if the image's statistics are missing.
std::string time_in_words(const BatchUnit& unit, double attempt_seconds) {
    std::string text = format_duration(unit.seconds ? unit.seconds->total() : attempt_seconds);
    if (unit.seconds_before > 0.0) text += fmt::format(", {} of it before", format_duration(unit.seconds_before));
    return text;
}

std::uint64_t pixels_of(const BatchUnit& unit) {
    return static_cast<std::uint64_t>(unit.width) * static_cast<std::uint64_t>(unit.height);
}

}  // namespace

BatchRecord::BatchRecord(const BatchOptions& options, BatchProgress& progress, BatchWatcher* watcher)
    : options_(options), progress_(progress), watcher_(watcher), books_(options.output) {
    std::filesystem::path output = std::filesystem::absolute(options.output).lexically_normal();
    if (!output.has_filename()) output = output.parent_path();
    report_.title = output.filename().string();
    report_.output_directory = output.string();
    report_.program = software_name();
    report_.command = options.command;
    report_.started = utc_time();
    report_.host = this_process().host;
    report_.threads = options.threads > 0 ? options.threads : ThreadPool(0).thread_count();
    report_.jobs = options.jobs > 0 ? options.jobs : static_cast<int>(usual_jobs(report_.threads));
}

std::string BatchRecord::numbered(const std::string& name) const {
    return format_count(done_ + 1, failed_, stale_) + name;
}

void BatchRecord::list_tasks(const std::vector<BatchTask>& tasks, const std::vector<BatchUnit>& left_out) {
    for (const BatchTask& task : tasks) report_.units.push_back(unknown_unit(task, options_));
    report_.units.insert(report_.units.end(), left_out.begin(), left_out.end());
    write_reports(true);
}

void BatchRecord::list_plan(const BatchPlan& plan, const std::vector<BatchUnit>& left_out) {
    planned_ = plan.size();
    report_.units.clear();
    for (const PlannedUnit& unit : plan) {
        report_.units.push_back(planned_unit(unit, options_));
        if (!unit.is_stale()) continue;
        ++stale_;
        time_left_.add(expected_seconds(unit));
        std::istringstream lines(unit.error);
        for (std::string line; std::getline(lines, line);) said_[unit.task.job.scene].insert(line);
    }
    report_.units.insert(report_.units.end(), left_out.begin(), left_out.end());
}

void BatchRecord::begin_batch() {
    report_.state = BatchState::Running;
    report_.seconds_left = time_left_.left();
    books_.append({.kind = LedgerEventKind::BatchStarted, .units = planned_});
}

void BatchRecord::end_batch(bool is_interrupted) {
    report_.seconds_left.reset();
    books_.append({.kind = LedgerEventKind::BatchFinished,
                   .seconds = seconds_since(start_),
                   .units = planned_,
                   .rendered = totals(report_).rendered,
                   .interrupted = totals(report_).interrupted,
                   .failed = failed_,
                   .not_tried = not_tried_});
    end_report(is_interrupted);
}

void BatchRecord::end_report(bool is_interrupted) {
    report_.ended = utc_time();
    report_.state = BatchState::Ended;
    report_.interrupted = is_interrupted;
    write_reports(true);
}

void BatchRecord::begin(std::size_t index, const PlannedUnit& planned, double share) {
    unit(index).error.clear();  // what was foreseen is found out now
    time_left_.begin(index, expected_seconds(planned), share);
}

void BatchRecord::begin_attempt(std::size_t index, const PlannedUnit& planned, const BatchLock& lock) {
    ++unit(index).attempts;
    books_.append({.kind = LedgerEventKind::UnitStarted,
                   .unit = planned.task.id,
                   .scene = planned.task.job.scene.string(),
                   .attempt = unit(index).attempts,
                   .reason = planned.reason,
                   .taken_over_from = lock.dead_owner() ? lock.dead_owner()->str() : ""});
    unit(index).outcome = UnitOutcome::Running;
}

void BatchRecord::follow(std::size_t index, const ChildProgress& progress, double seconds, int threads) {
    constexpr double kLeastFraction = 0.02;
    BatchUnit& unit = report_.units[index];
    const bool renders = progress.phase == "render";
    const double fraction = renders ? progress.fraction : 0.0;
    time_left_.follow(index, seconds, fraction, renders ? std::optional(progress.seconds) : std::nullopt);
    if (renders) {
        unit.fraction = fraction;
        const std::uint64_t pixels = pixels_of(unit);
        if (pixels > 0) unit.spp = static_cast<int>(progress.samples / pixels);
    }
    if (fraction > kLeastFraction)
        unit.seconds_left = progress.seconds * (1.0 - fraction) / fraction;
    else if (unit.estimated_seconds)
        unit.seconds_left = std::max(0.0, *unit.estimated_seconds * report_.threads / threads - seconds);
}

void BatchRecord::end_attempt(std::size_t index, const PlannedUnit& planned, const Attempt& attempt, double seconds,
                              bool again) {
    const auto kind_of = [](AttemptEnd end) {
        if (end == AttemptEnd::Done) return LedgerEventKind::UnitFinished;
        return end == AttemptEnd::Interrupted ? LedgerEventKind::UnitInterrupted : LedgerEventKind::UnitFailed;
    };
    if (attempt.end == AttemptEnd::Done) read_unit(index, planned, attempt.denoise_seconds);
    const bool is_denoised = attempt.denoise_seconds.has_value();
    const int threads = attempt.threads > 0 ? attempt.threads : report_.threads;
    books_.append({.kind = kind_of(attempt.end),
                   .unit = planned.task.id,
                   .scene = unit(index).scene,
                   .attempt = unit(index).attempts,
                   .exit_code = attempt.exit_code,
                   .signal = attempt.signal,
                   .error = attempt.error,
                   .log = attempt.log,
                   .seconds = seconds,
                   .denoise_seconds = attempt.denoise_seconds,
                   .pixels = is_denoised ? pixels_of(unit(index)) : 0,
                   .threads = is_denoised ? threads : 0,
                   .again = again});
}

void BatchRecord::read_unit(std::size_t index, const PlannedUnit& planned,
                            const std::optional<double>& denoise_seconds) {
    BatchUnit& unit = report_.units[index];
    read_statistics(OutputPaths::beside(planned.task.job.output).json, unit);
    if (unit.seconds) unit.seconds->denoise = denoise_seconds.value_or(0.0);
}

void BatchRecord::end(std::size_t index, const PlannedUnit& planned, const Attempt& attempt, double seconds) {
    BatchUnit& unit = report_.units[index];
    unit.signal = attempt.signal;
    unit.log = attempt.log;
    time_left_.end(index, attempt.end == AttemptEnd::Done ? std::optional(seconds) : std::nullopt);
    const std::filesystem::path statistics = OutputPaths::beside(planned.task.job.output).json;
    switch (attempt.end) {
        case AttemptEnd::Done:
            unit.outcome = UnitOutcome::Rendered;
            progress_.say(fmt::format("{}: rendered in {}", numbered(unit.name), time_in_words(unit, seconds)));
            return;
        case AttemptEnd::Interrupted:
            unit.outcome = UnitOutcome::Interrupted;
            // Until the first sample is rendered, the file holds the statistics of an earlier render.
            if (FileStamp::of(statistics) != planned.seen) read_statistics(statistics, unit);
            progress_.say(fmt::format("{}: interrupted, goes on when the batch is started again", unit.name));
            return;
        default:
            unit.outcome = UnitOutcome::Failed;
            unit.error = attempt.error;
            ++failed_;
            progress_.say_error(fmt::format("{}: {}", numbered(unit.name), failure_in_words(attempt)));
    }
}

void BatchRecord::give_up(std::size_t index, const PlannedUnit& planned) {
    BatchUnit& unit = report_.units[index];
    unit.outcome = UnitOutcome::NotStarted;
    unit.error = kNotTried;
    ++not_tried_;
    time_left_.end(index, std::nullopt);
    books_.append(
        {.kind = LedgerEventKind::UnitNotTried, .unit = planned.task.id, .scene = unit.scene, .error = unit.error});
}

void BatchRecord::leave_to_others(std::size_t index, const PlannedUnit& planned) {
    unit(index).outcome = UnitOutcome::RunningElsewhere;
    time_left_.end(index, std::nullopt);
    time_left_.add(expected_seconds(planned));
}

void BatchRecord::end_as_made_elsewhere(std::size_t index, const PlannedUnit& planned, const BatchLock& lock,
                                        bool is_untold) {
    BatchUnit& unit = report_.units[index];
    unit.outcome = UnitOutcome::UpToDate;
    read_unit(index, planned, planned.denoise_seconds);
    time_left_.end(index, std::nullopt);
    if (is_untold)
        books_.append({.kind = LedgerEventKind::UnitFinished,
                       .unit = planned.task.id,
                       .scene = unit.scene,
                       .taken_over_from = lock.dead_owner()->str()});
    progress_.say(fmt::format("{}: made by another batch process", numbered(unit.name)));
}

void BatchRecord::pass_on(const ImageJob& job, const std::string& line) {
    // What `render` says when it is done, the batch says in its own words.
    if (line.starts_with(job.output.string() + ": ")) return;
    const bool is_of_scene = line.starts_with("note: ") || line.starts_with("warning: ") || line.starts_with("error: ");
    if (is_of_scene && !said_[job.scene].insert(line).second) return;
    progress_.say(fmt::format("{}: {}", job.name, line));
}

std::string BatchRecord::failure_in_words(const Attempt& attempt) const {
    return attempt.was_said && !options_.quiet ? "failed" : "failed: " + attempt.error;
}

void BatchRecord::show(std::vector<BatchProgressLine::UnderWay> under_way) {
    report_.seconds_left = time_left_.left();
    progress_.update({.done = done_,
                      .failed = failed_,
                      .of = stale_,
                      .under_way = std::move(under_way),
                      .left = report_.seconds_left});
}

void BatchRecord::write_reports(bool in_any_case) {
    const bool is_due = in_any_case || books_.are_reports_due();
    const bool is_wanted = watcher_ != nullptr && (in_any_case || watcher_->wants_report());
    if (!is_due && !is_wanted) return;
    report_.seconds = seconds_since(start_);
    report_.written = utc_time();
    if (is_wanted) watcher_->show(report_);
    if (is_due) books_.write_reports(report_);
}

}  // namespace etendue
