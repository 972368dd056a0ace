#include "report/csv.h"

#include "core/shown_text.h"

#include <cmath>

#include <fmt/format.h>

namespace etendue {

std::string csv_field(const std::string& text) {
    const std::string shown = shown_text(text);
    if (shown.find_first_of(",\"") == std::string::npos) return shown;
    std::string quoted(1, '"');
    for (const char c : shown) {
        if (c == '"') quoted += '"';
        quoted += c;
    }
    quoted += '"';
    return quoted;
}

std::string csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{:.9g}", value) : "";
}

}  // namespace etendue
