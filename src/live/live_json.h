// What pages are told, as JSON.
#pragma once

#include "color/color_config.h"
#include "live/live_image.h"

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace etendue {

/// Returns the facts of an image; null if there is none.
[[nodiscard]] nlohmann::json json_of(const std::optional<LiveImageFacts>& facts);

/// Lists the displays of `colors`, each with its views.
[[nodiscard]] nlohmann::json displays_of(const ColorConfig& colors);

/// Returns `json` as text, with what is no UTF-8 repaired.
[[nodiscard]] std::string text_of(const nlohmann::json& json);

}  // namespace etendue
