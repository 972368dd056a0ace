#include "batch/batch_progress.h"

#include "core/shown_text.h"
#include "session/progress_display.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace etendue {

namespace {

/// Before that, the speed of the image under way says little about it.
constexpr double kLeastFraction = 0.02;

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
    if (line.left) after += fmt::format(", {} left", format_duration(*line.left));
    const auto room = static_cast<std::size_t>(std::max(0, width - static_cast<int>(before.size() + after.size())));
    constexpr std::string_view kCut = "...";
    std::string name = shown_text(line.current);
    if (name.size() > room)
        name = room > kCut.size() ? std::string(kCut) + std::string(last_characters(name, room - kCut.size())) : "";
    std::string text = before + name + after;
    return std::string(first_characters(text, static_cast<std::size_t>(std::max(width, 0))));
}

BatchProgress::BatchProgress(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}

BatchProgress::~BatchProgress() {
    clear();
}

void BatchProgress::update(BatchProgressLine line) {
    constexpr std::chrono::milliseconds kBetweenFrames(100);
    const Clock::time_point now = Clock::now();
    if (quiet_ || !terminal_ || (is_drawn_ && now - drawn_ < kBetweenFrames)) return;
    line.elapsed = elapsed();
    std::fprintf(stderr, "\r%s\x1b[K", format_line(line, terminal_width() - 1).c_str());
    std::fflush(stderr);
    is_drawn_ = true;
    drawn_ = now;
}

void BatchProgress::clear() {
    if (!is_drawn_) return;
    std::fputs("\r\x1b[K", stderr);
    std::fflush(stderr);
    is_drawn_ = false;
}

void BatchProgress::say(const std::string& text) {
    if (quiet_) return;
    clear();
    std::fprintf(stderr, "%s\n", shown_message(text).c_str());
}

double BatchProgress::elapsed() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

}  // namespace etendue
