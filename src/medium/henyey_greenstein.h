// The phase function of Henyey and Greenstein ("Diffuse Radiation in the Galaxy", Astrophysical Journal 93, 1941).
//
// Directions as everywhere: both point away from the point of scattering, so light goes straight on where they are
// opposite. Value and density are one and the same, 1/sr (pbrt, 4th edition, section 11.3.1).
#pragma once

#include "core/frame.h"
#include "core/vec.h"

#include <algorithm>
#include <cmath>

namespace etendue {

struct HenyeyGreenstein {
    float g = 0.0f;  ///< mean cosine of the deflection, (-1, 1): above 0 light goes on, below 0 it turns back

    /// Share of light per solid angle, 1/sr.
    [[nodiscard]] float pdf_solid_angle(const Vec3f& wo, const Vec3f& wi) const {
        // 1 + g² + 2 g wo·wi, written so that nothing cancels where |g| is near 1.
        const float off = g < 0.0f ? length_squared(wo - wi) : length_squared(wo + wi);
        const float denominator = std::max(1e-12f, (1.0f - std::abs(g)) * (1.0f - std::abs(g)) + std::abs(g) * off);
        return kInvPi * 0.25f * (1.0f - g * g) / (denominator * std::sqrt(denominator));
    }

    /// A direction with that density; `u` in [0, 1)².
    [[nodiscard]] Vec3f sample(const Vec3f& wo, Vec2f u) const {
        float cosine = 2.0f * u.x - 1.0f;  // of the deflection
        if (std::abs(g) > 1e-3f) {
            const float root = (1.0f - g * g) / (1.0f - g + 2.0f * g * u.x);
            cosine = std::clamp((1.0f + g * g - root * root) / (2.0f * g), -1.0f, 1.0f);
        }
        const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
        const float phi = 2.0f * kPi * u.y;
        return Frame::from_normal(-wo).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
    }
};

}  // namespace etendue
