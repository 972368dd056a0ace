#include "bsdf/ggx_anisotropic_albedo.h"

#include "bsdf/ggx_anisotropic_albedo_layout.h"

namespace etendue {

namespace {

using namespace ggx_anisotropic_layout;

// kSingle, kSchlickShare: Table<kReflection>; kSingleAverage, kSchlickAverage: Averages<kReflection>;
// kInterface, kInterfaceAverage: [side][eta] of those of kDielectric, side 0 outside (eta >= 1).
#include "bsdf/ggx_anisotropic_albedo_tables.inc"

struct Alphas {
    bool wide_x;
    float wide, narrow;

    Alphas(float alpha_x, float alpha_y)
        : wide_x(alpha_x >= alpha_y), wide(std::max(alpha_x, alpha_y)), narrow(std::min(alpha_x, alpha_y)) {}

    template <Sizes S>
    [[nodiscard]] Position position(const Vec3f& w) const {
        return ggx_anisotropic_layout::position<S>(wide, narrow, wide_x ? w.x : w.y, wide_x ? w.y : w.x, w.z);
    }
    template <Sizes S>
    [[nodiscard]] float average(const Averages<S>& averages) const {
        const Place n = place(std::sqrt(narrow) * (S.narrows - 1), S.narrows);
        return interpolate<S>(averages, n, place(strength_coordinate<S>(narrow, wide), S.strengths));
    }
};

/// Mixes what `at(side, node)` says of the two tabulated indices around `eta`.
template <typename At>
float between_etas(float eta, const At& at) {
    const bool outside = eta >= 1.0f;
    const Place e = place(eta_coordinate(outside ? eta : 1.0f / eta, kEtas), kEtas);
    const std::size_t side = outside ? 0 : 1;
    return mix(at(side, e.index), at(side, e.index + 1), e.t);
}

}  // namespace

GgxAlbedo ggx_anisotropic_albedo(const Vec3f& w, float alpha_x, float alpha_y) {
    const Position p = Alphas(alpha_x, alpha_y).position<kReflection>(w);
    const float single = interpolate<kReflection>(kSingle, p, p.cosine);
    return {single, single * interpolate<kReflection>(kSchlickShare, p, p.share_cosine)};
}

GgxAlbedo ggx_anisotropic_albedo_average(float alpha_x, float alpha_y) {
    const Alphas alphas(alpha_x, alpha_y);
    return {alphas.average<kReflection>(kSingleAverage), alphas.average<kReflection>(kSchlickAverage)};
}

float ggx_anisotropic_dielectric_albedo(const Vec3f& w, float alpha_x, float alpha_y, float eta) {
    const Position p = Alphas(alpha_x, alpha_y).position<kDielectric>(w);
    return between_etas(eta, [&](std::size_t side, std::size_t e) {
        return interpolate<kDielectric>(kInterface[side][e], p, p.cosine);
    });
}

float ggx_anisotropic_dielectric_albedo_average(float alpha_x, float alpha_y, float eta) {
    const Alphas alphas(alpha_x, alpha_y);
    return between_etas(
        eta, [&](std::size_t side, std::size_t e) { return alphas.average<kDielectric>(kInterfaceAverage[side][e]); });
}

}  // namespace etendue
