// KHR_draco_mesh_compression: primitives whose geometry is compressed with Draco.
#pragma once

#include "loader/gltf/gltf_accessor.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// A decompressed primitive: a list of triangles, whatever the primitive's mode, and the attributes it names.
struct DracoMesh {
    std::vector<std::uint32_t> indices;
    std::map<std::string, AttributeData> attributes;
};

/// Decompresses what `primitive`'s extension refers to. Nothing, and an error at `where`, if the bytes are damaged or
/// the attributes that it names are not in them.
[[nodiscard]] std::optional<DracoMesh> decode_draco(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                                    AccessorReader& accessors, const SourceLocation& where,
                                                    ProblemList& problems);

}  // namespace etendue
