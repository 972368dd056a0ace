// The GGX (Trowbridge-Reitz) microfacet distribution.
//
// alpha is the slope's standard width, perceptual roughness squared, along x and along y. Heitz, "Understanding the
// Masking-Shadowing Function in Microfacet-Based BRDFs" (JCGT 3(2), 2014); sampling of visible normals: Dupuy and
// Benyoub, "Sampling Visible GGX Normals with Spherical Caps" (HPG 2023).
#pragma once

#include "core/trigonometry.h"
#include "core/vec.h"

#include <algorithm>
#include <cmath>

namespace etendue {

/// Below this alpha a surface is treated as perfectly smooth: its lobe, narrower than a thousandth, is a delta.
inline constexpr float kSmoothAlpha = 1e-3f;

struct Ggx {
    float alpha_x = 0.1f;
    float alpha_y = 0.1f;

    [[nodiscard]] static Ggx isotropic(float alpha) { return {alpha, alpha}; }
    [[nodiscard]] bool is_isotropic() const { return alpha_x == alpha_y; }

    /// Density of normals (Heitz, equation 85), 1/sr, `h` unit with h.z >= 0. Built from the sines, which keep their
    /// precision for small alpha.
    [[nodiscard]] float d(const Vec3f& h) const {
        const float x = h.x / alpha_x;
        const float y = h.y / alpha_y;
        const float t = x * x + y * y + h.z * h.z;
        return 1.0f / (kPi * alpha_x * alpha_y * t * t);
    }

    /// Smith's auxiliary function (Heitz, equations 72 and 86).
    [[nodiscard]] float lambda(const Vec3f& w) const {
        const float cos2 = w.z * w.z;
        if (cos2 == 0.0f) return 1e30f;
        const float x = alpha_x * w.x;
        const float y = alpha_y * w.y;
        return 0.5f * (std::sqrt(1.0f + (x * x + y * y) / cos2) - 1.0f);
    }

    [[nodiscard]] float g1(const Vec3f& w) const { return 1.0f / (1.0f + lambda(w)); }

    /// Height-correlated masking and shadowing (Heitz, equation 99).
    [[nodiscard]] float g2(const Vec3f& wo, const Vec3f& wi) const { return 1.0f / (1.0f + lambda(wo) + lambda(wi)); }

    /// Density of the normals visible from `wo` (wo.z > 0), per solid angle of the normal (Heitz, equation 2).
    [[nodiscard]] float visible_normal_pdf(const Vec3f& wo, const Vec3f& h) const {
        return g1(wo) * d(h) * std::max(0.0f, dot(wo, h)) / wo.z;
    }

    /// A normal visible from `wo` (wo.z > 0).
    [[nodiscard]] Vec3f sample_visible_normal(const Vec3f& wo, Vec2f u) const {
        const Vec3f stretched = normalize({wo.x * alpha_x, wo.y * alpha_y, wo.z});
        const SinCos phi = sin_cos_turns(u.x);
        const float z = (1.0f - u.y) * (1.0f + stretched.z) - stretched.z;
        const float sin_theta = std::sqrt(std::clamp(1.0f - z * z, 0.0f, 1.0f));
        const Vec3f h = Vec3f(sin_theta * phi.cos, sin_theta * phi.sin, z) + stretched;
        return normalize({h.x * alpha_x, h.y * alpha_y, std::max(1e-7f, h.z)});
    }
};

}  // namespace etendue
