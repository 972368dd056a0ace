#include "bsdf/sheen.h"

#include "bsdf/albedo_tables.h"
#include "bsdf/charlie.h"
#include "sampling/warp.h"

#include <algorithm>

namespace etendue {

namespace {

using namespace sheen_albedo_layout;

constexpr const Tables& kTables = etendue_sheen_albedo;

float bounded_alpha(float alpha) {
    return std::max(alpha, kSmallestSheenAlpha);
}

}  // namespace

BsdfValue Sheen::evaluate(const Vec3f& wo, const Vec3f& wi) const {
    const float a = bounded_alpha(alpha);
    const auto row = alpha_place(a);
    const float albedo_o = interpolate(kTables.unbounded, row, cosine_place(wo.z));
    const float albedo_i = interpolate(kTables.unbounded, row, cosine_place(wi.z));
    const float scale = 1.0f / std::max({1.0f, albedo_o, albedo_i});
    return {color * (Charlie{a}.f_cos(wo, wi) * scale), 0.5f * kInvPi};
}

Vec3f Sheen::sample(Vec2f u) {
    return square_to_hemisphere(u);
}

float Sheen::passed(float cos_theta) const {
    if (!exists()) return 1.0f;
    const float albedo =
        interpolate(kTables.bounded, alpha_place(bounded_alpha(alpha)), cosine_place(std::abs(cos_theta)));
    return std::max(0.0f, 1.0f - max_component(color) * albedo);
}

}  // namespace etendue
