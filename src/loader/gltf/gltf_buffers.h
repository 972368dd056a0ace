// The bytes behind "buffers" and data URIs.
#pragma once

#include "core/error.h"

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// The bytes of each buffer by the private name that replaces its URI, so that tinygltf never sees a name from the
/// file.
using GltfBuffers = std::map<std::string, std::vector<unsigned char>>;

/// The name of buffer `index`.
[[nodiscard]] std::string buffer_name(std::size_t index);

/// True for a URI whose content stands in itself.
[[nodiscard]] bool is_data_uri(std::string_view uri);

/// The bytes of a base64 data URI; nothing if it is malformed.
[[nodiscard]] std::optional<std::vector<unsigned char>> decode_data_uri(const std::string& uri);

/// Loads every buffer of the checked `document` and replaces its `uri` by the key it has in the result. Each is exactly
/// `byteLength` long; one that only stands in for compressed views is shortened to a byte. `bin` is the binary chunk of
/// a GLB. Files read are added to `inputs`, errors to `problems`.
[[nodiscard]] GltfBuffers load_gltf_buffers(nlohmann::json& document, std::optional<std::span<const unsigned char>> bin,
                                            const std::filesystem::path& directory, const SourceLocation& file,
                                            std::vector<std::filesystem::path>& inputs, ProblemList& problems);

}  // namespace etendue
