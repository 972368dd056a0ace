#include "bsdf/gloss.h"

#include <algorithm>

namespace etendue {

Gloss gloss_of(const MetallicRoughness& lobe, float cos_o) {
    const float f0 = lobe.metallic * average(lobe.base) + (1.0f - lobe.metallic) * average(lobe.f0);
    const float f90 = lobe.metallic + (1.0f - lobe.metallic) * lobe.f90;
    const float grazing = 1.0f - std::clamp(cos_o, 0.0f, 1.0f);
    const float squared = grazing * grazing;
    const float specular = f0 + (f90 - f0) * squared * squared * grazing;
    const float diffuse = (1.0f - lobe.metallic) * average(lobe.base) * (1.0f - specular);
    const float alpha = std::max(lobe.alpha_x, lobe.alpha_y);
    // Smooth ones are deltas, for which no light is sampled.
    if (!(specular > 0.0f) || alpha < kSmoothAlpha) return {};
    return {(1.0f - alpha) * specular / (specular + diffuse), alpha};
}

Gloss gloss_of(const Bsdf& bsdf, float cos_o) {
    if (const auto* lobe = std::get_if<MetallicRoughness>(&bsdf)) return gloss_of(*lobe, cos_o);
    if (const auto* metal = std::get_if<RoughConductor>(&bsdf)) return {1.0f - metal->alpha, metal->alpha};
    return {};
}

}  // namespace etendue
