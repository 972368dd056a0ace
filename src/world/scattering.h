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

#include <algorithm>
#include <cmath>
#include <variant>

namespace etendue {

class Scattering {
  public:
    /// `bsdf` must outlive it. `geometric_normal` and `frame.normal` on the front side. Lobes that do not tell sides
    /// apart are turned to face `wo`.
    Scattering(const Bsdf& bsdf, Frame frame, Vec3f geometric_normal, const Vec3f& wo)
        : bsdf_(&bsdf), frame_(frame), geometric_normal_(geometric_normal) {
        if (dot(wo, geometric_normal_) < 0.0f && !is_two_sided_interface(*bsdf_)) {
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
        BsdfValue value = evaluate_bsdf(*bsdf_, wo_local_, wi_local, mode);
        if (mode == TransportMode::Importance) value.f_cos *= adjoint_factor(wi, wi_local);
        return value;
    }

    struct TwoWayValue {
        Rgb f_cos;
        float pdf_solid_angle = 0.0f;          ///< of wi, given wo
        float reverse_pdf_solid_angle = 0.0f;  ///< of wo, given wi
    };
    /// `evaluate` and `reverse_pdf_solid_angle` in one; all zero where f is.
    [[nodiscard]] TwoWayValue evaluate_both_ways(const Vec3f& wi, TransportMode mode) const {
        const Vec3f wi_local = frame_.to_local(wi);
        if (!wo_agrees_ || !agrees(wi, wi_local)) return {};
        const BsdfValue value = evaluate_bsdf(*bsdf_, wo_local_, wi_local, mode);
        if (is_black(value.f_cos)) return {};
        return {mode == TransportMode::Importance ? value.f_cos * adjoint_factor(wi, wi_local) : value.f_cos,
                value.pdf_solid_angle, etendue::reverse_pdf_solid_angle(*bsdf_, wo_local_, wi_local)};
    }

    /// Share, [0, 1], of what `evaluate` says that is scattered as by a diffuse surface.
    [[nodiscard]] Rgb diffuse_share(const Vec3f& wi, TransportMode mode) const {
        return etendue::diffuse_share(*bsdf_, wo_local_, frame_.to_local(wi), mode);
    }
    /// True if `wi` lies on the other side of the surface than wo.
    [[nodiscard]] bool is_transmission(const Vec3f& wi) const { return wo_local_.z * frame_.to_local(wi).z < 0.0f; }

    /// wi of the result is in world space.
    [[nodiscard]] BsdfSample sample(float u_lobe, Vec2f u, TransportMode mode) const {
        if (!wo_agrees_) return {};
        BsdfSample sample = sample_bsdf(*bsdf_, wo_local_, u_lobe, u, mode);
        if (is_black(sample.weight)) return {};
        const Vec3f wi_local = sample.wi;
        sample.wi = frame_.to_world(wi_local);
        if (!agrees(sample.wi, wi_local)) return {};
        if (mode == TransportMode::Importance) sample.weight *= adjoint_factor(sample.wi, wi_local);
        return sample;
    }

    /// All deltas, as radiance; wi in world space.
    [[nodiscard]] DeltaList deltas() const {
        DeltaList placed;
        if (!wo_agrees_) return placed;
        for (BsdfSample delta : deltas_of(*bsdf_, wo_local_)) {
            const Vec3f wi_local = delta.wi;
            delta.wi = frame_.to_world(wi_local);
            if (agrees(delta.wi, wi_local)) placed.add(delta);
        }
        return placed;
    }

    /// Density, 1/sr, with which a walk that arrives from `wi` would go on to `wo`.
    [[nodiscard]] float reverse_pdf_solid_angle(const Vec3f& wi) const {
        const Vec3f wi_local = frame_.to_local(wi);
        if (!wo_agrees_ || !agrees(wi, wi_local)) return 0.0f;
        return etendue::reverse_pdf_solid_angle(*bsdf_, wo_local_, wi_local);
    }

    /// Of a delta `sample`: the density of the way back over that of this way. Both are probabilities times a delta in
    /// solid angle; refraction compresses solid angles by n² |cos|, which the two deltas see from either side.
    [[nodiscard]] float reverse_density_ratio(const BsdfSample& sample) const {
        if (!sample.is_transmission) return sample.reverse_choice_ratio;
        const float cos_i = std::abs(frame_.to_local(sample.wi).z);
        return sample.reverse_choice_ratio * std::abs(wo_local_.z) / (sample.eta * sample.eta * std::max(cos_i, 1e-6f));
    }

    /// False if nothing goes on towards `towards`, of any length; quick to ask.
    [[nodiscard]] bool may_scatter(const Vec3f& towards) const {
        return wo_agrees_ && (!only_reflects(*bsdf_) || dot(towards, geometric_normal_) > 0.0f);
    }

    /// The same surface for a walk that arrives from `w`. (Of thin sheets under a coat with a normal of its own,
    /// World::bsdf makes another lobe for the other side.)
    [[nodiscard]] Scattering seen_from(const Vec3f& w) const { return {*bsdf_, frame_, geometric_normal_, w}; }

    [[nodiscard]] bool has_non_delta() const { return etendue::has_non_delta(*bsdf_); }
    [[nodiscard]] const Vec3f& geometric_normal() const { return geometric_normal_; }
    [[nodiscard]] const Bsdf& bsdf() const { return *bsdf_; }
    [[nodiscard]] const Vec3f& wo() const { return wo_; }
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

    const Bsdf* bsdf_;
    Frame frame_;
    Vec3f geometric_normal_;
    Vec3f wo_{0.0f};
    Vec3f wo_local_{0.0f};
    bool wo_agrees_ = false;
};

}  // namespace etendue
