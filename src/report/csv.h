// Cells of comma-separated values.
#pragma once

#include <string>

namespace etendue {

/// Returns `text` as RFC 4180 has it: in quotes where a comma, a quote or a line's end stands in it.
[[nodiscard]] std::string csv_field(const std::string& text);

/// Returns nine digits of `value`; nothing of what is not finite.
[[nodiscard]] std::string csv_number(double value);

}  // namespace etendue
