#include "world/plain_surface.h"

#include "world/gltf_surface.h"
#include "world/material_evaluation.h"
#include "world/world.h"

#include <cstddef>
#include <optional>
#include <variant>

namespace etendue {

namespace {

std::optional<PlainSurface> make_plain_surface(const WorldData& data, const Material& material) {
    if (material.emits || material.unlit || material.has_coat || material.needs_tangents() ||
        material.filling != kNone || !material.lights_camera())
        return std::nullopt;
    if (const Bsdf* constant = std::get_if<Bsdf>(&material.model)) {
        const auto* diffuse = std::get_if<Diffuse>(constant);
        if (diffuse == nullptr) return std::nullopt;
        return PlainSurface{.diffuse = constant, .albedo = diffuse->albedo};
    }
    const GltfModel& model = std::get<GltfModel>(material.model);
    const TextureSlot& base_color = model.base_color_texture;
    const TextureSlot& metallic_roughness = model.metallic_roughness_texture;
    GltfModel untextured = model;
    untextured.base_color_texture = untextured.metallic_roughness_texture = TextureSlot{};
    const bool coordinates_differ =
        base_color.valid() && metallic_roughness.valid() && base_color.texcoord != metallic_roughness.texcoord;
    if (untextured.is_textured() || coordinates_differ || model.glossiness) return std::nullopt;
    const Bsdf bsdf = evaluate_gltf_surface(data, untextured, SurfacePoint{}, 0.0f, false);
    const auto* lobe = std::get_if<MetallicRoughness>(&bsdf);
    if (lobe == nullptr || !lobe->is_plain()) return std::nullopt;
    PlainSurface surface{.glossy = *lobe};
    if (base_color.valid() || metallic_roughness.valid()) surface.textured = &model;
    surface.texcoord = (base_color.valid() ? base_color : metallic_roughness).texcoord;
    return surface;
}

}  // namespace

MetallicRoughness PlainSurface::lobe(const WorldData& data, const Rgb& base_color, const Rgb& texel) const {
    MetallicRoughness lobe = glossy;
    lobe.base = working_base_color(data, textured->base_color * base_color);
    set_metallic_roughness(*textured, texel, lobe);
    return lobe;
}

PlainSurfaces find_plain_surfaces(const WorldData& data) {
    PlainSurfaces surfaces;
    std::vector<bool> is_plain;
    for (const Material& material : data.materials) {
        const std::optional<PlainSurface> surface = make_plain_surface(data, material);
        is_plain.push_back(surface.has_value());
        surfaces.of_material.push_back(surface.value_or(PlainSurface{}));
    }
    surfaces.of_geometry.resize(data.geometries.size(), nullptr);
    for (const Instance& instance : data.instances) {
        if (!instance.baked || instance.motion != kNone) continue;
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
            const std::size_t index = instance.first_geometry + g;
            const Geometry& geometry = data.geometries[index];
            const PlainSurface& surface = surfaces.of_material[geometry.material];
            // Vertex colours tint what glTF's model says, and nothing else.
            if (is_plain[geometry.material] && geometry.motion.empty() && !geometry.shape &&
                (surface.diffuse != nullptr || geometry.colors.empty()))
                surfaces.of_geometry[index] = &surface;
        }
    }
    return surfaces;
}

}  // namespace etendue
