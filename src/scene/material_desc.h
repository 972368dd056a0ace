// A surface's material: glTF 2.0 metallic-roughness with its extensions, or one of the models beyond glTF that
// render.json can put in its place.
#pragma once

#include "core/error.h"
#include "core/rgb.h"
#include "scene/seen_as.h"
#include "scene/texture_desc.h"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace etendue {

enum class AlphaMode { Opaque, Mask, Blend };

/// The metals whose measured complex index of refraction is known.
inline constexpr std::array<std::string_view, 8> kMetalNames{"Ag", "Al", "Au", "Cr", "Cu", "Fe", "Ti", "W"};

/// Is the most that Henyey and Greenstein's g may be, without its sign: beyond, light that is scattered is not told
/// apart from light that is not.
inline constexpr float kMostAnisotropic = 0.999f;

/// A metal, by its measured complex index of refraction.
struct ConductorDesc {
    std::string metal;       ///< one of kMetalNames; empty for a lossless mirror
    float roughness = 0.0f;  ///< perceptual roughness in [0, 1], alpha = roughness²; 0 is a perfect mirror (delta)
};

/// Describes the medium that fills a closed body: KHR_materials_volume, _dispersion and _volume_scatter.
struct VolumeDesc {
    bool closed = false;          ///< false: the surface is a thin wall around nothing
    Rgb attenuation_color{1.0f};  ///< linear Rec.709, [0, 1]: what is left of white after `attenuation_distance`
    float attenuation_distance = std::numeric_limits<float>::infinity();  ///< metres, > 0
    float dispersion = 0.0f;                                              ///< 20 over the Abbe number, >= 0
    Rgb multiscatter_color{0.0f};     ///< linear Rec.709, [0, 1]: the body's colour by many scatterings; black is none
    float scatter_anisotropy = 0.0f;  ///< Henyey and Greenstein's g, up to kMostAnisotropic to either side
    /// Where bodies overlap, the one with the higher priority fills the space; among equals, the smaller one.
    int priority = 0;
};

/// Describes a closed dielectric body whose surface reflects and refracts; the base colour tints transmitted light.
struct DielectricDesc {
    float ior = 1.5f;        ///< against vacuum, in [1, 3]
    float roughness = 0.0f;  ///< perceptual roughness in [0, 1], alpha = roughness²; 0 is perfectly smooth (delta)
    VolumeDesc volume{.closed = true};
};

/// A diffuse reflector with a constant albedo.
struct DiffuseDesc {
    Rgb albedo{0.5f};        ///< linear Rec.709, each channel in [0, 1]
    float roughness = 0.0f;  ///< roughness of the facets, [0, 1]; 0 is Lambert's surface
};

/// A closed translucent body in which light walks at random: skin, wax, milk, marble.
struct SubsurfaceDesc {
    Rgb albedo{0.8f};                    ///< colour that a large body reflects, linear Rec.709, [0, 1]
    Rgb radius{0.01f, 0.005f, 0.0025f};  ///< mean free path per channel of the working space, metres, > 0
    float anisotropy = 0.0f;             ///< Henyey and Greenstein's g, up to kMostAnisotropic to either side
    float ior = 1.4f;                    ///< index of the reflecting surface, [1, 3]
    float roughness = 0.5f;              ///< roughness of the reflecting surface, [0, 1]
    int priority = 0;                    ///< as of VolumeDesc
};

/// KHR_materials_clearcoat.
struct ClearcoatDesc {
    float factor = 0.0f;           ///< [0, 1]
    TextureRef texture;            ///< data: R
    float roughness = 0.0f;        ///< [0, 1]
    TextureRef roughness_texture;  ///< data: G
    TextureRef normal_texture;     ///< data: tangent-space normal
    float normal_scale = 1.0f;
};

/// KHR_materials_sheen.
struct SheenDesc {
    Rgb color{0.0f};               ///< linear Rec.709, [0, 1]; black is no sheen
    TextureRef color_texture;      ///< sRGB
    float roughness = 0.0f;        ///< [0, 1]
    TextureRef roughness_texture;  ///< data: A
};

