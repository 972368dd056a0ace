// Light that leaves lights: where light subpaths begin.
#pragma once

#include "core/ray.h"
#include "light/emission_sample.h"
#include "light/light.h"
#include "world/interior.h"
#include "world/world_data.h"

#include <cstddef>
#include <cstdint>

namespace etendue {

class Materials;
class Media;

/// Holds the beginning of a light subpath.
struct Emission {
    Ray ray;
    Rgb weight;  ///< radiance and cosine over the densities of origin, direction and choice
    EmissionSample sample;
    std::uint32_t light = kNone;
    float probability = 0;  ///< probability of choosing this light
};

/// Describes a ray that leaves a light, to ask how densely it is sampled.
struct EmittedRay {
    std::uint32_t light = kNone;
    std::uint32_t triangle = 0;  ///< triangle of a mesh light
    Vec3f point{0.0f};           ///< where it leaves the light; for one at infinity, any point of the ray
    Vec3f direction{0.0f};       ///< unit, away from the light
    float cos_light = 1.0f;      ///< between the direction and the normal of the light's front
    float time = 0.0f;           ///< when the ray leaves, from 0 at the shutter's opening to 1 at its closing
};

/// Holds the emission of a point of a lamp in one direction.
struct SurfaceEmission {
    Rgb radiance;         ///< W/(m² sr)
    float cosine = 0.0f;  ///< between the direction and the surface's normal, >= 0
};

/// Samples rays that leave lights, which it chooses by power, and tells how densely it does.
class LightEmitter {
  public:
    /// Makes the table of powers; all arguments have to stay where they are.
    LightEmitter(const WorldData& data, const Materials& materials, const Media& media);

    /// Samples a ray that leaves a light, chosen with `u_light` in [0, 1)²; the ray has the given time. If `aims`, a
    /// share of rays is aimed at mirrors and smooth glass (light/light_aim.h), as they lie around the light in the
    /// middle of the shutter.
    [[nodiscard]] Emission sample(Vec2f u_light, EmissionNumbers u, float time, bool aims) const;
    /// Evaluates the light that leaves the starting point of `emission` along `direction`, towards the camera; black
    /// without a surface, and where that is hidden from the camera.
    [[nodiscard]] SurfaceEmission surface_emission(const Emission& emission, const Vec3f& direction) const;
    /// Returns where a ray starts that leaves the point of `emission` along `direction`, clear of the surfaces in which
    /// its light lies.
    [[nodiscard]] Vec3f origin(const Emission& emission, const Vec3f& direction) const;
    /// Returns the bodies in which a ray starts that leaves the point of `emission` along `direction`.
    [[nodiscard]] Interior interior(const Emission& emission, const Vec3f& direction) const;

    /// Returns the probability with which `sample` chooses the light of this index.
    [[nodiscard]] float probability(std::uint32_t light) const { return choice_.probability(light); }
    /// Returns the density of the direction of `ray` for rays of `sample` from its point, 1/sr, or for a light at
    /// infinity, whose direction is given, that of where they pass, 1/m² across it.
    [[nodiscard]] float pdf(const EmittedRay& ray, bool aims) const;
    /// Returns the spheres that rays are aimed at; none unless `aims`.
    [[nodiscard]] const LightAim& aim(bool aims) const { return aims ? aim_ : no_aim_; }
    /// Returns the density per area, 1/m², without the choice, with which `sample` picks the point `on_light` of the
    /// mesh or the shape that is the light of this index, at `time`, in [0, 1].
    [[nodiscard]] float pdf_area(std::uint32_t light, const Vec3f& on_light, float time) const;

    /// Returns the table that chooses.
    [[nodiscard]] const AliasTable& choice() const { return choice_; }

  private:
    const WorldData& data_;
    const Materials& materials_;
    const Media& media_;
    AliasTable choice_;
    LightAim aim_;
    LightAim no_aim_;
};

}  // namespace etendue
