// An input of an image as a JSON object; nlohmann-json finds both functions by the type.
#pragma once

#include "output/statistics.h"

#include <cstdint>
#include <string>

namespace etendue {

/// `json` becomes {"path", "size", "modified", "content"}. `Json` is any form of nlohmann::basic_json.
template <typename Json>
void to_json(Json& json, const InputFile& file) {
    json = Json{{"path", file.path}, {"size", file.size}, {"modified", file.modified}, {"content", file.content}};
}

/// Throws nlohmann::json::exception if `json` is no such object.
template <typename Json>
void from_json(const Json& json, InputFile& file) {
    json.at("path").get_to(file.path);
    json.at("size").get_to(file.size);
    json.at("modified").get_to(file.modified);
    json.at("content").get_to(file.content);
}

}  // namespace etendue
