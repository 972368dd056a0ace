// What stands in JSON that somebody else may have written.
#pragma once

#include <optional>
#include <string>
#include <type_traits>

#include <nlohmann/json.hpp>

namespace etendue {

/// Returns the number at the JSON pointer `place`; none if there is something else.
template <typename Number>
[[nodiscard]] std::optional<Number> number_at(const nlohmann::json& json, const std::string& place) {
    const nlohmann::json::json_pointer pointer(place);
    if (!json.contains(pointer)) return std::nullopt;
    const nlohmann::json& value = json[pointer];
    const bool is_such = std::is_floating_point_v<Number> ? value.is_number()
                         : std::is_unsigned_v<Number>     ? value.is_number_unsigned()
                                                          : value.is_number_integer();
    return is_such ? std::optional(value.get<Number>()) : std::nullopt;
}

/// Returns the text at the JSON pointer `place`; empty if there is something else.
[[nodiscard]] inline std::string text_at(const nlohmann::json& json, const std::string& place) {
    const nlohmann::json::json_pointer pointer(place);
    return json.contains(pointer) && json[pointer].is_string() ? json[pointer].get<std::string>() : std::string();
}

}  // namespace etendue
