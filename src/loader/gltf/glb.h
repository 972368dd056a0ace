// The binary container of glTF 2.0 (specification, section 4).
#pragma once

#include "core/error.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace etendue {

struct GlbChunks {
    std::string_view json;
    std::optional<std::span<const unsigned char>> bin;
};

/// True if `bytes` start with the container's magic number.
[[nodiscard]] bool is_glb(std::span<const unsigned char> bytes);

/// Where the JSON of a container begins, and how many bytes it says to have; `header` is all before.
inline constexpr std::size_t kGlbJsonOffset = 20;
[[nodiscard]] std::size_t glb_json_length(std::span<const unsigned char, kGlbJsonOffset> header);

/// The two chunks, as views into `bytes`. Throws SceneError at `where` if a length or a type is wrong.
[[nodiscard]] GlbChunks split_glb(std::span<const unsigned char> bytes, const SourceLocation& where);

}  // namespace etendue
