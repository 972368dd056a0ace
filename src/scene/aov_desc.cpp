#include "scene/aov_desc.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace etendue {

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
    const std::size_t equals = text.find('=');
    aov.name = text.substr(0, equals);
    aov.source = equals == std::string_view::npos ? aov.name : text.substr(equals + 1);
    if (!is_aov_name(aov.name) || aov.source.empty()) return std::nullopt;
    return aov;
}

std::string to_text(const AovDesc& aov) {
    std::string text = aov.name == aov.source ? aov.name : aov.name + "=" + aov.source;
    if (aov.is_float) text += *aov.is_float ? ":float" : ":half";
    return text;
}

}  // namespace etendue
