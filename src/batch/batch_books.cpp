#include "batch/batch_books.h"

#include "core/log.h"

#include <algorithm>
#include <exception>

namespace etendue {

std::chrono::steady_clock::duration oldest_reports(std::chrono::steady_clock::duration took, std::size_t units) {
    using Duration = std::chrono::steady_clock::duration;
    constexpr int kLeastShare = 20;
    constexpr Duration kOfEachUnit = std::chrono::milliseconds(10);
    constexpr Duration kOldest = std::chrono::minutes(1);
    const Duration newest = std::chrono::seconds(1) + kOfEachUnit * static_cast<int>(units);
    return std::min(std::max(kLeastShare * took, newest), kOldest);
}

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
    return Clock::now() - written_ > oldest_reports(took_, units_);
}

void BatchBooks::write_reports(const BatchReport& report) {
    const Clock::time_point start = Clock::now();
    units_ = report.units.size();
    try_to([&] { page_.write(report); });
    written_ = Clock::now();
    took_ = written_ - start;
}

}  // namespace etendue
