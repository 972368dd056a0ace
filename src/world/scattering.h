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
#include "world/oriented_surface.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace etendue {

class Scattering {
  public:
    /// `bsdf` must outlive it. `geometric_normal` and `frame.normal` on the front side. Lobes that do not tell sides
    /// apart are turned to face `wo`.
    Scattering(const Bsdf& bsdf, const Frame& frame, const Vec3f& geometric_normal, const Vec3f& wo)
        : bsdf_(&bsdf), surface_(frame, geometric_normal, wo, !is_two_sided_interface(bsdf)) {}

    /// `surface` is what the constructor above would make of the same.
    Scattering(const Bsdf& bsdf, const OrientedSurface<float>& surface) : bsdf_(&bsdf), surface_(surface) {}

    /// f |cos theta_i| with the density of `sample`; zero where the leak rule says so.
    [[nodiscard]] BsdfValue evaluate(const Vec3f& wi, TransportMode mode) const {
        const Vec3f wi_local = surface_.frame.to_local(wi);
        if (!surface_.wo_agrees || !surface_.agrees(wi, wi_local)) return {};
        BsdfValue value = evaluate_bsdf(*bsdf_, surface_.wo_local, wi_local, mode);
        if (mode == TransportMode::Importance) value.f_cos *= surface_.adjoint_factor(wi, wi_local);
        return value;
    }

    struct TwoWayValue {
        Rgb f_cos;
        float pdf_solid_angle = 0.0f;          ///< of wi, given wo
        float reverse_pdf_solid_angle = 0.0f;  ///< of wo, given wi
    };
    /// `evaluate` and `reverse_pdf_solid_angle` in one; all zero where f is.
    [[nodiscard]] TwoWayValue evaluate_both_ways(const Vec3f& wi, TransportMode mode) const {
        const Vec3f wi_local = surface_.frame.to_local(wi);
        if (!surface_.wo_agrees || !surface_.agrees(wi, wi_local)) return {};
        const BsdfValue value = evaluate_bsdf(*bsdf_, surface_.wo_local, wi_local, mode);
        if (is_black(value.f_cos)) return {};
        return {mode == TransportMode::Importance ? value.f_cos * surface_.adjoint_factor(wi, wi_local) : value.f_cos,
                value.pdf_solid_angle, etendue::reverse_pdf_solid_angle(*bsdf_, surface_.wo_local, wi_local)};
    }

    /// Share, [0, 1], of what `evaluate` says that is scattered as by a diffuse surface.
    [[nodiscard]] Rgb diffuse_share(const Vec3f& wi, TransportMode mode) const {
        return etendue::diffuse_share(*bsdf_, surface_.wo_local, surface_.frame.to_local(wi), mode);
    }
    /// True if `wi` lies on the other side of the surface than wo.
    [[nodiscard]] bool is_transmission(const Vec3f& wi) const {
        return surface_.wo_local.z * surface_.frame.to_local(wi).z < 0.0f;
    }

    /// wi of the result is in world space.
    [[nodiscard]] BsdfSample sample(float u_lobe, Vec2f u, TransportMode mode) const {
        if (!surface_.wo_agrees) return {};
        BsdfSample sample = sample_bsdf(*bsdf_, surface_.wo_local, u_lobe, u, mode);
        if (is_black(sample.weight)) return {};
        const Vec3f wi_local = sample.wi;
        sample.wi = surface_.frame.to_world(wi_local);
        if (!surface_.agrees(sample.wi, wi_local)) return {};
        if (mode == TransportMode::Importance) sample.weight *= surface_.adjoint_factor(sample.wi, wi_local);
        return sample;
    }

    /// All deltas, as radiance; wi in world space.
    [[nodiscard]] DeltaList deltas() const {
        DeltaList placed;
        if (!surface_.wo_agrees) return placed;
        for (BsdfSample delta : deltas_of(*bsdf_, surface_.wo_local)) {
            const Vec3f wi_local = delta.wi;
            delta.wi = surface_.frame.to_world(wi_local);
            if (surface_.agrees(delta.wi, wi_local)) placed.add(delta);
        }
        return placed;
    }

    /// Density, 1/sr, with which a walk that arrives from `wi` would go on to `wo`.
    [[nodiscard]] float reverse_pdf_solid_angle(const Vec3f& wi) const {
        const Vec3f wi_local = surface_.frame.to_local(wi);
        if (!surface_.wo_agrees || !surface_.agrees(wi, wi_local)) return 0.0f;
        return etendue::reverse_pdf_solid_angle(*bsdf_, surface_.wo_local, wi_local);
    }

    /// Of a delta `sample`: the density of the way back over that of this way. Both are probabilities times a delta in
    /// solid angle; refraction compresses solid angles by n² |cos|, which the two deltas see from either side.
    [[nodiscard]] float reverse_density_ratio(const BsdfSample& sample) const {
        if (!sample.is_transmission) return sample.reverse_choice_ratio;
        const float cos_i = std::abs(surface_.frame.to_local(sample.wi).z);
        return sample.reverse_choice_ratio * std::abs(surface_.wo_local.z) /
               (sample.eta * sample.eta * std::max(cos_i, 1e-6f));
    }

    /// False if nothing goes on towards `towards`, of any length; quick to ask.
    [[nodiscard]] bool may_scatter(const Vec3f& towards) const {
        return surface_.wo_agrees && (!only_reflects(*bsdf_) || dot(towards, surface_.geometric_normal) > 0.0f);
    }

    /// The same surface for a walk that arrives from `w`. (Of thin sheets under a coat with a normal of its own,
    /// World::bsdf makes another lobe for the other side.)
    [[nodiscard]] Scattering seen_from(const Vec3f& w) const {
        return {*bsdf_, surface_.frame, surface_.geometric_normal, w};
    }

    [[nodiscard]] bool has_non_delta() const { return etendue::has_non_delta(*bsdf_); }
    /// Of shading; of lobes that do not tell sides apart it is on the side of wo.
    [[nodiscard]] const Vec3f& normal() const { return surface_.frame.normal; }
    [[nodiscard]] const Vec3f& geometric_normal() const { return surface_.geometric_normal; }
    [[nodiscard]] const Bsdf& bsdf() const { return *bsdf_; }
    [[nodiscard]] const Vec3f& wo() const { return surface_.wo; }
    [[nodiscard]] const Vec3f& wo_local() const { return surface_.wo_local; }

  private:
    const Bsdf* bsdf_;
    OrientedSurface<float> surface_;
};

}  // namespace etendue
