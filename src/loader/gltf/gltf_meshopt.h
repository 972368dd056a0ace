// KHR_meshopt_compression, and EXT_meshopt_compression that it came from: buffer views whose bytes are compressed with
// meshoptimizer's codecs.
#pragma once

#include "core/error.h"
#include "loader/gltf/gltf_buffers.h"

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// Decompresses every buffer view of the checked `document` that has one of the extensions and that something reads.
/// Each becomes a plain view of a buffer of its own, which is added to `buffers` and taken from `budget`. Errors go to
/// `problems`.
void expand_meshopt_views(nlohmann::json& document, GltfBuffers& buffers, const AbsentBuffers& absent,
                          DecodeBudget& budget, const SourceLocation& file, ProblemList& problems);

}  // namespace etendue
