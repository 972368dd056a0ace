#include "session/progress_display.h"

#include "core/shown_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace etendue {

namespace {

constexpr double kSecondsBetweenLines = 5.0;

std::string format_rate(double samples_per_second) {
    if (samples_per_second >= 1e6) return fmt::format("{:.2f} Msamples/s", samples_per_second * 1e-6);
    if (samples_per_second >= 1e3) return fmt::format("{:.0f} ksamples/s", samples_per_second * 1e-3);
    return fmt::format("{:.0f} samples/s", samples_per_second);
}

}  // namespace

int terminal_width() {
    winsize size{};
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : 80;
}

std::string format_duration(double seconds) {
    if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
    const long long whole = std::llround(seconds);
    if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string format_progress(const std::string& title, const RenderProgress& p, int width) {
    const double seconds = std::max(p.seconds, 1e-9);
    const double remaining = p.fraction > 0.0 ? p.seconds * (1.0 - p.fraction) / p.fraction : 0.0;
    const std::string numbers = fmt::format(
        "{:3.0f}%  {} elapsed, {} left  {}  {:.1f} Mrays/s", std::floor(p.fraction * 100.0), format_duration(p.seconds),
        p.fraction > 0.0 ? format_duration(remaining) : "?", format_rate(static_cast<double>(p.samples) / seconds),
        static_cast<double>(p.rays) / seconds * 1e-6);
    const int room = width - static_cast<int>(title.size() + numbers.size()) - 5;
    std::string bar;
    if (room >= 8) {
        const int cells = std::min(room, 40);
        const int full = static_cast<int>(p.fraction * cells);
        bar = " [" + std::string(static_cast<std::size_t>(full), '#') +
              std::string(static_cast<std::size_t>(cells - full), '.') + "]";
    }
    std::string line = title + bar + " " + numbers;
    return std::string(first_characters(line, static_cast<std::size_t>(std::max(width, 0))));
}

ProgressDisplay::ProgressDisplay(const std::string& title, bool quiet)
    : title_(shown_text(title)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressDisplay::~ProgressDisplay() {
    if (drawn_ && terminal_) std::fputc('\n', stderr);
}

void ProgressDisplay::update(const RenderProgress& progress) {
    if (quiet_) return;
    if (terminal_) {
        const int width = terminal_width() - 1;
        // Erase to the end of the line: the new text may be shorter than the old.
        std::fprintf(stderr, "\r%s\x1b[K", format_progress(title_, progress, width).c_str());
        std::fflush(stderr);
        drawn_ = true;
        return;
    }
    const bool last = progress.fraction >= 1.0;
    if (drawn_ || (!last && progress.seconds - last_line_seconds_ < kSecondsBetweenLines)) return;
    drawn_ = last;
    last_line_seconds_ = progress.seconds;
    std::fprintf(stderr, "%s\n", format_progress(title_, progress, 160).c_str());
}

}  // namespace etendue
