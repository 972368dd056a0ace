#include "scene/render_settings.h"

#include <charconv>

namespace etendue {

namespace {

/// The number behind `prefix`, if that is all there is of `text`.
std::optional<int> number_after(std::string_view prefix, std::string_view text) {
    if (!text.starts_with(prefix)) return std::nullopt;
    text.remove_prefix(prefix.size());
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

}  // namespace

std::optional<int> parse_connections(std::string_view text) {
    if (text == "pairwise") return 0;
    const std::optional<int> count = number_after("cache:", text);
    return count && *count >= 1 && *count <= kMostCachedConnections ? count : std::nullopt;
}

std::optional<int> parse_robust(std::string_view text) {
    if (text == "mean") return 0;
    const std::optional<int> count = number_after("mon:", text);
    return count && *count >= kLeastBuckets && *count <= kMostBuckets && *count % 2 == 1 ? count : std::nullopt;
}

}  // namespace etendue
