// Text from files as terminals may get it: nothing in it moves the cursor, begins a line or turns the text around.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace etendue {

/// True for a byte of UTF-8 that is not the first one of its character.
[[nodiscard]] bool continues_character(char byte);

/// Bytes from `begin` on that are one character of UTF-8; 1 for a byte that is part of none.
[[nodiscard]] std::size_t character_length(std::string_view text, std::size_t begin);

/// False for control characters, marks that change the direction of the text, line separators and what is no UTF-8.
/// `character` is one, as `character_length` tells.
[[nodiscard]] bool is_shown(std::string_view character);

/// `text` with the number of each character that is not shown in its place: "\x1b", "\u{202e}".
[[nodiscard]] std::string shown_text(std::string_view text);

/// A name from a file as it may stand in a message: `shown_text` of at most 80 bytes, and dots if there are more.
[[nodiscard]] std::string shown(std::string_view name);

/// A text of several lines, each as `shown_text` shows it.
[[nodiscard]] std::string shown_lines(std::string_view text);

/// Shows a message as `shown_text` does, with blanks before each line but the first, so that no name can add a message.
[[nodiscard]] std::string shown_message(std::string_view message);

/// Returns the first characters, as many as fit into `most_bytes`.
[[nodiscard]] std::string_view first_characters(std::string_view text, std::size_t most_bytes);

/// Returns the last characters, as many as fit into `most_bytes`.
[[nodiscard]] std::string_view last_characters(std::string_view text, std::size_t most_bytes);

}  // namespace etendue
