// A BSDF placed on a surface: world directions in and out, with the one model of shading normals that all integrators
// share (bsdf/leaning_normal.h).
//
// Walks from lights carry importance and have the factor |wo·n_s| |wi·n_g| / (|wo·n_g| |wi·n_s|), where wo is the side
// that the light comes from and wi the one that was sampled (Veach 1997, equation 5.19). `evaluate` and `sample` both
// include it.
#pragma once

#include "bsdf/bsdf.h"
#include "core/frame.h"
#include "world/oriented_surface.h"

#include <cmath>
#include <variant>

namespace etendue {

class Scattering {
  public:
    /// Places `bsdf`, which must outlive the Scattering, on a surface whose `geometric_normal` and `frame.normal` are
    /// on the front side. Lobes that do not tell sides apart are turned to face `wo`.
    Scattering(const Bsdf& bsdf, const Frame& frame, const Vec3f& geometric_normal, const Vec3f& wo)
        : Scattering(bsdf, OrientedSurface<float>(frame, geometric_normal, wo, !is_two_sided_interface(bsdf))) {}

    /// Places `bsdf` on a surface that is oriented as the other constructor would orient it.
    Scattering(const Bsdf& bsdf, const OrientedSurface<float>& surface)
        : bsdf_(&bsdf),
          surface_(surface),
          leans_(length_squared(surface.frame.normal - surface.geometric_normal) > kLeast) {}

    /// Has walks from lights leave on the side of `front` alone, a normal of the surface: no eye sees the other.
    void hide_back(const Vec3f& front) { hides_behind_ = dot(surface_.geometric_normal, front) > 0.0f ? 1.0f : -1.0f; }

    /// f |cos theta_i| with the density of `sample`.
    [[nodiscard]] BsdfValue evaluate(const Vec3f& wi, TransportMode mode) const;

    /// Evaluates with diffuse and other light apart, to whichever side light goes.
    [[nodiscard]] BsdfParts evaluate_parts(const Vec3f& wi, TransportMode mode) const;

    struct TwoWayValue {
        Rgb f_cos;
        float pdf_solid_angle = 0.0f;          ///< density of wi, given wo, 1/sr
        float reverse_pdf_solid_angle = 0.0f;  ///< density of wo, given wi, for a walk from the other end, 1/sr
    };
    /// `evaluate` and `reverse_pdf_solid_angle` in one; all zero where f is.
    [[nodiscard]] TwoWayValue evaluate_both_ways(const Vec3f& wi, TransportMode mode) const;

    /// Share, [0, 1], of what `evaluate` says that is scattered as by a diffuse surface.
    [[nodiscard]] Rgb diffuse_share(const Vec3f& wi, TransportMode mode) const;
    /// True if `wi` lies on the other side of the surface than wo.
    [[nodiscard]] bool is_transmission(const Vec3f& wi) const {
        return dot(surface_.wo, surface_.geometric_normal) * dot(wi, surface_.geometric_normal) < 0.0f;
    }

    /// wi of the result is in world space. The deltas of both walks are probabilities times a delta in solid angle;
    /// refraction compresses solid angles by n² |cos|, which the two see from either side: `reverse_ratio` has that.
    [[nodiscard]] BsdfSample sample(float u_lobe, Vec2f u, TransportMode mode) const;

    /// Samples the hemisphere on the side of wo uniformly, for radiance, if the surface only reflects and has no delta
    /// lobes. Otherwise it samples as `sample` does.
    [[nodiscard]] BsdfSample sample_evenly(float u_lobe, Vec2f u) const;

    /// All deltas, as radiance; wi in world space.
    [[nodiscard]] DeltaList deltas() const;

    /// Density, 1/sr, with which a walk from the other end that arrives from `wi` would go on to `wo`; `mode` is that
    /// of this walk.
    [[nodiscard]] float reverse_pdf_solid_angle(const Vec3f& wi, TransportMode mode) const;

    /// False if nothing goes on towards `towards`, of any length; quick to ask.
    [[nodiscard]] bool may_scatter(const Vec3f& towards) const {
        return !only_reflects(*bsdf_) || dot(towards, surface_.geometric_normal) > 0.0f;
    }

    /// Returns this surface for a walk that arrives from `w`. (Of thin sheets under a coat with a normal of its own,
    /// Materials::bsdf makes another lobe for the other side.)
    [[nodiscard]] Scattering seen_from(const Vec3f& w) const {
        return {*bsdf_, surface_.frame, surface_.geometric_normal, w};
    }

    [[nodiscard]] bool has_non_delta() const { return etendue::has_non_delta(*bsdf_); }
    /// Returns the shading normal; of lobes that do not tell sides apart it is on the side of wo.
    [[nodiscard]] const Vec3f& normal() const { return surface_.frame.normal; }
    [[nodiscard]] const Vec3f& geometric_normal() const { return surface_.geometric_normal; }
    [[nodiscard]] const Bsdf& bsdf() const { return *bsdf_; }
    [[nodiscard]] const Vec3f& wo() const { return surface_.wo; }
    /// Returns the direction from which a walk from the eye sees the lobe, in its frame.
    [[nodiscard]] Vec3f wo_local() const { return surface_.seen_from(); }

  private:
    /// A direction in the lobe's frame, and its cosine to the geometric normal, which tells its side.
    struct Placed {
        Vec3f w;
        float side;

        /// True if the lobe has it on that side.
        [[nodiscard]] bool agrees() const { return w.z * side > 0.0f; }
    };

    /// Squared distance of normals from which on they count as different.
    static constexpr float kLeast = 1e-12f;

    [[nodiscard]] Placed placed(const Vec3f& world) const {
        return {surface_.frame.to_local(world), dot(world, surface_.geometric_normal)};
    }
    /// Returns the lobe if its coat leans, null otherwise.
    [[nodiscard]] const LayeredSurface* under_leaning_coat() const {
        const auto* layered = std::get_if<LayeredSurface>(bsdf_);
        return layered != nullptr && layered->has_leaning_coat() ? layered : nullptr;
    }
    [[nodiscard]] Placed placed_wo() const { return {surface_.wo_local, dot(surface_.wo, surface_.geometric_normal)}; }
    [[nodiscard]] BsdfParts evaluate_placed(const Placed& wi, TransportMode mode) const;
    [[nodiscard]] BsdfParts evaluate_for_light(const Placed& wo, const Placed& wi) const;
    [[nodiscard]] float pdf_for_eye(const Placed& from, const Placed& to) const;
    [[nodiscard]] float pdf_for_light(const Placed& from, const Placed& to) const;
    [[nodiscard]] BsdfSample sample_both_sides(float u_lobe, Vec2f u, TransportMode mode) const;
    [[nodiscard]] BsdfSample sample_for_eye(float u_lobe, Vec2f u) const;
    [[nodiscard]] BsdfSample sample_for_light(float u_lobe, Vec2f u) const;
    /// True if a walk from a light finds no eye along `wi`.
    [[nodiscard]] bool has_no_eye_along(const Vec3f& wi, TransportMode mode) const {
        return hides_behind_ != 0.0f && mode == TransportMode::Importance &&
               !(dot(wi, surface_.geometric_normal) * hides_behind_ > 0.0f);
    }

    const Bsdf* bsdf_;
    OrientedSurface<float> surface_;
    bool leans_;                 ///< false if both normals are one
    float hides_behind_ = 0.0f;  ///< the front is where the geometric normal times this leads; 0 if both sides are seen
};

}  // namespace etendue
