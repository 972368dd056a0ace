// All textures that a material can name.
#pragma once

#include "scene/material_desc.h"

#include <string_view>

namespace etendue {

/// Calls `visit(TextureRef&, std::string_view name)` for each slot of a MaterialDesc, also for those that are empty.
template <typename Material, typename Visit>
void for_each_texture(Material& m, const Visit& visit) {
    visit(m.base_color_texture, "base colour");
    visit(m.metallic_roughness_texture, "metallic-roughness");
    visit(m.normal_texture, "the normal map");
    visit(m.emissive_texture, "emission");
    visit(m.specular_texture, "specular");
    visit(m.specular_color_texture, "specular colour");
    visit(m.transmission_texture, "transmission");
    visit(m.clearcoat.texture, "clearcoat");
    visit(m.clearcoat.roughness_texture, "clearcoat roughness");
    visit(m.clearcoat.normal_texture, "the clearcoat's normal map");
    visit(m.sheen.color_texture, "sheen colour");
    visit(m.sheen.roughness_texture, "sheen roughness");
    visit(m.iridescence.texture, "iridescence");
    visit(m.iridescence.thickness_texture, "iridescence thickness");
    visit(m.anisotropy.texture, "anisotropy");
    visit(m.diffuse_roughness.texture, "diffuse roughness");
    visit(m.diffuse_transmission.texture, "diffuse transmission");
    visit(m.diffuse_transmission.color_texture, "diffuse transmission colour");
}

}  // namespace etendue
