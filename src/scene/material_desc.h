// A surface's material: glTF 2.0 metallic-roughness with its extensions, or one of the models beyond glTF that
// render.json can put in its place.
#pragma once

#include "core/error.h"
#include "core/rgb.h"
#include "scene/texture_desc.h"

#include <array>
#include <string>
#include <string_view>
#include <variant>

namespace etendue {

enum class AlphaMode { Opaque, Mask, Blend };

/// The metals whose measured complex index of refraction is known.
inline constexpr std::array<std::string_view, 8> kMetalNames{"Ag", "Al", "Au", "Cr", "Cu", "Fe", "Ti", "W"};

/// A metal, by its measured complex index of refraction.
struct ConductorDesc {
    std::string metal;       ///< one of kMetalNames; empty for a lossless mirror
    float roughness = 0.0f;  ///< perceptual roughness in [0, 1], alpha = roughness²; 0 is a perfect mirror (delta)
};

/// A closed dielectric body whose surface reflects and refracts.
struct DielectricDesc {
    float ior = 1.5f;        ///< inside over outside, in (1, 3]
    float roughness = 0.0f;  ///< perceptual roughness in [0, 1], alpha = roughness²; 0 is perfectly smooth (delta)
};

/// A Lambertian reflector with a constant albedo.
struct DiffuseDesc {
    Rgb albedo{0.5f};  ///< linear Rec.709, each channel in [0, 1]
};

struct MaterialDesc {
    std::string name;

    Rgb base_color{1.0f};  ///< linear Rec.709, [0, 1]
    float base_alpha = 1.0f;
    TextureRef base_color_texture;  ///< sRGB; alpha in A
    float metallic = 1.0f;
    float roughness = 1.0f;
    TextureRef metallic_roughness_texture;  ///< data: roughness in G, metallic in B
    TextureRef normal_texture;              ///< data: tangent-space normal
    float normal_scale = 1.0f;

    Rgb emissive{0.0f};  ///< linear Rec.709, [0, 1]
    float emissive_strength =
        1.0f;  ///< KHR_materials_emissive_strength, >= 0; radiance = emissive · strength, W/(m² sr)
    TextureRef emissive_texture;  ///< sRGB

    AlphaMode alpha_mode = AlphaMode::Opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    bool unlit = false;  ///< KHR_materials_unlit: base colour is shown as it is and does not light anything

    float ior = 1.5f;                   ///< KHR_materials_ior: 0 (full reflection) or >= 1
    float specular = 1.0f;              ///< KHR_materials_specular: strength of the dielectric's reflection, [0, 1]
    TextureRef specular_texture;        ///< data: A
    Rgb specular_color{1.0f};           ///< KHR_materials_specular: linear Rec.709, >= 0; its tint at normal incidence
    TextureRef specular_color_texture;  ///< sRGB
    float transmission = 0.0f;          ///< KHR_materials_transmission, [0, 1], through a thin wall
    TextureRef transmission_texture;    ///< data: R

    /// Set by render.json; replaces everything above but normal, emission, alpha and double_sided.
    std::variant<std::monostate, ConductorDesc, DielectricDesc, DiffuseDesc> override_model;

    SourceLocation location;
};

}  // namespace etendue
