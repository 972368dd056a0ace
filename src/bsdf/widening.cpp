#include "bsdf/widening.h"

#include "bsdf/ggx.h"

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
    if (const auto* lobe = std::get_if<SmoothConductor>(&bsdf)) return widened_conductor(lobe->fresnel, 0.0f, variance);
    if (const auto* lobe = std::get_if<RoughConductor>(&bsdf))
        return widened_conductor(lobe->fresnel, lobe->alpha, variance);
    if (const auto* lobe = std::get_if<SmoothDielectric>(&bsdf))
        return widened_dielectric(*lobe, {0.0f, 0.0f}, variance);
    if (const auto* lobe = std::get_if<RoughDielectric>(&bsdf))
        return widened_dielectric(*lobe, {lobe->alpha_x, lobe->alpha_y}, variance);
    return bsdf;
}

}  // namespace etendue
