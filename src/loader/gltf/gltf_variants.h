// KHR_materials_variants: sets of materials that a file offers.
#pragma once

#include "scene/scene_desc.h"

#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace etendue {

/// Returns the names of the file's variants.
[[nodiscard]] std::vector<std::string> read_variant_names(const tinygltf::Model& model);

/// Returns the materials that the primitive has in variants of the file.
[[nodiscard]] std::vector<VariantMaterial> read_variant_materials(const tinygltf::Primitive& source);

}  // namespace etendue
