// A batch at work: image after image, or several at the same time, each under its lock, beside other processes that do
// the same.
#pragma once

#include "batch/batch_attempt.h"
#include "batch/batch_jobs.h"
#include "batch/batch_ledger.h"
#include "batch/batch_lock.h"
#include "batch/batch_options.h"
#include "batch/batch_plan.h"
#include "batch/batch_progress.h"
#include "batch/batch_record.h"
#include "batch/batch_sequences.h"
#include "batch/batch_watcher.h"
#include "core/parallel.h"
#include "report/batch_report.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace etendue {

class BatchRunner {
  public:
    /// `options`, `history`, `progress` and `watcher`, which may be null, outlive it. A report of images of which
    /// nothing is known is written, and of those that are left out, which `history` and their files tell of.
    BatchRunner(const BatchOptions& options, BatchTasks tasks, LedgerHistory& history, BatchProgress& progress,
                BatchWatcher* watcher = nullptr);

    /// Makes the plan. Ends early when it is interrupted.
    const BatchPlan& plan();

    /// Makes every stale image of the plan that can be made, or waits until another process has. Ends early when it is
    /// interrupted. Writes ledger and reports as it goes on.
    void run();

    /// Records that every stale image has failed, as its plan says, and ends the batch.
    void fail_all();

    [[nodiscard]] const BatchReport& report() const { return record_.report(); }
    /// Returns false if something could not be written into the ledger or the reports; it was said when it happened.
    [[nodiscard]] bool has_kept_books() const { return record_.is_kept(); }

  private:
    /// Removes the checkpoints of an image that is up to date: a render that was killed after its image was complete
    /// has left them.
    void remove_checkpoints(std::size_t index);
    /// Says what became of an image that was to begin.
    enum class Beginning {
        UnderWay,
        Over,       ///< it is made, or cannot be
        Elsewhere,  ///< another process has it now
    };
    /// Makes the images `waiting`, until all are made here or elsewhere, or the batch is interrupted.
    void make_images(std::deque<std::size_t> waiting);
    /// Begins waiting images for as long as there is room for them; `held` gets those that other processes have.
    void begin_images(std::deque<std::size_t>& waiting, std::vector<std::size_t>& held);
    /// Notes that an image is done, or that another process renders it; in that case `held` gets it.
    void leave(std::size_t index, Beginning how, std::vector<std::size_t>& held);
    /// Returns whether the memory that is left holds one more image; if not, says so once.
    bool has_room_for(std::size_t index);
    /// Returns how many threads the next image gets: the first of `waiting` that may begin.
    [[nodiscard]] int threads_for(const std::deque<std::size_t>& waiting) const;
    [[nodiscard]] std::vector<JobShare> shares() const;
    [[nodiscard]] std::uint64_t memory_left_now() const;
    Beginning begin(std::size_t index, int threads);
    Beginning begin_under(BatchLock lock, std::size_t index, int threads);
    /// Returns whether another process has made the image, or failed to, since this one looked at it last.
    bool was_made_elsewhere(std::size_t index, const BatchLock& lock);

    /// An image under way.
    struct Work {
        std::size_t index = 0;
        BatchLock lock;
        int threads = 0;
        AttemptOptions how{};
        int retries = 0;
        std::chrono::steady_clock::time_point start{};  ///< start of the attempt
        ChildProgress progress{};
        std::unique_ptr<ChildAttempt> attempt{};  ///< none if the image is rendered in this process
    };
    /// Waits for what is under way to go on; `held` gets images whose locks are lost.
    void look_after_work(std::vector<std::size_t>& held);
    /// Makes an attempt, or begins one in a process of its own; returns how it ended, if it has.
    std::optional<Attempt> start_attempt(Work& work);
    /// Tries for as long as attempts end at once and there is hope.
    Beginning make(Work& work);
    /// Records how an attempt has ended; nothing if another is to be made.
    std::optional<Beginning> conclude(Work& work, const Attempt& result);
    /// Ends an image that failed for another reason than its attempts.
    void fail(std::size_t index, const std::string& error);
    void show_work();
    void pass_on_preview_request();
    /// Suspends the processes that render, then this one, until it gets SIGCONT; then all go on.
    void stop_with_work();

    void wait_for_others(const std::vector<std::size_t>& held);
    void tidy() const;

    const BatchOptions& options_;
    std::vector<BatchTask> tasks_;     ///< until they are planned
    std::vector<BatchUnit> left_out_;  ///< stand behind the others in the report
    BatchPlan plan_{};
    LedgerHistory& history_;
    BatchProgress& progress_;
    BatchLocks locks_;
    BatchRecord record_;
    std::size_t jobs_;                     ///< images that may be under way at the same time
    std::optional<ThreadPool> threads_{};  ///< if images are rendered in this process
    std::vector<std::unique_ptr<Work>> work_{};
    std::set<std::filesystem::path> invalid_scenes_{};
    FirstFrames first_frames_{};
    bool has_waited_ = false;  ///< for others
    bool has_waited_for_memory_ = false;
};

}  // namespace etendue
