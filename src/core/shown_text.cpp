#include "core/shown_text.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Bytes of the character that begins with `lead`, by that byte alone; 1 if it begins none.
std::size_t claimed_length(char lead) {
    const auto byte = static_cast<unsigned char>(lead);
    return byte >= 0xF0u && byte < 0xF8u   ? 4
           : byte >= 0xE0u && byte < 0xF0u ? 3
           : byte >= 0xC0u && byte < 0xE0u ? 2
                                           : 1;
}

/// The number of a character of several bytes.
char32_t code_point(std::string_view character) {
    // The lead byte has as many ones before its first zero as the character has bytes.
    char32_t code = static_cast<unsigned char>(character[0]) & (0xFFu >> (character.size() + 1));
    for (const char byte : character.substr(1)) code = code << 6u | (static_cast<unsigned char>(byte) & 0x3Fu);
    return code;
}

/// The least number that needs as many bytes: smaller ones, surrogates and what is beyond Unicode are no UTF-8.
bool is_encoded_right(char32_t code, std::size_t bytes) {
    constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
    return code >= kLeast[bytes] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
}

struct Range {
    char32_t first;
    char32_t last;
};
/// C1 controls, marks of direction, separators of lines and of paragraphs, embeddings, isolates, marks that nobody
/// sees.
constexpr std::array<Range, 7> kHidden{{{0x80, 0x9F},
                                        {0x61C, 0x61C},
                                        {0x200E, 0x200F},
                                        {0x2028, 0x202E},
                                        {0x2060, 0x206F},
                                        {0xFEFF, 0xFEFF},
                                        {0xFFF9, 0xFFFB}}};

}  // namespace

bool continues_character(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0u) == 0x80u;
}

std::size_t character_length(std::string_view text, std::size_t begin) {
    const std::size_t length = claimed_length(text[begin]);
    if (length == 1 || begin + length > text.size()) return 1;
    const std::string_view character = text.substr(begin, length);
    const bool is_whole = std::ranges::all_of(character.substr(1), continues_character);
    return is_whole && is_encoded_right(code_point(character), length) ? length : 1;
}

bool is_shown(std::string_view character) {
    if (character.size() == 1) return character[0] >= 0x20 && character[0] < 0x7F;
    const char32_t code = code_point(character);
    return std::ranges::none_of(kHidden,
                                [code](const Range& range) { return range.first <= code && code <= range.last; });
}

std::string shown_text(std::string_view text) {
    std::string shown;
    shown.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        const std::string_view character = text.substr(at, character_length(text, at));
        if (is_shown(character))
            shown += character;
        else if (character.size() == 1)
            shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(character[0]));
        else
            shown += fmt::format("\\u{{{:x}}}", static_cast<std::uint32_t>(code_point(character)));
        at += character.size();
    }
    return shown;
}

std::string shown(std::string_view name) {
    constexpr std::size_t kLongest = 80;
    const std::string_view part = first_characters(name, kLongest);
    return shown_text(part) + (part.size() < name.size() ? "..." : "");
}

std::string shown_lines(std::string_view text) {
    std::string lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines += shown_text(text.substr(begin, end - begin));
        if (end < text.size()) lines += '\n';
        begin = end + 1;
    }
    return lines;
}

std::string shown_message(std::string_view message) {
    std::string shown = shown_lines(message);
    for (std::size_t end = shown.find('\n'); end != std::string::npos; end = shown.find('\n', end + 1))
        if (end + 1 < shown.size() && shown[end + 1] != ' ') shown.insert(end + 1, "  ");
    return shown;
}

std::string_view first_characters(std::string_view text, std::size_t most_bytes) {
    std::size_t end = 0;
    while (end < text.size()) {
        const std::size_t next = end + character_length(text, end);
        if (next > most_bytes) break;
        end = next;
    }
    return text.substr(0, end);
}

std::string_view last_characters(std::string_view text, std::size_t most_bytes) {
    std::size_t begin = text.size() - std::min(text.size(), most_bytes);
    while (begin < text.size() && continues_character(text[begin])) ++begin;
    return text.substr(begin);
}

}  // namespace etendue
