// Plain text for terminals.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace etendue {

/// A line holds no more, whatever is to be shown.
inline constexpr std::size_t kMostColumns = 100;

/// Rows of cells, those of the first column flush left, the others right, each line after `indent` spaces. A row of
/// one cell is a heading. Lines that would be longer than kMostColumns are cut.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t indent = 0);

/// `text` in lines of at most kMostColumns, broken at spaces where there are any; all but the first after `indent`
/// spaces.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t indent = 0);

}  // namespace etendue
