// The record of a batch: ledger, report and messages while it works.
#pragma once

#include "batch/batch_attempt.h"
#include "batch/batch_books.h"
#include "batch/batch_lock.h"
#include "batch/batch_options.h"
#include "batch/batch_plan.h"
#include "batch/batch_progress.h"
#include "batch/batch_watcher.h"
#include "report/batch_report.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace etendue {

/// Keeps the report, the ledger, the line of progress and the estimate of the time that is left. Images are named by
/// their place in the plan, which is that in the report.
class BatchRecord {
  public:
    /// `options`, `progress` and `watcher`, which may be null, outlive it.
    BatchRecord(const BatchOptions& options, BatchProgress& progress, BatchWatcher* watcher);

    [[nodiscard]] const BatchReport& report() const { return report_; }
    [[nodiscard]] BatchUnit& unit(std::size_t index) { return report_.units[index]; }
    /// Returns false if something could not be written; it was said when it happened.
    [[nodiscard]] bool is_kept() const { return books_.are_kept(); }
    /// Returns `name` after the place of the image under way among those that are to be made, and the number of those
    /// that failed: "[3/10, 1 failed] box".
    [[nodiscard]] std::string numbered(const std::string& name) const;

    /// Reports images of which nothing is known, and `left_out` behind them.
    void list_tasks(const std::vector<BatchTask>& tasks, const std::vector<BatchUnit>& left_out);
    /// Reports the images of the plan, and `left_out` behind them.
    void list_plan(const BatchPlan& plan, const std::vector<BatchUnit>& left_out);

    void begin_batch();
    void end_batch(bool is_interrupted);
    /// Ends the report alone, of a batch that never began.
    void end_report(bool is_interrupted);

    /// Notes that an image begins, with `share` of the threads, (0, 1].
    void begin(std::size_t index, const PlannedUnit& planned, double share);
    void begin_attempt(std::size_t index, const PlannedUnit& planned, const BatchLock& lock);
    /// Tells what a process does that makes an image with `threads` threads, so many seconds after the attempt began.
    void follow(std::size_t index, const ChildProgress& progress, double seconds, int threads);
    void end_attempt(std::size_t index, const PlannedUnit& planned, const Attempt& attempt, double seconds, bool again);
    /// Ends an image as its last attempt has ended.
    void end(std::size_t index, const PlannedUnit& planned, const Attempt& attempt, double seconds);
    /// Ends an image that is not tried, since another image of its scene has shown that the scene is invalid.
    void give_up(std::size_t index, const PlannedUnit& planned);
    /// Notes that another process has the image, which counts as one to come.
    void leave_to_others(std::size_t index, const PlannedUnit& planned);
    /// Ends an image that another process has made. `is_untold` if that died before it wrote so into the ledger.
    void end_as_made_elsewhere(std::size_t index, const PlannedUnit& planned, const BatchLock& lock, bool is_untold);
    /// Counts an image as done, whatever became of it.
    void count_done() { ++done_; }

    /// Passes on what a process says about an image, but for notes and warnings that its scene has had already.
    void pass_on(const ImageJob& job, const std::string& line);
    /// Says why an attempt failed; what its process has said itself is not said again, unless `quiet`.
    [[nodiscard]] std::string failure_in_words(const Attempt& attempt) const;
    void show(std::vector<BatchProgressLine::UnderWay> under_way);
    /// Writes the report as it is now, if that is due or `in_any_case`.
    void write_reports(bool in_any_case);

  private:
    /// Reads what the image's files tell, whose noise took `denoise_seconds` to take out.
    void read_unit(std::size_t index, const PlannedUnit& planned, const std::optional<double>& denoise_seconds);

    const BatchOptions& options_;
    BatchProgress& progress_;
    BatchWatcher* watcher_;  ///< null if nobody looks on
    BatchBooks books_;
    BatchReport report_{};
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    TimeLeft time_left_{};
    std::map<std::filesystem::path, std::set<std::string>> said_{};  ///< lines about each scene
    std::size_t planned_ = 0;
    std::size_t stale_ = 0;
    std::size_t done_ = 0;  ///< images of the stale ones that are done
    std::size_t failed_ = 0;
    std::size_t not_tried_ = 0;
};

}  // namespace etendue
