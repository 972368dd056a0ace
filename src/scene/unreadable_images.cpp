#include "scene/material_textures.h"
#include "scene/scene_desc.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace etendue {

namespace {

/// This reflectance stands in for a map of specular colour and glossiness: a factor of 1 would be a perfect mirror.
constexpr float kPlainReflectance = 0.04f;

}  // namespace

void leave_out_texture(TextureRef& ref, MaterialDesc& material) {
    if (&ref == &material.emissive_texture) material.emissive = Rgb(0.0f);
    if (&ref == &material.specular_color_texture && material.glossiness) {
        material.specular_color *= kPlainReflectance;
        material.glossiness = 0.0f;
    }
    ref = {};
}

void leave_out_unreadable_images(SceneDesc& scene) {
    const auto is_unreadable = [&](const TextureRef& ref) {
        const TextureDesc& texture = scene.textures[static_cast<std::size_t>(ref.texture.index)];
        return scene.images[static_cast<std::size_t>(texture.image.index)].unreadable;
    };
    for (MaterialDesc& material : scene.materials)
        for_each_texture(material, [&](TextureRef& ref, std::string_view) {
            if (ref.valid() && is_unreadable(ref)) leave_out_texture(ref, material);
        });
}

std::size_t count_missing_textures(const SceneDesc& scene) {
    return static_cast<std::size_t>(std::ranges::count(scene.images, true, &ImageDesc::unreadable));
}

}  // namespace etendue
