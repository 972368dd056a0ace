// The page of a batch that runs.
#pragma once

#include "batch/batch_watcher.h"
#include "live/live_server.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace etendue {

/// Shows a batch to a browser while it lives: its table, and its images as they are finished.
class BatchLivePage final : public BatchWatcher {
  public:
    /// Listens on `port`, or on a free one if that is 0, and says where on stderr. Throws IoError if it cannot.
    explicit BatchLivePage(int port);
    /// Waits for a second if a page is open: it, and any other, asks again in that time and sees the end.
    ~BatchLivePage() override;

    [[nodiscard]] bool wants_report() const override;
    void show(const BatchReport& report) override;

  private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] LiveAnswer answer(const LiveRequest& request);
    /// Answers with the state, or that it is the same if it still has the version of the query.
    [[nodiscard]] LiveAnswer status(const LiveRequest& request) const;
    /// Answers with the picture of a unit of the batch.
    [[nodiscard]] LiveAnswer picture(std::size_t unit) const;
    [[nodiscard]] bool is_watched() const;

    std::atomic<Clock::time_point> looked_at_{};  ///< when a page last asked for the state
    std::atomic<Clock::time_point> shown_at_{};
    std::atomic<Clock::duration> took_{};    ///< what the last `show` took
    std::atomic<std::uint64_t> version_{0};  ///< of the state
    mutable std::mutex mutex_;               ///< guards the next two
    std::string status_ = R"({"kind":"batch","title":"","phase":"load","images":[],"report":null})";
    std::vector<std::filesystem::path> pictures_;  ///< picture of each unit; empty where there is none
    LiveServer server_;                            ///< last: it answers from the others
};

}  // namespace etendue
