#include "scene/scene_desc.h"

#include <algorithm>

namespace etendue {

void apply_variant(SceneDesc& scene) {
    const auto chosen = std::ranges::find(scene.variants, scene.settings.variant);
    if (scene.settings.variant.empty() || chosen == scene.variants.end()) return;
    const auto index = static_cast<std::uint32_t>(chosen - scene.variants.begin());
    for (MeshDesc& mesh : scene.meshes) {
        for (PrimitiveDesc& primitive : mesh.primitives) {
            const auto entry = std::ranges::find(primitive.variants, index, &VariantMaterial::variant);
            if (entry != primitive.variants.end()) primitive.material = entry->material;
        }
    }
}

}  // namespace etendue
