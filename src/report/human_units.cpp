#include "report/human_units.h"

#include <cmath>
#include <span>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

struct Unit {
    double size;
    std::string_view name;
};

/// Three significant digits, no exponent for what is below 1000.
std::string digits(double value) {
    const double size = std::abs(value);
    return fmt::format("{:.{}f}", value, size < 9.995 ? 2 : size < 99.95 ? 1 : 0);
}

/// Writes `value` in the first of `units`, from the largest down, that `value` is at least one of; else in the last.
std::string in_units(double value, std::span<const Unit> units) {
    if (!std::isfinite(value)) return "-";
    const Unit* chosen = &units.back();
    for (const Unit& unit : units)
        if (std::abs(value) >= 0.9995 * unit.size) {
            chosen = &unit;
            break;
        }
    const std::string number = digits(value / chosen->size);
    return chosen->name.empty() ? number : fmt::format("{} {}", number, chosen->name);
}

}  // namespace

std::string human_count(double value) {
    static constexpr Unit kUnits[]{{1e12, "T"}, {1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1.0, ""}};
    const bool small_whole = std::abs(value) < 1e3 && value == std::floor(value);
    return small_whole ? fmt::format("{:.0f}", value) : in_units(value, kUnits);
}

std::string human_seconds(double value) {
    static constexpr Unit kUnits[]{{1.0, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}};
    if (value == 0.0) return "0 s";
    // Two minutes, but 119 seconds.
    if (std::isfinite(value) && value >= 7200.0) return fmt::format("{} h", digits(value / 3600.0));
    if (std::isfinite(value) && value >= 120.0) return fmt::format("{} min", digits(value / 60.0));
    return in_units(value, kUnits);
}

std::string human_bytes(double value) {
    static constexpr Unit kUnits[]{
        {1099511627776.0, "TiB"}, {1073741824.0, "GiB"}, {1048576.0, "MiB"}, {1024.0, "KiB"}};
    return in_units(value, kUnits);
}

std::string human_percent(double share) {
    return std::isfinite(share) ? fmt::format("{:.1f}%", 100.0 * share) : "-";
}

std::string rough_percent(double share) {
    return std::isfinite(share) ? fmt::format("{:.{}f}%", 100.0 * share, share < 0.0995 ? 1 : 0) : "-";
}

}  // namespace etendue
