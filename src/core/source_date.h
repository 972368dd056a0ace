// When files say that they were made.
#pragma once

#include <ctime>
#include <optional>

namespace etendue {

/// Returns the date in $SOURCE_DATE_EPOCH, in seconds since 1970, which lets files that are made again have the same
/// bytes; none if it is unset or empty. Throws std::invalid_argument if it is no such number.
[[nodiscard]] std::optional<std::time_t> source_date();

/// Returns the time of `source_date`, or the present one where that is none.
[[nodiscard]] std::time_t creation_time();

}  // namespace etendue
