// Strict JSON: depth-limited, without duplicate keys, with JSON pointers for messages.
#pragma once

#include "core/error.h"

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// Deepest nesting of arrays and objects that is accepted; glTF needs about ten.
inline constexpr int kMaxJsonDepth = 64;

/// The parsed `text`. Throws SceneError at `where` if it is not UTF-8 JSON, nests deeper than kMaxJsonDepth or repeats
/// a key within an object.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const SourceLocation& where);

/// `pointer` extended by one reference token, escaped as in RFC 6901.
[[nodiscard]] std::string child_pointer(std::string_view pointer, std::string_view key);
[[nodiscard]] std::string child_pointer(std::string_view pointer, std::size_t index);

/// Returns the kind of JSON value that `value` is, with the kind's article, for messages: "a string", "an array".
[[nodiscard]] std::string_view json_kind(const nlohmann::json& value);

}  // namespace etendue
