#include "scene/aov_desc.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <system_error>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns true if `text` asks for a Cryptomatte, as "cryptomatte" and "NAME=cryptomatte_object" do, and has no colon
/// behind the '='; lights and expressions may have numbers behind colons of their own.
bool has_ranks(std::string_view text) {
    const std::size_t equals = text.find('=');
    const std::string_view source = equals == std::string_view::npos ? text : text.substr(equals + 1);
    return source.starts_with("cryptomatte") && source.find(':') == std::string_view::npos;
}

}  // namespace

bool is_aov_name(std::string_view name) {
    constexpr std::size_t kLongest = 100;
    return !name.empty() && name.size() <= kLongest &&
           std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

std::optional<AovDesc> parse_aov(std::string_view text) {
    AovDesc aov;
    for (const auto& [suffix, is_float] : {std::pair{":half", false}, std::pair{":float", true}})
        if (text.ends_with(suffix)) {
            aov.is_float = is_float;
            text.remove_suffix(std::string_view(suffix).size());
            break;
        }
    const std::size_t colon = text.rfind(':');
    if (colon != std::string_view::npos && has_ranks(text.substr(0, colon))) {
        int ranks = 0;
        const std::string_view digits = text.substr(colon + 1);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), ranks);
        if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
        aov.ranks = ranks;
        text = text.substr(0, colon);
    }
    const std::size_t equals = text.find('=');
    aov.name = text.substr(0, equals);
    aov.source = equals == std::string_view::npos ? aov.name : text.substr(equals + 1);
    if (!is_aov_name(aov.name) || aov.source.empty()) return std::nullopt;
    return aov;
}

std::string to_text(const AovDesc& aov) {
    std::string text = aov.name == aov.source ? aov.name : aov.name + "=" + aov.source;
    if (aov.ranks) text += fmt::format(":{}", *aov.ranks);
    if (aov.is_float) text += *aov.is_float ? ":float" : ":half";
    return text;
}

}  // namespace etendue
