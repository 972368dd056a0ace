// Cells of comma-separated values.
#pragma once

#include <string>

namespace etendue {

/// Returns `text` as `shown_text` shows it, and in quotes if it contains a comma or a quote (RFC 4180).
[[nodiscard]] std::string csv_field(const std::string& text);

/// Returns nine digits of `value`; nothing of what is not finite.
[[nodiscard]] std::string csv_number(double value);

}  // namespace etendue
