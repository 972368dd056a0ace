#include "batch/batch_ledger.h"

#include "batch/json_lookup.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/system_error_text.h"
#include "process/file_descriptor.h"
#include "process/process_owner.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <fstream>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace etendue {

namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::array<LedgerEventKind, 7> kKinds{LedgerEventKind::BatchStarted, LedgerEventKind::BatchFinished,
                                                LedgerEventKind::UnitStarted,  LedgerEventKind::UnitFinished,
                                                LedgerEventKind::UnitFailed,   LedgerEventKind::UnitInterrupted,
                                                LedgerEventKind::UnitNotTried};

[[noreturn]] void throw_ledger_error(const std::filesystem::path& path, int error) {
    throw IoError(fmt::format("cannot append to {}: {}", path.string(), system_error_text(error)));
}

std::string to_line(const LedgerEvent& event) {
    const ProcessOwner self = this_process();
    OrderedJson json{{"event", event_name(event.kind)}, {"time", utc_time()}, {"host", self.host}, {"pid", self.pid}};
    const auto add = [&json](const char* key, const auto& value, bool is_known) {
        if (is_known) json[key] = value;
    };
    add("unit", event.unit, !event.unit.empty());
    add("scene", event.scene, !event.scene.empty());
    add("attempt", event.attempt, event.attempt > 0);
    add("reason", event.reason, !event.reason.empty());
    add("taken_over_from", event.taken_over_from, !event.taken_over_from.empty());
    add("exit_code", event.exit_code.value_or(0), event.exit_code.has_value());
    add("signal", event.signal, !event.signal.empty());
    add("error", event.error, !event.error.empty());
    add("log", event.log, !event.log.empty());
    const auto rounded = [](const std::optional<double>& seconds) {
        return std::round(seconds.value_or(0.0) * 1e3) / 1e3;
    };
    add("seconds", rounded(event.seconds), event.seconds.has_value());
    add("denoise_seconds", rounded(event.denoise_seconds), event.denoise_seconds.has_value());
    add("pixels", event.pixels, event.pixels > 0);
    add("threads", event.threads, event.threads > 0);
    add("again", true, event.again);
    add("units", event.units.value_or(0), event.units.has_value());
    if (event.kind == LedgerEventKind::BatchFinished) {
        json["rendered"] = event.rendered;
        json["interrupted"] = event.interrupted;
        json["failed"] = event.failed;
        json["not_tried"] = event.not_tried;
    }
    return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

/// True if the file of `size` bytes ends in the middle of a line.
bool is_torn(int file, off_t size) {
    char last = '\n';
    return size > 0 && ::pread(file, &last, 1, size - 1) == 1 && last != '\n';
}

}  // namespace

const char* event_name(LedgerEventKind kind) {
    switch (kind) {
        case LedgerEventKind::BatchStarted:
            return "batch started";
        case LedgerEventKind::BatchFinished:
            return "batch finished";
        case LedgerEventKind::UnitStarted:
            return "unit started";
        case LedgerEventKind::UnitFinished:
            return "unit finished";
        case LedgerEventKind::UnitFailed:
            return "unit failed";
        case LedgerEventKind::UnitInterrupted:
            return "unit interrupted";
        case LedgerEventKind::UnitNotTried:
            return "unit not tried";
    }
    return "?";
}

std::string utc_time() {
    using namespace std::chrono;
    const auto now = system_clock::now();
    const auto part = duration_cast<milliseconds>(now.time_since_epoch()) % 1000;
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(system_clock::to_time_t(now)), part.count());
}

void BatchLedger::append(const LedgerEvent& event) const {
    std::string line = to_line(event);
    require_regular_file(path_);
    const FileDescriptor file(::open(path_.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666));
    if (!file.is_open()) throw_ledger_error(path_, errno);
    // Not every file system appends at once what comes from several machines.
    while (::flock(file.get(), LOCK_EX) != 0)
        if (errno != EINTR) throw_ledger_error(path_, errno);
    struct stat status {};
    if (::fstat(file.get(), &status) != 0) throw_ledger_error(path_, errno);
    if (is_torn(file.get(), status.st_size)) line.insert(line.begin(), '\n');
    const ssize_t written = ::write(file.get(), line.data(), line.size());
    if (written != static_cast<ssize_t>(line.size())) {
        const int error = written < 0 ? errno : ENOSPC;
        if (::ftruncate(file.get(), status.st_size) != 0) throw_ledger_error(path_, errno);
        throw_ledger_error(path_, error);
    }
    if (::fsync(file.get()) != 0) throw_ledger_error(path_, errno);
}

void LedgerHistory::read_new() {
    require_regular_file(path_);
    std::ifstream file(path_, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(read_));
    // A line that is longer than anything that is written here is not kept in memory.
    constexpr std::size_t kLongestLine = std::size_t{1} << 20;
    std::array<char, 65536> buffer{};
    std::string line;
    std::uintmax_t line_bytes = 0;
    while (file) {
        file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
        for (const char c : std::string_view(buffer.data(), static_cast<std::size_t>(file.gcount()))) {
            ++line_bytes;
            if (c != '\n') {
                if (line.size() < kLongestLine) line += c;
                continue;
            }
            take(line);
            read_ += line_bytes;
            line.clear();
            line_bytes = 0;
        }
    }
    is_first_read_ = false;
}

void LedgerHistory::take(const std::string& line) {
    const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
    const std::string unit = text_at(json, "/unit");
    if (unit.empty()) return;
    const std::optional<double> denoise_seconds = number_at<double>(json, "/denoise_seconds");
    const std::uint64_t pixels = number_at<std::uint64_t>(json, "/pixels").value_or(0);
    const int threads = number_at<int>(json, "/threads").value_or(0);
    if (denoise_seconds && pixels > 0 && threads > 0) {
        denoise_thread_seconds_ += *denoise_seconds * threads;
        denoised_pixels_ += static_cast<double>(pixels);
    }
    for (const LedgerEventKind kind : kKinds) {
        if (text_at(json, "/event") != event_name(kind)) continue;
        const std::string error = text_at(json, "/error");
        entries_[unit] = {.kind = kind,
                          .host = text_at(json, "/host"),
                          .exit_code = number_at<int>(json, "/exit_code"),
                          .has_crashed = json.contains("signal"),
                          .error = error.substr(0, error.find('\n')),
                          .is_final = !json.contains("again"),
                          .is_recent = !is_first_read_,
                          .denoise_seconds = denoise_seconds};
    }
}

const LedgerHistory::Entry* LedgerHistory::find(const std::string& unit) const {
    const auto found = entries_.find(unit);
    return found == entries_.end() ? nullptr : &found->second;
}

std::optional<double> LedgerHistory::denoise_seconds(std::uint64_t pixels, int threads) const {
    if (pixels == 0 || threads <= 0 || !(denoised_pixels_ > 0.0)) return std::nullopt;
    return denoise_thread_seconds_ / denoised_pixels_ * static_cast<double>(pixels) / threads;
}

}  // namespace etendue
