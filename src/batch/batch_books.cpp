#include "batch/batch_books.h"

#include "core/log.h"

#include <algorithm>
#include <exception>

namespace etendue {

BatchBooks::BatchBooks(const std::filesystem::path& output) : page_(output), ledger_(output / "ledger.jsonl") {}

void BatchBooks::try_to(const std::function<void()>& write) {
    try {
        write();
    } catch (const std::exception& error) {
        if (are_kept_) log_error("error: {}; the batch goes on all the same", error.what());
        are_kept_ = false;
    }
}

void BatchBooks::append(const LedgerEvent& event) {
    try_to([&] { ledger_.append(event); });
}

bool BatchBooks::are_reports_due() const {
    constexpr int kLeastShare = 20;
    constexpr Clock::duration kOfEachUnit = std::chrono::milliseconds(10);
    constexpr Clock::duration kOldest = std::chrono::minutes(1);
    const Clock::duration newest = std::chrono::seconds(1) + kOfEachUnit * static_cast<int>(units_);
    return Clock::now() - written_ > std::min(std::max(kLeastShare * took_, newest), kOldest);
}

void BatchBooks::write_reports(const BatchReport& report) {
    const Clock::time_point start = Clock::now();
    units_ = report.units.size();
    try_to([&] { page_.write(report); });
    written_ = Clock::now();
    took_ = written_ - start;
}

}  // namespace etendue
