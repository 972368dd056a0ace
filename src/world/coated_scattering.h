// A coat over a surface whose normal is another: two lobes, each with the model of leaning normals of its own
// (bsdf/leaning_normal.h).
//
// The coat reflects about its normal what either side of the horizon of the surface below it says. What it keeps is
// taken from the surface below as in LayeredSurface, by the cosines to the coat's normal.
#pragma once

#include "bsdf/layered_surface.h"
#include "world/scattering.h"

namespace etendue {

class CoatedScattering {
  public:
    /// Places `layered`, whose coat leans, on `surface`, the frame of the surface below the coat.
    CoatedScattering(const LayeredSurface& layered, const OrientedSurface<float>& surface);
    CoatedScattering(const CoatedScattering&) = delete;
    CoatedScattering& operator=(const CoatedScattering&) = delete;

    /// Evaluates f |cos theta_i| in its parts, with the density of `sample`.
    [[nodiscard]] BsdfParts evaluate_parts(const Vec3f& wi, TransportMode mode) const;
    /// Returns the density, 1/sr, with which a walk from the other end that arrives from `wi` goes on to wo; `mode` is
    /// that of this walk.
    [[nodiscard]] float reverse_pdf_solid_angle(const Vec3f& wi, TransportMode mode) const;
    /// Samples a direction, with the choices of both lobes as `Scattering::sample` has them.
    [[nodiscard]] BsdfSample sample(float u_lobe, Vec2f u, TransportMode mode) const;
    /// Returns all deltas, weighted as radiance.
    [[nodiscard]] DeltaList deltas() const;

  private:
    /// Returns the share of light along `w` that the coat leaves to the surface below.
    [[nodiscard]] float passed(const Vec3f& w) const { return layered_.coat.passed(std::abs(dot(w, coat_normal_))); }

    const LayeredSurface& layered_;
    Vec3f coat_normal_;
    Bsdf coat_lobe_;
    Bsdf lobe_below_;
    float passed_average_ = 1.0f;        ///< t_avg of the coat, for the diffuse part below
    float passed_average_plain_ = 1.0f;  ///< t_avg of the coat alone
    Scattering coat_;
    Scattering below_;
    float passed_o_;  ///< share of light along wo that the coat leaves; the chance of a sample of the surface below
};

}  // namespace etendue
