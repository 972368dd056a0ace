#include "core/byte_size.h"

#include <charconv>
#include <cstddef>

#include <unistd.h>

namespace etendue {

std::optional<std::uint64_t> parse_byte_size(std::string_view text) {
    constexpr std::string_view kUnits = "KMGT";
    constexpr std::size_t kMaxDigits = 6;
    if (text.ends_with("iB"))
        text.remove_suffix(2);
    else if (text.ends_with('B'))
        text.remove_suffix(1);
    if (text.size() < 2 || text.size() > kMaxDigits + 1) return std::nullopt;
    const std::size_t unit = kUnits.find(text.back());
    std::uint64_t number = 0;
    const char* const end = text.data() + text.size() - 1;
    const auto [stopped, error] = std::from_chars(text.data(), end, number);
    if (unit == std::string_view::npos || error != std::errc() || stopped != end) return std::nullopt;
    return number << (10 * (unit + 1));
}

std::string to_byte_size(std::uint64_t bytes) {
    constexpr std::uint64_t kMost = 999999;  // six digits
    if (const std::uint64_t mebibytes = bytes >> 20u; mebibytes <= kMost) return std::to_string(mebibytes) + "M";
    if (const std::uint64_t gibibytes = bytes >> 30u; gibibytes <= kMost) return std::to_string(gibibytes) + "G";
    return std::to_string(bytes >> 40u) + "T";
}

std::uint64_t physical_memory() {
    return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace etendue
