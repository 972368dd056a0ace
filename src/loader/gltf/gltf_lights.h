// The lights of nodes: KHR_lights_punctual, and the measured lamps of EXT_lights_ies.
#pragma once

#include "loader/gltf/gltf_accessor.h"
#include "loader/gltf/gltf_document.h"
#include "scene/scene_desc.h"

#include <cstddef>
#include <map>
#include <set>
#include <vector>

namespace etendue {

class LightReader {
  public:
    LightReader(const GltfDocument& document, AccessorReader& accessors, SceneDesc& scene, ProblemList& problems);

    /// True if `node` has a light, or two.
    [[nodiscard]] static bool has_light(const tinygltf::Node& node);
    /// Returns the bytes of the longest name that a light or a profile of the file has.
    [[nodiscard]] static std::size_t longest_name(const GltfDocument& document);
    /// Adds the lights of `node`, which lies at `to_world` (a rigid transform) and at `where` in the file.
    void place(const tinygltf::Node& node, const Mat4f& to_world, const SourceLocation& where);

  private:
    void place_punctual(const tinygltf::Node& node, std::size_t index, const Mat4f& to_world);
    void place_measured(const tinygltf::Node& node, const tinygltf::Value& extension, const Mat4f& to_world,
                        const SourceLocation& where);
    /// The profile with this index, read when first asked for. An invalid handle if it cannot be used; why has then
    /// been reported once.
    [[nodiscard]] Handle<IesProfileDesc> profile(int index);
    [[nodiscard]] Handle<IesProfileDesc> read_profile(const tinygltf::Value& source, const SourceLocation& where);
    [[nodiscard]] std::vector<unsigned char> profile_bytes(const tinygltf::Value& source, const SourceLocation& where);

    const GltfDocument& document_;
    AccessorReader& accessors_;
    SceneDesc& scene_;
    ProblemList& problems_;
    std::map<int, Handle<IesProfileDesc>> profiles_;  ///< by their index in the file
    std::set<std::size_t> seen_spots_;                ///< indices in the file of spots whose cones were looked at
};

}  // namespace etendue