/// KHR_materials_iridescence.
struct IridescenceDesc {
    float factor = 0.0f;                  ///< [0, 1]
    TextureRef texture;                   ///< data: R
    float ior = 1.3f;                     ///< index of the film, >= 1
    float thickness_minimum_nm = 100.0f;  ///< nanometres, where the texture is 0
    float thickness_maximum_nm = 400.0f;  ///< nanometres, where it is 1 or there is none
    TextureRef thickness_texture;         ///< data: G
};

/// KHR_materials_anisotropy.
struct AnisotropyDesc {
    float strength = 0.0f;  ///< [0, 1]
    float rotation = 0.0f;  ///< radians, counter-clockwise from the tangent
    TextureRef texture;     ///< data: direction in RG, strength in B
};

/// KHR_materials_diffuse_transmission.
struct DiffuseTransmissionDesc {
    float factor = 0.0f;       ///< [0, 1]
    TextureRef texture;        ///< data: A
    Rgb color{1.0f};           ///< linear Rec.709, [0, 1]
    TextureRef color_texture;  ///< sRGB
};

/// KHR_materials_diffuse_roughness.
struct DiffuseRoughnessDesc {
    float factor = 0.0f;  ///< [0, 1]
    TextureRef texture;   ///< data: R
};

/// Holds the model that render.json puts in the place of glTF's; empty to keep glTF's model.
using MaterialModelDesc = std::variant<std::monostate, ConductorDesc, DielectricDesc, DiffuseDesc, SubsurfaceDesc>;

/// How emission depends on the angle to the normal (light/beam.h).
struct BeamDesc {
    enum class Kind { Diffuse, Panel, Spot };

    Kind kind = Kind::Diffuse;
    float spread = 3.14159265f;     ///< panel: radians, full angle of the cone that light leaves into, (0, pi]
    float inner_cone_angle = 0.0f;  ///< spot: as in LightDesc
    float outer_cone_angle = 0.785398163f;
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
    /// Holds KHR_materials_emissive_strength, >= 0; radiance = emissive · strength, W/(m² sr).
    float emissive_strength = 1.0f;
    TextureRef emissive_texture;  ///< sRGB
    BeamDesc beam;                ///< beam that one-sided materials shine in
    bool visible_to_camera = true;
    SeenAs seen_as = SeenAs::Surface;

    /// Returns whether the surface lights others.
    [[nodiscard]] bool emits() const { return !unlit && emissive_strength > 0.0f && !is_black(emissive); }

    AlphaMode alpha_mode = AlphaMode::Opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    bool unlit = false;  ///< KHR_materials_unlit: base colour is shown as it is and does not light anything

    float ior = 1.5f;                   ///< KHR_materials_ior: 0 (full reflection) or >= 1
    float specular = 1.0f;              ///< KHR_materials_specular: strength of the dielectric's reflection, [0, 1]
    TextureRef specular_texture;        ///< data: A
    Rgb specular_color{1.0f};           ///< KHR_materials_specular: linear Rec.709, >= 0; its tint at normal incidence
    TextureRef specular_color_texture;  ///< sRGB; glossiness in A
    /// KHR_materials_pbrSpecularGlossiness, [0, 1]: with an ior of 0 and no metal, the specular colour is the
    /// reflectance at normal incidence and dims the base colour, and roughness is 1 less glossiness.
    std::optional<float> glossiness;
    float transmission = 0.0f;        ///< KHR_materials_transmission, [0, 1]
    TextureRef transmission_texture;  ///< data: R
    DiffuseTransmissionDesc diffuse_transmission;
    DiffuseRoughnessDesc diffuse_roughness;
    VolumeDesc volume;
    AnisotropyDesc anisotropy;
    IridescenceDesc iridescence;
    SheenDesc sheen;
    ClearcoatDesc clearcoat;

    /// Set by render.json; replaces everything above but normal, emission, alpha, double_sided, and the base colour of
    /// dielectrics.
    MaterialModelDesc override_model;

    SourceLocation location;
};

}  // namespace etendue
