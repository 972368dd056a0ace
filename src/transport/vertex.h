// The vertices of paths: where rays lead, and how light scatters there.
#pragma once

#include "bsdf/bsdf.h"
#include "core/ray_cone.h"
#include "light/light_receiver.h"
#include "transport/bodies.h"
#include "world/scattering.h"
#include "world/world.h"

#include <limits>
#include <optional>

namespace etendue {

/// Says where a ray of a path has led.
struct Vertex {
    enum class Kind {
        Environment,  ///< the ray leaves the scene
        Medium,       ///< light scatters within a body
        Surface,      ///< light scatters on a surface
        Boundary,     ///< the ray goes straight on through the boundary of a body, which another body hides
        Unlit,        ///< a surface shows its colour to the eye and scatters no light
    };

    Kind kind = Kind::Environment;
    Vec3f wo{0.0f};                                           ///< unit, back along the ray
    Vec3f position{0.0f};                                     ///< metres; not meaningful in the environment
    float distance = std::numeric_limits<float>::infinity();  ///< metres that the ray has gone
    RayCone cone;                                             ///< the ray's, from the vertex on
    Interior interior;                                        ///< the bodies that the ray was in when it arrived

    const HomogeneousMedium* medium = nullptr;  ///< in which light scatters; null on surfaces

    // The rest is of surfaces.
    Hit hit;
    SurfacePoint surface;
    std::optional<Crossing> crossing;  ///< where the surface bounds a body
    Wavelength wavelength{};           ///< with which a path goes on, and its weight
    bool chooses_wavelength = false;   ///< the path takes one here, since the body disperses light
    Bsdf bsdf;

    /// Returns how the surface scatters; the vertex must outlive it.
    [[nodiscard]] Scattering scattering() const {
        Scattering placed(bsdf, surface.shading, surface.geometric_normal, wo);
        if (surface.material->culls_back) placed.hide_back(surface.geometric_normal);
        return placed;
    }

    /// Returns whether light scatters here in a dense medium, within which nothing is connected.
    [[nodiscard]] bool is_in_dense() const { return medium != nullptr && medium->is_dense; }
    /// Returns whether light that leaves the vertex straight for the camera arrives there.
    [[nodiscard]] bool lights_camera() const {
        return surface.material == nullptr || surface.material->lights_camera();
    }
    /// True if the vertex scatters light into directions that a light sample may have.
    [[nodiscard]] bool has_non_delta() const;
    /// Returns the share of light from `wi` that leaves along `wo`: the BSDF times the cosine, or the phase function;
    /// and the density with which `sample` finds `wi`.
    [[nodiscard]] BsdfValue evaluate(const Vec3f& wi, TransportMode mode = TransportMode::Radiance) const;
    /// Returns `evaluate` with the density of coming back, from `wi` to `wo`.
    [[nodiscard]] Scattering::TwoWayValue evaluate_both_ways(const Vec3f& wi, TransportMode mode) const;
    /// Returns the density, 1/sr, with which a path from the other end that comes from `wi` goes on to `wo`.
    [[nodiscard]] float reverse_pdf(const Vec3f& wi, TransportMode mode) const;
    /// Returns the cosine between `w` and the geometric normal; 1 in a medium.
    [[nodiscard]] float cosine(const Vec3f& w) const;
    /// Samples a direction with `u_lobe` in [0, 1) and `u` in [0, 1)².
    [[nodiscard]] BsdfSample sample(float u_lobe, Vec2f u, TransportMode mode = TransportMode::Radiance) const;
    /// Samples a direction for radiance: on surfaces, as `Scattering::sample_evenly` does.
    [[nodiscard]] BsdfSample sample_evenly(float u_lobe, Vec2f u) const;
    /// Returns where a ray along `wi` starts, clear of the surface.
    [[nodiscard]] Vec3f origin_towards(const Vec3f& wi) const;
    /// Returns the bodies that a ray along `wi` starts in.
    [[nodiscard]] const Interior& interior_towards(const Vec3f& wi) const;
    /// Returns what a light is chosen for here.
    [[nodiscard]] LightReceiver receiver() const;
};

/// Returns what a light is chosen for at a surface at `position`.
[[nodiscard]] LightReceiver light_receiver(const Vec3f& position, const Scattering& scattering);

/// Returns the vertex of a ray that leaves the scene along `direction`.
[[nodiscard]] inline Vertex environment_vertex(const Vec3f& direction) {
    Vertex vertex;
    vertex.wo = -direction;
    return vertex;
}

/// Returns where the medium that `arriving` is in scatters it before it hits anything; nothing if it gets through.
/// Multiplies `throughput` by the transmittance, times the scattering coefficient where it scatters, over the density.
/// `u` in [0, 1)² draws how far it gets.
[[nodiscard]] std::optional<Vertex> medium_vertex(const World& world, const ArrivingRay& arriving, Rgb& throughput,
                                                  Vec2f u);

/// Returns the surface that `arriving` has hit. The path has taken the wavelength `nanometres`, 0 for all; if the
/// surface has it take one, `u_wavelength` in [0, 1) says which.
[[nodiscard]] Vertex surface_vertex(const World& world, const ArrivingRay& arriving, float nanometres,
                                    float u_wavelength);

}  // namespace etendue
