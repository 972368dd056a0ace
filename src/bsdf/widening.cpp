#include "bsdf/widening.h"

#include "bsdf/ggx.h"
#include "core/overloaded.h"

#include <variant>

namespace etendue {

namespace {

Bsdf widened_conductor(const FresnelMetal& fresnel, float alpha, Vec2f variance) {
    const float wide = widened_alpha(alpha, 0.5f * (variance.x + variance.y));
    if (wide < kSmoothAlpha) return SmoothConductor{fresnel};
    return RoughConductor{fresnel, wide};
}

template <typename Dielectric>
Bsdf widened_dielectric(const Dielectric& lobe, Vec2f alpha, Vec2f variance) {
    const Vec2f wide(widened_alpha(alpha.x, variance.x), widened_alpha(alpha.y, variance.y));
    return std::visit([](const auto& interface) { return Bsdf(interface); },
                      make_interface(lobe.ior, wide, lobe.tint, lobe.fresnel));
}

}  // namespace

Bsdf widened(const Bsdf& bsdf, Vec2f variance) {
    return std::visit(
        Overloaded{
            [&](const SmoothConductor& lobe) { return widened_conductor(lobe.fresnel, 0.0f, variance); },
            [&](const RoughConductor& lobe) { return widened_conductor(lobe.fresnel, lobe.alpha, variance); },
            [&](const SmoothDielectric& lobe) {
                return widened_dielectric(lobe, {0.0f, 0.0f}, variance);
            },
            [&](const RoughDielectric& lobe) {
                return widened_dielectric(lobe, {lobe.alpha_x, lobe.alpha_y}, variance);
            },
            // As wide as they can be, or widened where their material is evaluated.
            [](const ClearCoat& lobe) { return Bsdf(lobe); },
            [](const Diffuse& lobe) { return Bsdf(lobe); },
            [](const RoughDiffuse& lobe) { return Bsdf(lobe); },
            [](const MetallicRoughness& lobe) { return Bsdf(lobe); },
            [](const DielectricBody& lobe) { return Bsdf(lobe); },
            [](const LayeredSurface& lobe) { return Bsdf(lobe); },
        },
        bsdf);
}

}  // namespace etendue
