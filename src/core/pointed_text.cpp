#include "core/pointed_text.h"

#include "core/shown_text.h"

#include <algorithm>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::size_t kCharactersBefore = 48;
constexpr std::size_t kCharactersBehind = 24;
constexpr std::string_view kMore = "...";

}  // namespace

std::string character_at(std::string_view text, std::size_t offset) {
    if (offset >= text.size()) return "end of text";
    while (offset > 0 && continues_character(text[offset])) --offset;
    const std::string_view character = text.substr(offset, character_length(text, offset));
    return shown_text(character);
}

std::string pointed_text(std::string_view text, std::size_t offset, std::size_t indent) {
    offset = std::min(offset, text.size());
    // Bytes are at least as many as characters, so that a window of bytes is as wide at most.
    std::size_t begin = offset > kCharactersBefore ? offset - kCharactersBefore : 0;
    while (begin > 0 && continues_character(text[begin])) --begin;
    const std::size_t end = std::min(text.size(), offset + kCharactersBehind);
    std::string line(begin > 0 ? kMore : "");
    std::size_t column = 0;
    std::size_t width = line.size();
    for (std::size_t at = begin; at < end; ++width) {
        if (at <= offset) column = width;
        const std::string_view character = text.substr(at, character_length(text, at));
        line += is_shown(character) ? character : " ";
        at += character.size();
    }
    if (offset >= end) column = width;
    if (end < text.size()) line += kMore;
    return fmt::format("{0:{1}}{2}\n{0:{1}}{3:>{4}}", "", indent, line, '^', column + 1);
}

}  // namespace etendue
