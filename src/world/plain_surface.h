// Surfaces simple enough to be set up and shaded many at a time.
#pragma once

#include "bsdf/metallic_roughness.h"
#include "world/material.h"

#include <vector>

namespace etendue {

struct WorldData;

/// Describes what most surfaces are: triangles, placed once or copied, and still. They do not emit light, bound no
/// body, and have no relief. They are diffuse, or plain metallic-roughness (MetallicRoughness::is_plain) without vertex
/// colours; the latter's base colour, metalness and roughness may come from textures that share a set of coordinates.
struct PlainSurface {
    const Bsdf* diffuse = nullptr;        ///< its Diffuse lobe, or null
    Rgb albedo{};                         ///< albedo of the Diffuse lobe
    MetallicRoughness glossy{};           ///< if it is not diffuse: its lobe, but for what textures change
    const GltfModel* textured = nullptr;  ///< the model whose textures change the lobe, or null
    int texcoord = 0;                     ///< the set of coordinates that these textures share

    /// Returns the lobe of a surface that is neither diffuse nor textured, else null.
    [[nodiscard]] const MetallicRoughness* untextured_lobe() const {
        return diffuse == nullptr && textured == nullptr ? &glossy : nullptr;
    }
    /// The lobe where the textures of the base colour and of metalness and roughness have these texels, linear Rec.709;
    /// 1 where there is no texture. It need not be plain: textures may say that it mirrors.
    [[nodiscard]] MetallicRoughness lobe(const WorldData& data, const Rgb& base_color,
                                         const Rgb& metallic_roughness) const;
};

struct PlainSurfaces {
    std::vector<PlainSurface> of_material;         ///< one for each material, whether or not it is plain
    std::vector<const PlainSurface*> of_geometry;  ///< null where it is none
};

/// Uniform materials must have been evaluated.
[[nodiscard]] PlainSurfaces find_plain_surfaces(const WorldData& data);

}  // namespace etendue
