// A layer of fibres over a surface: velvet, dust, the fuzz of cloth.
//
// f = colour · D G / (4 mu_o mu_i) of the Charlie model (charlie.h), without a Fresnel term (KHR_materials_sheen). At
// grazing angles smooth cloth would reflect more than arrives: the value is divided by the larger of the model's two
// albedos where that is above one, which keeps it reciprocal. Samples are uniform over the hemisphere. All directions
// have z > 0. Example: red velvet, colour (0.6, 0.05, 0.05), roughness 0.5.
#pragma once

#include "bsdf/bsdf_sample.h"

namespace etendue {

struct Sheen {
    Rgb color;           ///< [0, 1]; black is no sheen
    float alpha = 0.0f;  ///< sheen roughness², [0, 1]

    [[nodiscard]] bool exists() const { return !is_black(color); }
    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi) const;
    [[nodiscard]] static Vec3f sample(Vec2f u);

    /// Returns the share of light that the fibres leave to the layer below, by the brightest channel: 1 - albedo, [0,
    /// 1].
    [[nodiscard]] float passed(float cos_theta) const;
};

}  // namespace etendue
