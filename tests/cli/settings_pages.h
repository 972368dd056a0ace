// The schema of render.json and the table of docs/render-json.md, made of the table of settings.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace etendue::test {

/// Returns `schema` with the property of each setting as the table has it.
[[nodiscard]] nlohmann::ordered_json with_settings(nlohmann::ordered_json schema);

/// Returns the text of the file: what fits into a line of 100 characters stands in one.
[[nodiscard]] std::string schema_text(const nlohmann::ordered_json& schema);

/// Returns `page` with the table of settings between its two marks.
[[nodiscard]] std::string with_settings_table(const std::string& page);

}  // namespace etendue::test
