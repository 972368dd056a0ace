// Numbers as tables show them to people: three significant digits and a prefix.
#pragma once

#include <string>

namespace etendue {

/// "12.6 M"; "-" for what is not finite.
[[nodiscard]] std::string human_count(double value);

/// "12.6 ms", "3.21 s", "12.4 min".
[[nodiscard]] std::string human_seconds(double value);

/// "1.50 GiB".
[[nodiscard]] std::string human_bytes(double value);

/// Writes a share in [0, 1] as a percentage: "37.2%".
[[nodiscard]] std::string human_percent(double share);
/// Writes a share that was estimated from a sample: "66%", below 10% with one decimal.
[[nodiscard]] std::string rough_percent(double share);

}  // namespace etendue
