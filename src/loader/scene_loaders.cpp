// The formats. To add another, see CONTRIBUTING.md (A scene format).

#include "loader/gltf/gltf_loader.h"
#include "loader/loader.h"

#include <array>

namespace etendue {

std::span<const std::unique_ptr<const SceneLoader>> scene_loaders() {
    static const std::array<std::unique_ptr<const SceneLoader>, 1> loaders{
        std::make_unique<GltfLoader>(),
    };
    return loaders;
}

}  // namespace etendue
