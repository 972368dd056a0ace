#include "batch/batch_books.h"

#include "batch/batch_page.h"
#include "core/error.h"
#include "core/log.h"

namespace etendue {

BatchBooks::BatchBooks(const std::filesystem::path& output) : output_(output), ledger_(output / "ledger.jsonl") {}

void BatchBooks::try_to(const std::function<void()>& write) {
    try {
        write();
    } catch (const IoError& error) {
        if (are_kept_) log_error("error: {}; the batch goes on all the same", error.what());
        are_kept_ = false;
    }
}

void BatchBooks::append(const LedgerEvent& event) {
    try_to([&] { ledger_.append(event); });
}

void BatchBooks::write_reports(const BatchReport& report) {
    constexpr int kLeastShare = 20;
    if (Clock::now() - written_ > kLeastShare * took_) write_last_reports(report);
}

void BatchBooks::write_last_reports(const BatchReport& report) {
    const Clock::time_point start = Clock::now();
    try_to([&] { write_batch_report(report, output_); });
    written_ = Clock::now();
    took_ = written_ - start;
}

}  // namespace etendue
