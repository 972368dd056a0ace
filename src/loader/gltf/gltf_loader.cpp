#include "loader/gltf/gltf_loader.h"

#include "loader/gltf/gltf_accessor.h"
#include "loader/gltf/gltf_document.h"
#include "loader/gltf/gltf_material.h"
#include "loader/gltf/gltf_mesh.h"
#include "loader/gltf/gltf_nodes.h"
#include "loader/gltf/gltf_textures.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

namespace etendue {

bool GltfLoader::can_load(const std::filesystem::path& file) const {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    if (extension == ".gltf" || extension == ".glb") return true;

    std::array<char, 4> magic{};
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code)) return false;
    std::ifstream stream(file, std::ios::binary);
    stream.read(magic.data(), magic.size());
    return stream && std::string_view(magic.data(), magic.size()) == "glTF";
}

void GltfLoader::load(const std::filesystem::path& file, SceneDesc& scene, ProblemList& problems) const {
    const GltfDocument document = read_gltf_document(file, problems);
    scene.extensions_used = document.extensions_used;
    scene.extensions_ignored = document.extensions_ignored;
    scene.inputs.insert(scene.inputs.end(), document.inputs.begin(), document.inputs.end());
    if (document.has_animations) {
        problems.warning(document.at("/animations"), "animations are not supported: the scene is shown at rest");
    }
    if (document.has_skins) {
        problems.warning(document.at("/skins"), "skins are not supported: meshes are shown where their nodes are");
    }

    AccessorReader accessors(document, problems);
    TextureReader textures(document, accessors, scene, problems);
    read_materials(document, textures, scene, problems);
    read_meshes(document, accessors, scene, problems);
    read_nodes(document, accessors, scene, problems);
}

}  // namespace etendue
