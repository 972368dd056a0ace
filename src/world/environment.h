// Light that rays meet infinitely far away: the environment, which is there in every direction, and suns.
#pragma once

#include "light/environment_light.h"
#include "light/light_sample.h"
#include "world/world_data.h"

#include <cstdint>
#include <span>

namespace etendue {

/// Answers what light rays meet that leave the scene, and how densely samples of it pick directions.
class Environment {
  public:
    /// Looks at the environment of `data`, which has to stay where it is.
    explicit Environment(const WorldData& data) : data_(data) {}

    /// Returns the index of the environment among the lights, kNone if there is none.
    [[nodiscard]] std::uint32_t light() const { return data_.environment; }
    /// Lists the lights that a ray meets that leaves the scene; if it is one of the camera's, there are no suns among
    /// them, nor an environment that is hidden from it.
    [[nodiscard]] std::span<const std::uint32_t> met(bool by_camera) const;
    /// Returns the radiance of the light of this index that arrives against `direction`; black of those that are not
    /// `met`.
    [[nodiscard]] Rgb radiance(std::uint32_t light, const Vec3f& direction) const;
    /// Fills `seen` with the radiance and the density of `sample_light` along as many `directions` at once; there has
    /// to be an environment.
    void look(std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen) const;

    /// Samples the environment, which there has to be, as `LightSampler::sample` does once it is chosen, as many times
    /// at once as there are `samples`; their densities are without the choice.
    void sample_light(std::span<const Vec2f> u, std::span<LightSample> samples) const;
    /// Returns the density with which `LightSampler::sample` picks `direction`, without the choice of the light; zero
    /// where an environment is dimmer than its mean, and beside a sun.
    [[nodiscard]] float pdf_solid_angle(std::uint32_t light, const Vec3f& direction) const;

    /// Samples light that arrives at `point` from all of the environment, where nothing but light samples looks for it.
    /// `u` in [0, 1)².
    [[nodiscard]] LightSample sample_all(const Vec3f& point, Vec2f u) const;
    /// Returns the density with which `LightEmitter::sample` and `sample_all` pick `direction`, without the choice of
    /// the light; zero only where the light is black.
    [[nodiscard]] float emission_pdf_solid_angle(std::uint32_t light, const Vec3f& direction) const;

  private:
    const WorldData& data_;
};

}  // namespace etendue
