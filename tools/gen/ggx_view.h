// A GGX surface seen from one direction: what the programs that tabulate its albedo average over.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "sampling/sobol.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace etendue {

class GgxView {
  public:
    /// From azimuth `phi`, radians, and `cos_theta` in [0, 1].
    GgxView(const Ggx& ggx, float phi, float cos_theta) : ggx_(ggx) {
        // Edge-on light is the limit from just above.
        const float mu = std::max(cos_theta, 1e-5f);
        const float sine = std::sqrt(1.0f - mu * mu);
        wo_ = {sine * std::cos(phi), sine * std::sin(phi), mu};
        masking_ = 1.0f + ggx.lambda(wo_);
    }

    [[nodiscard]] const Vec3f& wo() const { return wo_; }
    /// 1 + Lambda(wo)
    [[nodiscard]] float masking() const { return masking_; }
    /// The i-th of a well distributed set of visible normals on one side of the plane of incidence: where both scatter
    /// alike, half of them suffices.
    [[nodiscard]] Vec3f normal_of_one_side(std::uint32_t i) const {
        const Vec2f u = owen_sobol_2d(i, 1);
        return ggx_.sample_visible_normal(wo_, {0.5f * u.x, u.y});
    }
    /// The weight G2 / G1 of light that leaves along `wi`.
    [[nodiscard]] float weight(const Vec3f& wi) const { return masking_ / (masking_ + ggx_.lambda(wi)); }
    [[nodiscard]] float weight_reflected(const Vec3f& h) const {
        const Vec3f wi = h * (2.0f * dot(wo_, h)) - wo_;
        return wi.z > 0.0f ? weight(wi) : 0.0f;
    }
    /// Holds the share of light that leaves an interface, and the share if it reflects only where reflection is total.
    struct InterfaceWeights {
        float fresnel;
        float total_only;
    };
    /// Returns the shares of the light at the facet `h` that leave interfaces to an index `eta` times that on this
    /// side; `reflected` is `weight_reflected(h)`, which serves every index.
    [[nodiscard]] InterfaceWeights weights_of_interface(const Vec3f& h, float reflected, float eta) const {
        const float f = fresnel_dielectric(dot(wo_, h), eta);
        Vec3f wi;
        if (!refract(wo_, h, eta, wi)) return {f * reflected, reflected};
        const float refracted = wi.z < 0.0f ? weight(wi) : 0.0f;
        return {f * reflected + (1.0f - f) * refracted, refracted};
    }

  private:
    Ggx ggx_;
    Vec3f wo_{0.0f};
    float masking_;
};

}  // namespace etendue
