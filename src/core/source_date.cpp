#include "core/source_date.h"

#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace etendue {

std::optional<std::time_t> source_date() {
    constexpr std::int64_t kEndOf9999 = 253'402'300'799;
    const char* const variable = std::getenv("SOURCE_DATE_EPOCH");
    const std::string_view text = variable != nullptr ? variable : "";
    if (text.empty()) return std::nullopt;
    std::int64_t seconds = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    if (error != std::errc{} || end != text.data() + text.size() || seconds < 0 || seconds > kEndOf9999)
        throw std::invalid_argument(
            fmt::format("SOURCE_DATE_EPOCH is '{}'; it must be a number of seconds since 1970", text));
    return seconds;
}

std::time_t creation_time() {
    return source_date().value_or(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now()));
}

}  // namespace etendue
