// glTF textures, samplers and images to TextureDesc and ImageDesc: those that a material or the environment uses, the
// others are not opened.
#pragma once

#include "loader/gltf/gltf_accessor.h"
#include "loader/gltf/gltf_document.h"
#include "scene/scene_desc.h"

#include <map>
#include <optional>
#include <vector>

namespace etendue {

class TextureReader {
  public:
    TextureReader(const GltfDocument& document, AccessorReader& accessors, SceneDesc& scene, ProblemList& problems);

    /// The texture with this glTF index, appended to the scene when first asked for. An invalid handle if it cannot be
    /// used; why has then been reported once.
    [[nodiscard]] Handle<TextureDesc> texture(int index);
    /// The image with this glTF index, the same way; it is an error if it cannot be read.
    [[nodiscard]] Handle<ImageDesc> required_image(std::size_t index);

  private:
    [[nodiscard]] Handle<ImageDesc> image(std::size_t index);
    /// Appends an image to the scene.
    [[nodiscard]] Handle<ImageDesc> add_image(ImageDesc image);
    [[nodiscard]] Handle<TextureDesc> read_texture(std::size_t index);
    [[nodiscard]] std::optional<ImageDesc> read_image(std::size_t index);
    [[nodiscard]] bool take_pixels(const GltfImage& source, ImageDesc& image);

    const GltfDocument& document_;
    AccessorReader& accessors_;
    SceneDesc& scene_;
    ProblemList& problems_;
    std::map<std::size_t, Handle<TextureDesc>> textures_;  ///< by glTF index
    std::map<std::size_t, Handle<ImageDesc>> images_;
};

}  // namespace etendue
