// Showing where in a text something is wrong.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace etendue {

/// The character of UTF-8 that byte `offset` of `text` belongs to, for a message; "end of text" behind the last one,
/// and its number, "\x0a", if it is a control character or no UTF-8.
[[nodiscard]] std::string character_at(std::string_view text, std::size_t offset);

/// Two lines, the second of which points with '^' at byte `offset` of `text` in the first: each behind `indent` blanks,
/// without a line break at the end. Of a long text only what lies around is shown. What cannot be shown on one line is
/// a blank.
[[nodiscard]] std::string pointed_text(std::string_view text, std::size_t offset, std::size_t indent);

}  // namespace etendue
