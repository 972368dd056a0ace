// What the matrix of agreement says, in Markdown.
#pragma once

#include "agreement/room_comparison.h"

#include <span>
#include <string>

namespace etendue::test {

/// A few numbers, one table for each light and one for media, and who is left out where and why. `significance` is that
/// of all comparisons together.
[[nodiscard]] std::string markdown_report(std::span<const RoomComparison> rooms, double significance);

/// `document` with `report` between its lines "<!-- results -->" and "<!-- end of results -->", in place of what is
/// there. Throws std::invalid_argument if it lacks one of them.
[[nodiscard]] std::string with_report(const std::string& document, const std::string& report);

}  // namespace etendue::test
