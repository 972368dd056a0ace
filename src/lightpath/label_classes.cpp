#include "lightpath/label_classes.h"

#include <algorithm>
#include <map>
#include <utility>

namespace etendue {

namespace {

constexpr std::string_view kEscaped = "*\\'\"";

}  // namespace

bool is_label_escape(std::string_view pattern, std::size_t place) {
    return pattern[place] == '\\' && place + 1 < pattern.size() &&
           kEscaped.find(pattern[place + 1]) != std::string_view::npos;
}

std::string label_pattern(std::string_view name) {
    std::string pattern;
    for (const char c : name) {
        if (kEscaped.find(c) != std::string_view::npos) pattern += '\\';
        pattern += c;
    }
    return pattern;
}

bool matches_label(std::string_view pattern, std::string_view name) {
    std::size_t p = 0;
    std::size_t n = 0;
    std::size_t star = std::string_view::npos;  // the last one, from where to take one character more
    std::size_t resume = 0;
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            resume = n;
        } else if (p < pattern.size() && pattern[is_label_escape(pattern, p) ? p + 1 : p] == name[n]) {
            p += is_label_escape(pattern, p) ? 2 : 1;
            ++n;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            n = ++resume;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

LabelClasses::LabelClasses(std::vector<std::string> patterns, std::span<const std::string> names,
                           std::span<const std::string> aliases)
    : patterns_(std::move(patterns)) {
    std::map<std::vector<bool>, std::uint16_t> known;
    const auto class_of = [&](std::vector<bool> matched) {
        const auto [found, is_new] = known.try_emplace(matched, static_cast<std::uint16_t>(matched_.size()));
        if (is_new) matched_.push_back(std::move(matched));
        return found->second;
    };
    (void)class_of(std::vector<bool>(patterns_.size(), false));
    classes_.reserve(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool has_alias = i < aliases.size() && !aliases[i].empty();
        std::vector<bool> matched;
        matched.reserve(patterns_.size());
        for (const std::string& pattern : patterns_)
            matched.push_back(matches_label(pattern, names[i]) || (has_alias && matches_label(pattern, aliases[i])));
        classes_.push_back(class_of(std::move(matched)));
    }
}

bool LabelClasses::matches(std::size_t label, std::string_view pattern) const {
    if (pattern.empty()) return true;
    const auto found = std::ranges::find(patterns_, pattern);
    return found != patterns_.end() && matched_[label][static_cast<std::size_t>(found - patterns_.begin())];
}

std::vector<std::string> LabelClasses::unmatched() const {
    std::vector<std::string> names;
    for (std::size_t p = 0; p < patterns_.size(); ++p)
        if (std::ranges::none_of(matched_, [&](const std::vector<bool>& matched) { return matched[p]; }))
            names.push_back(patterns_[p]);
    return names;
}

}  // namespace etendue
