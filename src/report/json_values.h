// How the reports' JSON files write what several of them have.
#pragma once

#include "core/pixel_rect.h"

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace etendue {

/// null for what is not known.
template <typename Value>
[[nodiscard]] nlohmann::ordered_json known(const std::optional<Value>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

/// null for an empty text.
[[nodiscard]] inline nlohmann::ordered_json known(const std::string& text) {
    return text.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(text);
}

/// [x0, y0, x1, y1].
[[nodiscard]] inline nlohmann::ordered_json window(const PixelRect& rect) {
    return {rect.x0, rect.y0, rect.x1, rect.y1};
}

}  // namespace etendue
