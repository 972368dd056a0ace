// The GGX (Trowbridge-Reitz) microfacet distribution.
//
// alpha is the slope's standard width, perceptual roughness squared, along x and along y. Heitz, "Understanding the
// Masking-Shadowing Function in Microfacet-Based BRDFs" (JCGT 3(2), 2014); sampling of visible normals: Dupuy and
// Benyoub, "Sampling Visible GGX Normals with Spherical Caps" (HPG 2023).
#pragma once

#include "core/trigonometry.h"
#include "core/vec.h"

namespace etendue {

/// Below this alpha a surface is treated as perfectly smooth: its lobe, narrower than a thousandth, is a delta.
inline constexpr float kSmoothAlpha = 1e-3f;

/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicGgx {
    using Vec = Imath::Vec3<T>;

    T alpha_x{0.1f};
    T alpha_y{0.1f};

    [[nodiscard]] static BasicGgx isotropic(T alpha) { return {alpha, alpha}; }
    [[nodiscard]] auto is_isotropic() const { return alpha_x == alpha_y; }

    /// Density of normals (Heitz, equation 85), 1/sr, `h` unit with h.z >= 0. Built from the sines, which keep their
    /// precision for small alpha.
    [[nodiscard]] T d(const Vec& h) const {
        const T x = h.x / alpha_x;
        const T y = h.y / alpha_y;
        const T t = x * x + y * y + h.z * h.z;
        return 1.0f / (kPi * alpha_x * alpha_y * t * t);
    }

    /// Smith's auxiliary function (Heitz, equations 72 and 86).
    [[nodiscard]] T lambda(const Vec& w) const {
        const T cos2 = w.z * w.z;
        const T x = alpha_x * w.x;
        const T y = alpha_y * w.y;
        return select(cos2 == T(0.0f), T(1e30f), 0.5f * (sqrt(1.0f + (x * x + y * y) / cos2) - 1.0f));
    }

    [[nodiscard]] T g1(const Vec& w) const { return 1.0f / (1.0f + lambda(w)); }

    /// Height-correlated masking and shadowing (Heitz, equation 99).
    [[nodiscard]] T g2(const Vec& wo, const Vec& wi) const { return 1.0f / (1.0f + lambda(wo) + lambda(wi)); }

    /// A normal visible from `wo` (wo.z > 0).
    [[nodiscard]] Vec sample_visible_normal(const Vec& wo, const Imath::Vec2<T>& u) const {
        const Vec stretched = normalize(Vec(wo.x * alpha_x, wo.y * alpha_y, wo.z));
        const BasicSinCos<T> phi = sin_cos_turns(u.x);
        const T z = (1.0f - u.y) * (1.0f + stretched.z) - stretched.z;
        const T sin_theta = sqrt(clamp(1.0f - z * z, T(0.0f), T(1.0f)));
        const Vec h = Vec(sin_theta * phi.cos, sin_theta * phi.sin, z) + stretched;
        return normalize(Vec(h.x * alpha_x, h.y * alpha_y, max(T(1e-7f), h.z)));
    }
};
using Ggx = BasicGgx<float>;

}  // namespace etendue
