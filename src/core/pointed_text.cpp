#include "core/pointed_text.h"

#include <algorithm>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::size_t kCharactersBefore = 48;
constexpr std::size_t kCharactersBehind = 24;
constexpr std::string_view kMore = "...";

bool is_continuation(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0u) == 0x80u;
}

bool is_control(char byte) {
    return static_cast<unsigned char>(byte) < 0x20u || byte == 0x7F;
}

/// Bytes of the character that begins with `lead`, by that byte alone; 1 if it begins none.
std::size_t claimed_length(char lead) {
    const auto byte = static_cast<unsigned char>(lead);
    return byte >= 0xF0u && byte < 0xF8u ? 4 : byte >= 0xE0u ? 3 : byte >= 0xC0u ? 2 : 1;
}

/// Bytes from `begin` on that are one character; 1 for a byte that is part of none.
std::size_t length_at(std::string_view text, std::size_t begin) {
    const std::size_t length = claimed_length(text[begin]);
    if (begin + length > text.size()) return 1;
    const std::string_view rest = text.substr(begin + 1, length - 1);
    return std::ranges::all_of(rest, is_continuation) ? length : 1;
}

bool is_shown(std::string_view character) {
    return character.size() > 1 || (!is_control(character[0]) && static_cast<unsigned char>(character[0]) < 0x80u);
}

}  // namespace

std::string character_at(std::string_view text, std::size_t offset) {
    if (offset >= text.size()) return "end of text";
    while (offset > 0 && is_continuation(text[offset])) --offset;
    const std::string_view character = text.substr(offset, length_at(text, offset));
    return is_shown(character) ? std::string(character)
                               : fmt::format("\\x{:02x}", static_cast<unsigned char>(character[0]));
}

std::string pointed_text(std::string_view text, std::size_t offset, std::size_t indent) {
    offset = std::min(offset, text.size());
    // Bytes are at least as many as characters, so that a window of bytes is as wide at most.
    std::size_t begin = offset > kCharactersBefore ? offset - kCharactersBefore : 0;
    while (begin > 0 && is_continuation(text[begin])) --begin;
    const std::size_t end = std::min(text.size(), offset + kCharactersBehind);
    std::string line(begin > 0 ? kMore : "");
    std::size_t column = 0;
    std::size_t width = line.size();
    for (std::size_t at = begin; at < end; ++width) {
        if (at <= offset) column = width;
        const std::string_view character = text.substr(at, length_at(text, at));
        line += is_shown(character) ? character : " ";
        at += character.size();
    }
    if (offset >= end) column = width;
    if (end < text.size()) line += kMore;
    return fmt::format("{0:{1}}{2}\n{0:{1}}{3:>{4}}", "", indent, line, '^', column + 1);
}

}  // namespace etendue
