// Materials as they are evaluated: colours in the working space, textures resolved to indices.
#pragma once

#include "bsdf/bsdf.h"
#include "color/color_config.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "light/beam.h"
#include "scene/seen_as.h"

#include <cstdint>
#include <optional>
#include <variant>

namespace etendue {

/// A texture with its coordinates: uv' = (row0 · (u, v, 1), row1 · (u, v, 1)).
struct TextureSlot {
    std::int32_t texture = -1;
    int texcoord = 0;
    Vec3f row0{1.0f, 0.0f, 0.0f};
    Vec3f row1{0.0f, 1.0f, 0.0f};

    [[nodiscard]] bool valid() const { return texture >= 0; }
};

/// Holds what the extensions of glTF's material add. Factors and textures as in scene/material_desc.h.
struct GltfLayers {
    float diffuse_roughness = 0.0f;
    TextureSlot diffuse_roughness_texture;

    float diffuse_transmission = 0.0f;
    TextureSlot diffuse_transmission_texture;
    Rgb diffuse_transmission_color{1.0f};  ///< linear Rec.709
    TextureSlot diffuse_transmission_color_texture;

    float anisotropy = 0.0f;
    TextureSlot anisotropy_texture;

    float iridescence = 0.0f;
    TextureSlot iridescence_texture;
    float film_ior = 1.3f;
    float film_thickness_minimum_nm = 100.0f;
    float film_thickness_maximum_nm = 400.0f;
    TextureSlot film_thickness_texture;

    Rgb sheen_color;  ///< linear Rec.709
    TextureSlot sheen_color_texture;
    float sheen_roughness = 0.0f;
    TextureSlot sheen_roughness_texture;

    float clearcoat = 0.0f;
    TextureSlot clearcoat_texture;
    float clearcoat_roughness = 0.0f;
    TextureSlot clearcoat_roughness_texture;

    [[nodiscard]] bool is_textured() const {
        return diffuse_roughness_texture.valid() || diffuse_transmission_texture.valid() ||
               diffuse_transmission_color_texture.valid() || anisotropy_texture.valid() ||
               iridescence_texture.valid() || film_thickness_texture.valid() || sheen_color_texture.valid() ||
               sheen_roughness_texture.valid() || clearcoat_texture.valid() || clearcoat_roughness_texture.valid();
    }
};

/// Factors of glTF's metallic-roughness model whose textures are looked up at each hit.
struct GltfModel {
    Rgb base_color{1.0f};  ///< linear Rec.709, as are the textures; the product is converted
    TextureSlot base_color_texture;
    float metallic = 1.0f;
    float roughness = 1.0f;
    TextureSlot metallic_roughness_texture;
    float f0 = 0.04f;       ///< from the index of refraction
    float specular = 1.0f;  ///< KHR_materials_specular
    TextureSlot specular_texture;
    Rgb specular_color{1.0f};  ///< linear Rec.709
    TextureSlot specular_color_texture;
    std::optional<float> glossiness;  ///< KHR_materials_pbrSpecularGlossiness, as in scene/material_desc.h
    float transmission = 0.0f;
    TextureSlot transmission_texture;
    bool refracts = false;  ///< the surface of a closed body rather than a thin sheet
    float ior = 1.5f;       ///< against vacuum
    std::optional<GltfLayers> layers;

    [[nodiscard]] bool is_textured() const {
        return base_color_texture.valid() || metallic_roughness_texture.valid() || specular_texture.valid() ||
               specular_color_texture.valid() || transmission_texture.valid() || (layers && layers->is_textured());
    }
};

enum class AlphaTest { Opaque, Mask, Blend };

struct Material {
    /// Either a lobe that is the same everywhere, or the model to evaluate.
    std::variant<Bsdf, GltfModel> model;
    /// Holds what the model evaluates to with vacuum around it, if that is the same at every point; the World finds
    /// out.
    std::optional<Bsdf> uniform;

    Rgb emission;  ///< radiance in W/(m² sr): working space, or linear Rec.709 if there is a texture
    TextureSlot emission_texture;
    bool emits = false;
    bool emits_both_sides = false;
    Beam beam;  ///< beam of the emission

    /// Is false if what the camera sees straight or through clear surfaces goes on behind it.
    bool visible_to_camera = true;
    SeenAs seen_as = SeenAs::Surface;
    bool culls_back = false;  ///< the eye does not see it from behind, straight or by any way

    /// Returns whether light that leaves the surface straight for the camera arrives there.
    [[nodiscard]] bool lights_camera() const { return visible_to_camera && seen_as == SeenAs::Surface; }

    AlphaTest alpha_test = AlphaTest::Opaque;
    float alpha_cutoff = 0.5f;
    float alpha_factor = 1.0f;
    TextureSlot alpha_texture;

    /// Some of the light goes straight through, which rays that connect points follow: the surface is a pane, which is
    /// a thin sheet without roughness, or bounds a body whose index is that of vacuum.
    bool is_clear = false;

    bool is_specular = false;  ///< mirrors or refracts without roughness, somewhere at least
    bool unlit = false;        ///< shows its base colour to the eye and scatters nothing
    TextureSlot normal_texture;
    float normal_scale = 1.0f;

    bool has_coat = false;
    TextureSlot coat_normal_texture;
    float coat_normal_scale = 1.0f;

    bool is_anisotropic = false;
    TextureSlot anisotropy_texture;    ///< its direction
    float anisotropy_rotation = 0.0f;  ///< radians, from the tangent to the bitangent

    std::uint32_t filling = 0xffffffffu;  ///< index into the World's fillings if the surface is a body's, else kNone

    /// True if the surface's tangents mean something.
    [[nodiscard]] bool needs_tangents() const {
        return normal_texture.valid() || coat_normal_texture.valid() || is_anisotropic;
    }
    /// The texture whose coordinates tangents follow where the mesh has none of its own; null if nothing needs any.
    [[nodiscard]] const TextureSlot* tangent_texture() const {
        if (!needs_tangents()) return nullptr;
        return normal_texture.valid()        ? &normal_texture
               : coat_normal_texture.valid() ? &coat_normal_texture
                                             : &anisotropy_texture;
    }
};

}  // namespace etendue
