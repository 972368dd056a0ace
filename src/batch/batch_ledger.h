// What batches did to the images of an output directory, for good: OUT/ledger.jsonl, one JSON object a line, appended.
// docs/batch.md tells its keys.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace etendue {

enum class LedgerEventKind {
    BatchStarted,
    BatchFinished,
    UnitStarted,
    UnitFinished,
    UnitFailed,
    UnitInterrupted,
    UnitNotTried
};

[[nodiscard]] const char* event_name(LedgerEventKind kind);

struct LedgerEvent {
    LedgerEventKind kind = LedgerEventKind::UnitStarted;
    std::string unit{};                       ///< path of the image below OUT, without its extension; empty for batches
    std::string scene{};                      ///< directory or file
    int attempt = 0;                          ///< from 1; 0 if it means nothing
    std::string reason{};                     ///< why a unit is started
    std::string taken_over_from{};            ///< "host:pid" of the dead process that had begun the unit
    std::optional<int> exit_code{};           ///< exit code of the process that ended
    std::string signal{};                     ///< "SIGSEGV", if one ended it
    std::string error{};                      ///< message of the failure
    std::vector<std::string> log{};           ///< last lines of that process, oldest first
    std::optional<double> seconds{};          ///< seconds that it took
    std::optional<double> denoise_seconds{};  ///< part of `seconds` that taking the noise out took
    std::uint64_t pixels = 0;                 ///< pixels of the image; 0 if that means nothing
    int threads = 0;                          ///< threads that made it; 0 if that means nothing
    bool again = false;                       ///< whether this process tries again at once
    std::optional<std::size_t> units{};       ///< units of a batch
    std::size_t rendered = 0;                 ///< units that a batch had rendered when it ended
    std::size_t interrupted = 0;              ///< units that the user had interrupted
    std::size_t failed = 0;                   ///< units that had failed when it ended
    std::size_t not_tried = 0;                ///< units that were not tried, since their scene is invalid
};

/// "2026-11-22T14:03:07.123Z": now, in UTC.
[[nodiscard]] std::string utc_time();

class BatchLedger {
  public:
    /// The ledger at `path`; it is made by the first event.
    explicit BatchLedger(std::filesystem::path path) : path_(std::move(path)) {}

    /// Appends the event with time, host and process id, by one write, and waits until it is on the disk. If the last
    /// line has no end, because a writer died, it gets one first: what was torn stays alone. Several processes may
    /// append at once. Throws IoError, also if the ledger is no regular file; nothing is appended then.
    void append(const LedgerEvent& event) const;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// Tells what a ledger says about each unit in the end. Lines that are not whole, or no such JSON, are skipped.
class LedgerHistory {
  public:
    struct Entry {
        LedgerEventKind kind = LedgerEventKind::UnitStarted;
        std::string host{};                       ///< host of the batch process
        std::optional<int> exit_code{};           ///< exit code of the process that rendered it
        bool has_crashed = false;                 ///< a signal ended the process that rendered it
        std::string error{};                      ///< if it failed; its first line
        bool is_final = true;                     ///< its process did not try again at once
        bool is_recent = false;                   ///< appended after the first `read_new`
        std::optional<double> denoise_seconds{};  ///< seconds that taking the noise out took
    };

    explicit LedgerHistory(std::filesystem::path path) : path_(std::move(path)) {}

    /// Reads what was appended since the last time. A ledger that is missing or cannot be read is empty. Throws IoError
    /// if it is no regular file.
    void read_new();

    /// Returns the last that is known of `unit`; null if nothing is. Valid until the next `read_new`.
    [[nodiscard]] const Entry* find(const std::string& unit) const;

    /// Returns the seconds that taking the noise out of so many pixels with so many threads takes, by the mean of all
    /// images of the ledger; none if it tells of none.
    [[nodiscard]] std::optional<double> denoise_seconds(std::uint64_t pixels, int threads) const;

  private:
    void take(const std::string& line);

    std::filesystem::path path_;
    std::uintmax_t read_ = 0;  ///< bytes: all lines that were whole
    bool is_first_read_ = true;
    std::unordered_map<std::string, Entry> entries_;
    double denoise_thread_seconds_ = 0.0;  ///< sum over all images, seconds times threads
    double denoised_pixels_ = 0.0;
};

}  // namespace etendue
