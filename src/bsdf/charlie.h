// The "Charlie" microfacet model of fibres that stand up from a cloth.
//
// Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF" (SIGGRAPH 2017 course notes): distribution of equation
// 2, masking fitted by equation 3 with table 1. KHR_materials_sheen names the same formulas.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <cmath>

namespace etendue {

struct Charlie {
    float alpha = 0.5f;  ///< sheen roughness², (0, 1]

    /// Density of fibres' normals with cosine `cos_half`, 1/sr.
    [[nodiscard]] float d(float cos_half) const {
        const float sin2 = std::max(0.0f, 1.0f - cos_half * cos_half);
        return (2.0f + 1.0f / alpha) * std::pow(sin2, 0.5f / alpha) * (0.5f * kInvPi);
    }

    /// Smith's auxiliary function.
    [[nodiscard]] float lambda(float cos_theta) const {
        return cos_theta < 0.5f ? std::exp(fit(cos_theta))
                                : std::exp(2.0f * fit(0.5f) - fit(std::max(0.0f, 1.0f - cos_theta)));
    }

    /// Reflected radiance per irradiance times cos_i, 1/sr: D G / (4 cos_o), for unit directions with z > 0.
    [[nodiscard]] float f_cos(const Vec3f& wo, const Vec3f& wi) const {
        const float cos_half = normalize(wo + wi).z;
        return d(cos_half) / ((1.0f + lambda(wo.z) + lambda(wi.z)) * 4.0f * wo.z);
    }

  private:
    [[nodiscard]] float fit(float x) const {
        const float t = (1.0f - alpha) * (1.0f - alpha);
        const auto between = [t](float rough, float smooth) { return rough + (smooth - rough) * t; };
        return between(21.5473f, 25.3245f) /
                   (1.0f + between(3.82987f, 3.32435f) * std::pow(x, between(0.19823f, 0.16801f))) +
               between(-1.97760f, -1.27393f) * x + between(-4.32054f, -4.85967f);
    }
};

}  // namespace etendue
