// When and how fast a shot runs, as OpenEXR's standard attributes tell it.
#pragma once

#include "image/write.h"

#include <optional>

namespace etendue {

/// Returns `fps` as a ratio: a whole number, a whole number over 1.001 as in television, or a number of thousandths.
/// Returns nothing if `fps` is below a thousandth or above a million.
[[nodiscard]] std::optional<ImageRational> frames_per_second(double fps);

/// Returns the SMPTE time code of frame number `frame`, counted without dropping; nothing for frames below 0, beyond a
/// day, or of more than 30 in a second, which time codes do not count.
[[nodiscard]] std::optional<ImageTimeCode> time_code(int frame, double fps);

/// Returns how many seconds to add to the local time of a file's date for universal time.
[[nodiscard]] float utc_offset();

}  // namespace etendue
