#include "batch/batch_books.h"

#include "core/error.h"
#include "core/log.h"

#include <algorithm>

namespace etendue {

BatchBooks::BatchBooks(const std::filesystem::path& output) : page_(output), ledger_(output / "ledger.jsonl") {}

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

bool BatchBooks::are_reports_due() const {
    constexpr int kLeastShare = 20;
    constexpr Clock::duration kNewest = std::chrono::seconds(1);
    constexpr Clock::duration kOldest = std::chrono::minutes(1);
    return Clock::now() - written_ > std::clamp(kLeastShare * took_, kNewest, kOldest);
}

void BatchBooks::write_reports(const BatchReport& report) {
    const Clock::time_point start = Clock::now();
    try_to([&] { page_.write(report); });
    written_ = Clock::now();
    took_ = written_ - start;
}

}  // namespace etendue
