#include "batch/batch_progress.h"

#include "core/log.h"
#include "core/shown_text.h"
#include "session/progress_display.h"
#include "session/usage_error.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <system_error>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

namespace etendue {

namespace {

/// Before that, the speed of the image under way says little about it.
constexpr double kLeastFraction = 0.02;

std::tm local_time(std::chrono::system_clock::time_point time) {
    const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
    std::tm parts{};
    ::localtime_r(&seconds, &parts);
    return parts;
}

/// Returns the line with the local time before it.
std::string stamped(const std::string& text) {
    return fmt::format("{:%Y-%m-%d %H:%M:%S}  {}", local_time(std::chrono::system_clock::now()), text);
}

}  // namespace

void TimeLeft::add(const std::optional<double>& estimate) {
    if (estimate)
        to_come_ += *estimate;
    else
        ++unknown_to_come_;
}

void TimeLeft::begin(const std::optional<double>& estimate) {
    if (estimate)
        to_come_ = std::max(0.0, to_come_ - *estimate);
    else if (unknown_to_come_ > 0)
        --unknown_to_come_;
    current_ = estimate;
    has_current_ = true;
}

void TimeLeft::end(const std::optional<double>& seconds) {
    has_current_ = false;
    if (!seconds) return;
    ++finished_;
    all_finished_seconds_ += *seconds;
    if (!current_) return;
    finished_estimates_ += *current_;
    finished_seconds_ += *seconds;
}

std::optional<double> TimeLeft::expected(const std::optional<double>& estimate) const {
    if (estimate) return finished_estimates_ > 0.0 ? *estimate * finished_seconds_ / finished_estimates_ : *estimate;
    if (finished_ > 0) return all_finished_seconds_ / static_cast<double>(finished_);
    return std::nullopt;
}

std::optional<double> TimeLeft::left(double seconds, double fraction) const {
    double sum = expected(to_come_).value_or(0.0);
    std::optional<double> current = has_current_ ? expected(current_) : std::nullopt;
    if (has_current_ && fraction > kLeastFraction) current = seconds / fraction;
    if (has_current_ && !current) return std::nullopt;
    if (has_current_) sum += std::max(0.0, *current - seconds);
    if (unknown_to_come_ == 0) return sum;
    const std::optional<double> each = finished_ > 0 ? expected(std::nullopt) : current;
    if (!each) return std::nullopt;
    return sum + *each * static_cast<double>(unknown_to_come_);
}

std::string format_line(const BatchProgressLine& line, int width) {
    const std::string before = line.failed > 0 ? fmt::format("[{}/{}, {} failed] ", line.done, line.of, line.failed)
                                               : fmt::format("[{}/{}] ", line.done, line.of);
    std::string after =
        fmt::format("{}{}  {} elapsed", line.state.empty() ? "" : ": ", line.state, format_duration(line.elapsed));
    if (line.left) {
        const auto left = std::chrono::duration_cast<std::chrono::seconds>(std::chrono::duration<double>(*line.left));
        after +=
            fmt::format(", {} left, ends {}", format_duration(*line.left), format_clock(line.now + left, line.now));
    }
    const auto room = static_cast<std::size_t>(std::max(0, width - static_cast<int>(before.size() + after.size())));
    constexpr std::string_view kCut = "...";
    std::string name = shown_text(line.current);
    if (name.size() > room)
        name = room > kCut.size() ? std::string(kCut) + std::string(last_characters(name, room - kCut.size())) : "";
    std::string text = before + name + after;
    return std::string(first_characters(text, static_cast<std::size_t>(std::max(width, 0))));
}

std::string format_clock(std::chrono::system_clock::time_point time, std::chrono::system_clock::time_point now) {
    const std::tm at = local_time(time);
    const std::tm today = local_time(now);
    if (at.tm_yday == today.tm_yday && at.tm_year == today.tm_year) return fmt::format("{:%H:%M}", at);
    if (time - now < std::chrono::days(6)) return fmt::format("{:%a %H:%M}", at);
    return fmt::format("{:%Y-%m-%d %H:%M}", at);
}

BatchProgress::BatchProgress(bool quiet, const std::filesystem::path& log, std::chrono::milliseconds between_lines)
    : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), between_lines_(between_lines) {
    if (log.empty()) return;
    log_.open(log, std::ios::app);
    if (!log_)
        throw UsageError(fmt::format("--log '{}': the file cannot be opened for writing: {}", log.string(),
                                     std::generic_category().message(errno)));
}

BatchProgress::~BatchProgress() {
    clear();
}

void BatchProgress::update(BatchProgressLine line) {
    constexpr std::chrono::milliseconds kBetweenFrames(100);
    constexpr int kWidthOfLines = 200;
    const Clock::time_point now = Clock::now();
    line.elapsed = elapsed();
    line.now = std::chrono::system_clock::now();
    if (now - last_line_ >= between_lines_) {
        last_line_ = now;
        const std::string text = format_line(line, kWidthOfLines);
        record(text);
        if (!quiet_ && !terminal_) std::fprintf(stderr, "%s\n", stamped(text).c_str());
    }
    if (quiet_ || !terminal_ || (is_drawn_ && now - drawn_ < kBetweenFrames)) return;
    std::fprintf(stderr, "\r%s\x1b[K", format_line(line, terminal_width() - 1).c_str());
    std::fflush(stderr);
    is_drawn_ = true;
    drawn_ = now;
}

void BatchProgress::record(const std::string& text) {
    if (log_.is_open()) log_ << stamped(text) << std::endl;
}

void BatchProgress::clear() {
    if (!is_drawn_) return;
    std::fputs("\r\x1b[K", stderr);
    std::fflush(stderr);
    is_drawn_ = false;
}

void BatchProgress::say(const std::string& text) {
    const std::string shown = shown_message(text);
    record(shown);
    if (quiet_) return;
    clear();
    std::fprintf(stderr, "%s\n", (terminal_ ? shown : stamped(shown)).c_str());
}

void BatchProgress::say_error(const std::string& text) {
    record(shown_message(text));
    clear();
    log_error("{}", terminal_ ? text : stamped(text));
}

double BatchProgress::elapsed() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

}  // namespace etendue
