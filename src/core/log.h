// Log lines on stderr. The only place that knows which library writes them.
#pragma once

#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace etendue {

enum class LogLevel { Debug, Info, Warning, Error, Off };

/// Lines below `level` are not written. The default is Info.
void set_log_level(LogLevel level);
/// Writes `line` as `shown_message` shows it: it may hold names from any file.
void log_line(LogLevel level, std::string_view line);

template <typename... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
    log_line(LogLevel::Info, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
    log_line(LogLevel::Warning, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void log_error(fmt::format_string<Args...> format, Args&&... args) {
    log_line(LogLevel::Error, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace etendue
