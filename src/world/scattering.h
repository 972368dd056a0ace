// A BSDF placed on a surface: world directions in and out, and the two rules for shading normals that all integrators
// share.
//
// Leaks: a direction that lies on different sides of the shading and of the geometric normal scatters nothing,
// whichever end of the walk it is (Veach 1997, section 5.3.3, for why both must agree).
//
// Adjoint: walks that carry importance have the factor |wo·n_s| |wi·n_g| / (|wo·n_g| |wi·n_s|), where wo is the side
// that the light comes from and wi the one that was sampled (Veach 1997, equation 5.19). `evaluate` and `sample` both
// include it.
#pragma once

#include "bsdf/bsdf.h"
#include "core/frame.h"

#include <variant>

namespace etendue {

class Scattering {
  public:
    /// `geometric_normal` and `frame.normal` on the front side. Lobes that do not tell sides apart are turned to face
    /// `wo`.
    Scattering(const Bsdf& bsdf, Frame frame, Vec3f geometric_normal, const Vec3f& wo)
        : bsdf_(bsdf), frame_(frame), geometric_normal_(geometric_normal) {
        if (dot(wo, geometric_normal_) < 0.0f && !is_two_sided_interface(bsdf_)) {
            geometric_normal_ = -geometric_normal_;
            frame_.normal = -frame_.normal;
            frame_.tangent = -frame_.tangent;  // keeps the frame right-handed
        }
        wo_ = wo;
        wo_local_ = frame_.to_local(wo);
        wo_agrees_ = dot(wo, geometric_normal_) * wo_local_.z > 0.0f;
    }

    /// f |cos theta_i| with the density of `sample`; zero where the leak rule says so.
    [[nodiscard]] BsdfValue evaluate(const Vec3f& wi, TransportMode mode) const {
        const Vec3f wi_local = frame_.to_local(wi);
        if (!wo_agrees_ || !agrees(wi, wi_local)) return {};
        BsdfValue value = evaluate_bsdf(bsdf_, wo_local_, wi_local, mode);
        if (mode == TransportMode::Importance) value.f_cos *= adjoint_factor(wi, wi_local);
        return value;
    }

    /// wi of the result is in world space.
    [[nodiscard]] BsdfSample sample(float u_lobe, Vec2f u, TransportMode mode) const {
        if (!wo_agrees_) return {};
        BsdfSample sample = sample_bsdf(bsdf_, wo_local_, u_lobe, u, mode);
        if (is_black(sample.weight)) return {};
        const Vec3f wi_local = sample.wi;
        sample.wi = frame_.to_world(wi_local);
        if (!agrees(sample.wi, wi_local)) return {};
        if (mode == TransportMode::Importance) sample.weight *= adjoint_factor(sample.wi, wi_local);
        return sample;
    }

    [[nodiscard]] bool has_non_delta() const { return etendue::has_non_delta(bsdf_); }
    [[nodiscard]] const Vec3f& geometric_normal() const { return geometric_normal_; }
    [[nodiscard]] const Bsdf& bsdf() const { return bsdf_; }
    [[nodiscard]] const Vec3f& wo_local() const { return wo_local_; }

  private:
    [[nodiscard]] bool agrees(const Vec3f& w, const Vec3f& local) const {
        return dot(w, geometric_normal_) * local.z > 0.0f;
    }
    [[nodiscard]] float adjoint_factor(const Vec3f& wi, const Vec3f& wi_local) const {
        const float above = std::abs(wo_local_.z) * abs_dot(wi, geometric_normal_);
        const float below = abs_dot(wo_, geometric_normal_) * std::abs(wi_local.z);
        return below > 0.0f ? above / below : 0.0f;
    }

    const Bsdf& bsdf_;
    Frame frame_;
    Vec3f geometric_normal_;
    Vec3f wo_{0.0f};
    Vec3f wo_local_{0.0f};
    bool wo_agrees_ = false;
};

}  // namespace etendue
