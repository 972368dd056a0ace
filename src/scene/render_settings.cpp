#include "scene/render_settings.h"

#include <charconv>

namespace etendue {

namespace {

/// Reads a whole number, if that is all there is of `text`.
std::optional<int> whole_number(std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// Reads the number behind `prefix`, if that is all there is of `text`.
std::optional<int> number_after(std::string_view prefix, std::string_view text) {
    return text.starts_with(prefix) ? whole_number(text.substr(prefix.size())) : std::nullopt;
}

}  // namespace

std::optional<Strategy> parse_strategy(std::string_view text) {
    if (text == kMergesName) return kMerges;
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    const std::optional<int> s = whole_number(text.substr(0, comma)), t = whole_number(text.substr(comma + 1));
    if (!s || !t || *s < 0 || *t < 0 || Strategy{*s, *t} == kMerges) return std::nullopt;
    return Strategy{*s, *t};
}

std::string strategy_text(const Strategy& strategy) {
    if (strategy == kMerges) return std::string(kMergesName);
    return std::to_string(strategy.s) + "," + std::to_string(strategy.t);
}

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
