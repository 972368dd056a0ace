// EXT_meshopt_compression: buffer views whose bytes are compressed with meshoptimizer's codecs.
#pragma once

#include "core/error.h"
#include "loader/gltf/gltf_buffers.h"

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// True for a buffer that holds no bytes of its own: only loaders without the extension would need it.
[[nodiscard]] bool is_meshopt_fallback(const nlohmann::json& buffer);

/// Decompresses every buffer view of the checked `document` that has the extension. Each becomes a plain view of a
/// buffer of its own, which is added to `buffers`. Errors go to `problems`.
void expand_meshopt_views(nlohmann::json& document, GltfBuffers& buffers, const SourceLocation& file,
                          ProblemList& problems);

}  // namespace etendue
