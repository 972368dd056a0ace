// The numbers and colours of a glTF material that render.json can correct, by name.
#pragma once

#include "scene/material_desc.h"
#include "scene/setting.h"

#include <span>
#include <string_view>
#include <variant>

namespace etendue {

/// Names one factor and says where a material holds it: a number or a colour, of which one is not null.
struct MaterialFactor {
    std::string_view name;  ///< as glTF or its extension has it, without the word factor
    NumberRange range;      ///< range of the number or of each channel
    float& (*number)(MaterialDesc& material) = nullptr;
    Rgb& (*color)(MaterialDesc& material) = nullptr;
    bool in_glossiness = true;  ///< KHR_materials_pbrSpecularGlossiness has it, too
};

/// Holds all factors.
[[nodiscard]] std::span<const MaterialFactor> material_factors();

/// Gives one factor a value; textures go on multiplying it.
struct FactorChange {
    const MaterialFactor* factor = nullptr;
    std::variant<float, Rgb> value;

    void apply(MaterialDesc& material) const;
};

/// Gives `material` this emission, of which `color`, linear Rec.709, may be above 1, in place of its own and its
/// texture.
void set_emission(const Rgb& color, float strength, MaterialDesc& material);

}  // namespace etendue
