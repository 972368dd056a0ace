#include "loader/settings/material_factors.h"

#include <algorithm>
#include <array>

namespace etendue {

namespace {

constexpr NumberRange kZeroToOne{.min = 0.0, .max = 1.0};
constexpr NumberRange kAboveZero{.min = 0.0, .open_min = true};
constexpr NumberRange kLeastOne{.min = 1.0};
constexpr NumberRange kScatterAnisotropy{.min = -static_cast<double>(kMostAnisotropic),
                                         .max = static_cast<double>(kMostAnisotropic)};

constexpr std::array kFactors{
    MaterialFactor{
        .name = "base_color", .range = kZeroToOne, .color = [](MaterialDesc& m) -> Rgb& { return m.base_color; }},
    MaterialFactor{.name = "metallic",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.metallic; },
                   .in_glossiness = false},
    MaterialFactor{.name = "roughness",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.roughness; },
                   .in_glossiness = false},
    MaterialFactor{
        .name = "normal_scale", .range = {}, .number = [](MaterialDesc& m) -> float& { return m.normal_scale; }},
    MaterialFactor{
        .name = "emissive", .range = kZeroToOne, .color = [](MaterialDesc& m) -> Rgb& { return m.emissive; }},
    MaterialFactor{.name = "emissive_strength",
                   .range = kNotNegative,
                   .number = [](MaterialDesc& m) -> float& { return m.emissive_strength; }},
    MaterialFactor{.name = "alpha_cutoff",
                   .range = kNotNegative,
                   .number = [](MaterialDesc& m) -> float& { return m.alpha_cutoff; }},
    MaterialFactor{.name = "ior",
                   .range = kLeastOne,
                   .number = [](MaterialDesc& m) -> float& { return m.ior; },
                   .in_glossiness = false},
    MaterialFactor{.name = "specular",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.specular; },
                   .in_glossiness = false},
    MaterialFactor{.name = "specular_color",
                   .range = kNotNegative,
                   .color = [](MaterialDesc& m) -> Rgb& { return m.specular_color; }},
    MaterialFactor{.name = "transmission",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.transmission; }},
    MaterialFactor{.name = "diffuse_transmission",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.diffuse_transmission.factor; }},
    MaterialFactor{.name = "diffuse_transmission_color",
                   .range = kZeroToOne,
                   .color = [](MaterialDesc& m) -> Rgb& { return m.diffuse_transmission.color; }},
    MaterialFactor{.name = "diffuse_roughness",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.diffuse_roughness.factor; }},
    MaterialFactor{.name = "attenuation_color",
                   .range = kZeroToOne,
                   .color = [](MaterialDesc& m) -> Rgb& { return m.volume.attenuation_color; }},
    MaterialFactor{.name = "attenuation_distance",
                   .range = kAboveZero,
                   .number = [](MaterialDesc& m) -> float& { return m.volume.attenuation_distance; }},
    MaterialFactor{.name = "dispersion",
                   .range = kNotNegative,
                   .number = [](MaterialDesc& m) -> float& { return m.volume.dispersion; }},
    MaterialFactor{.name = "multiscatter_color",
                   .range = kZeroToOne,
                   .color = [](MaterialDesc& m) -> Rgb& { return m.volume.multiscatter_color; }},
    MaterialFactor{.name = "scatter_anisotropy",
                   .range = kScatterAnisotropy,
                   .number = [](MaterialDesc& m) -> float& { return m.volume.scatter_anisotropy; }},
    MaterialFactor{.name = "anisotropy_strength",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.anisotropy.strength; }},
    MaterialFactor{.name = "anisotropy_rotation",
                   .range = {},
                   .number = [](MaterialDesc& m) -> float& { return m.anisotropy.rotation; }},
    MaterialFactor{.name = "iridescence",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.iridescence.factor; }},
    MaterialFactor{.name = "iridescence_ior",
                   .range = kLeastOne,
                   .number = [](MaterialDesc& m) -> float& { return m.iridescence.ior; }},
    MaterialFactor{.name = "iridescence_thickness_minimum",
                   .range = kNotNegative,
                   .number = [](MaterialDesc& m) -> float& { return m.iridescence.thickness_minimum_nm; }},
    MaterialFactor{.name = "iridescence_thickness_maximum",
                   .range = kNotNegative,
                   .number = [](MaterialDesc& m) -> float& { return m.iridescence.thickness_maximum_nm; }},
    MaterialFactor{
        .name = "sheen_color", .range = kZeroToOne, .color = [](MaterialDesc& m) -> Rgb& { return m.sheen.color; }},
    MaterialFactor{.name = "sheen_roughness",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.sheen.roughness; }},
    MaterialFactor{.name = "clearcoat",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.clearcoat.factor; }},
    MaterialFactor{.name = "clearcoat_roughness",
                   .range = kZeroToOne,
                   .number = [](MaterialDesc& m) -> float& { return m.clearcoat.roughness; }},
};

}  // namespace

std::span<const MaterialFactor> material_factors() {
    return kFactors;
}

void FactorChange::apply(MaterialDesc& material) const {
    if (factor->number != nullptr)
        factor->number(material) = std::get<float>(value);
    else
        factor->color(material) = std::get<Rgb>(value);
}

void set_emission(const Rgb& color, float strength, MaterialDesc& material) {
    // Colours above 1 go into the strength, which has no upper bound.
    const float brightest = std::max(1.0f, max_component(color));
    material.emissive = color / brightest;
    material.emissive_strength = strength * brightest;
    material.emissive_texture = {};
}

}  // namespace etendue
