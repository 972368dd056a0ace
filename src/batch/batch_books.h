// What a batch writes about itself: the ledger, and the reports.
#pragma once

#include "batch/batch_ledger.h"
#include "batch/batch_page.h"
#include "report/batch_report.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>

namespace etendue {

/// Returns the age at which report.json and index.html are written anew: one second plus 10 ms for each of `units`,
/// or 20 times as long as writing them last `took` if that is longer, but at most a minute.
[[nodiscard]] std::chrono::steady_clock::duration oldest_reports(std::chrono::steady_clock::duration took,
                                                                 std::size_t units);

/// Images matter more than books: what cannot be written is an error that is told once, and the batch goes on.
class BatchBooks {
  public:
    explicit BatchBooks(const std::filesystem::path& output);

    void append(const LedgerEvent& event);

    /// Returns whether report.json and index.html are to be written anew, as `oldest_reports` says.
    [[nodiscard]] bool are_reports_due() const;
    /// Writes report.json and index.html.
    void write_reports(const BatchReport& report);

    /// Returns false if something could not be written.
    [[nodiscard]] bool are_kept() const { return are_kept_; }

  private:
    using Clock = std::chrono::steady_clock;
    void try_to(const std::function<void()>& write);

    BatchPageWriter page_;
    BatchLedger ledger_;
    bool are_kept_ = true;
    Clock::time_point written_{};
    Clock::duration took_{};
    std::size_t units_ = 0;  ///< units of the last report
};

}  // namespace etendue
