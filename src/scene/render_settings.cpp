#include "scene/render_settings.h"

#include <charconv>

namespace etendue {

std::optional<int> parse_connections(std::string_view text) {
    constexpr std::string_view kCache = "cache:";
    if (text == "pairwise") return 0;
    if (!text.starts_with(kCache)) return std::nullopt;
    text.remove_prefix(kCache.size());
    int count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    if (count < 1 || count > kMostCachedConnections) return std::nullopt;
    return count;
}

}  // namespace etendue
