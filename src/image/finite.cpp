#include "image/finite.h"

#include <fmt/format.h>

namespace etendue {

void warn_of_repairs(const RepairedValues& repaired, const std::string& name, const SourceLocation& where,
                     ProblemList& problems) {
    const auto warn = [&](std::size_t count, const char* what) {
        if (count > 0) problems.warning(where, fmt::format("{} values of {} are {}", count, name, what));
    };
    warn(repaired.infinite, "infinite, and are taken for 65504, the largest of half precision");
    warn(repaired.no_number, "no numbers, and are taken for 0");
}

}  // namespace etendue
