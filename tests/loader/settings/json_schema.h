// The subset of JSON Schema (draft 2020-12) that scenes/render.schema.json uses.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace etendue {

/// Everything in `instance` that `schema` does not allow, one message with its JSON pointer each. Throws
/// std::runtime_error at a keyword that is not implemented here, so that no part of a schema is silently ignored.
[[nodiscard]] std::vector<std::string> schema_violations(const nlohmann::json& schema, const nlohmann::json& instance);

}  // namespace etendue
