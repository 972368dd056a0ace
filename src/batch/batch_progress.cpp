#include "batch/batch_progress.h"

#include "core/log.h"
#include "core/process_time.h"
#include "core/shown_text.h"
#include "core/system_error_text.h"
#include "core/write_file.h"
#include "session/progress_display.h"
#include "session/usage_error.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <span>
#include <string_view>
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

/// Returns the end of `name` that fits into `room` characters.
std::string shortened(const std::string& name, std::size_t room) {
    constexpr std::string_view kCut = "...";
    if (name.size() <= room) return name;
    return room > kCut.size() ? std::string(kCut) + std::string(last_characters(name, room - kCut.size())) : "";
}

/// Lists images with how far they are, "a: 43%, b: load, +2", in `room` characters if that is possible.
std::string under_way_text(std::span<const BatchProgressLine::UnderWay> images, std::size_t room) {
    std::string text;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const auto count = [&](std::size_t left_out) {
            return left_out > 0 ? fmt::format(", +{}", left_out) : std::string();
        };
        const std::string state = images[i].state.empty() ? "" : ": " + images[i].state;
        const std::string more = count(images.size() - i - 1);
        const std::size_t taken = state.size() + more.size();
        if (i == 0) {
            text = shortened(shown_text(images[i].name), room - std::min(room, taken)) + state;
            continue;
        }
        const std::string next = ", " + shown_text(images[i].name) + state;
        if (text.size() + next.size() + more.size() > room) return text + count(images.size() - i);
        text += next;
    }
    return text;
}

}  // namespace

void TimeLeft::add(const std::optional<double>& estimate) {
    if (estimate)
        to_come_ += *estimate;
    else
        ++unknown_to_come_;
}

void TimeLeft::begin(std::size_t index, const std::optional<double>& estimate, double share) {
    if (estimate)
        to_come_ = std::max(0.0, to_come_ - *estimate);
    else if (unknown_to_come_ > 0)
        --unknown_to_come_;
    under_way_[index] = {.estimate = estimate, .share = share};
}

void TimeLeft::follow(std::size_t index, double seconds, double fraction, const std::optional<double>& rendered) {
    UnderWay& image = under_way_.at(index);
    image.seconds = seconds;
    image.rendered = rendered.value_or(seconds);
    image.fraction = fraction;
}

void TimeLeft::end(std::size_t index, const std::optional<double>& seconds) {
    const UnderWay image = under_way_.at(index);
    under_way_.erase(index);
    if (!seconds) return;
    const double with_all_threads = *seconds * image.share;
    ++finished_;
    all_finished_seconds_ += with_all_threads;
    if (!image.estimate) return;
    finished_estimates_ += *image.estimate;
    finished_seconds_ += with_all_threads;
}

std::optional<double> TimeLeft::expected(const std::optional<double>& estimate) const {
    if (estimate) return finished_estimates_ > 0.0 ? *estimate * finished_seconds_ / finished_estimates_ : *estimate;
    if (finished_ > 0) return all_finished_seconds_ / static_cast<double>(finished_);
    return std::nullopt;
}

std::optional<double> TimeLeft::left() const {
    double sum = expected(to_come_).value_or(0.0);
    double longest = 0.0;  // nothing ends before the image that takes longest
    const std::optional<double> mean = expected(std::nullopt);
    double each = mean.value_or(0.0);  // of those to come without an estimate
    bool knows_each = mean.has_value();
    for (const auto& [index, image] : under_way_) {
        std::optional<double> whole = expected(image.estimate);
        if (image.fraction > kLeastFraction)
            whole = (image.seconds + image.rendered * (1.0 - image.fraction) / image.fraction) * image.share;
        if (!whole) return std::nullopt;
        const double rest = std::max(0.0, *whole - image.seconds * image.share);
        sum += rest;
        longest = std::max(longest, rest / image.share);
        if (!knows_each) each = *whole;
        knows_each = true;
    }
    if (unknown_to_come_ == 0) return std::max(sum, longest);
    if (!knows_each) return std::nullopt;
    return std::max(sum + each * static_cast<double>(unknown_to_come_), longest);
}

std::string format_count(std::size_t done, std::size_t failed, std::size_t of) {
    return failed > 0 ? fmt::format("[{}/{}, {} failed] ", done, of, failed) : fmt::format("[{}/{}] ", done, of);
}

std::string format_line(const BatchProgressLine& line, int width) {
    const std::string before = format_count(line.done, line.failed, line.of);
    std::string after = fmt::format("  {} elapsed", format_duration(line.elapsed));
    if (line.left) {
        const auto left = std::chrono::duration_cast<std::chrono::seconds>(std::chrono::duration<double>(*line.left));
        after +=
            fmt::format(", {} left, ends {}", format_duration(*line.left), format_clock(line.now + left, line.now));
    }
    const auto room = static_cast<std::size_t>(std::max(0, width - static_cast<int>(before.size() + after.size())));
    const std::string text = before + under_way_text(line.under_way, room) + after;
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
    require_no_pipe(log);
    log_.open(log, std::ios::app);
    if (!log_)
        throw UsageError(fmt::format("--log '{}': the file cannot be opened for writing: {}", log.string(),
                                     system_error_text(errno)));
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
    if (!log_.is_open() || log_ << stamped(text) << std::endl) return;
    log_.close();
    say_error("error: the log (--log) cannot be written: nothing more is logged");
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
    return seconds_since(start_);
}

}  // namespace etendue
