// Light from infinitely far away in every direction.
#pragma once

#include "light/environment_light.h"
#include "light/light_sample.h"
#include "world/world_data.h"

#include <cstdint>
#include <span>

namespace etendue {

/// Answers what light comes from the environment, and how densely samples of it pick directions.
class Environment {
  public:
    /// Looks at the environment of `data`, which has to stay where it is.
    explicit Environment(const WorldData& data) : data_(data) {}

    /// Returns the index of the environment among the lights, kNone if there is none.
    [[nodiscard]] std::uint32_t light() const { return data_.environment; }
    /// Returns the radiance that arrives against `direction`; black without an environment.
    [[nodiscard]] Rgb radiance(const Vec3f& direction) const;
    /// Fills `seen` with the radiance and the density of `sample_light` along as many `directions` at once; there has
    /// to be an environment.
    void look(std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen) const;

    /// Samples the environment, which there has to be, as `LightSampler::sample` does once it is chosen, as many times
    /// at once as there are `samples`; their densities are without the choice.
    void sample_light(std::span<const Vec2f> u, std::span<LightSample> samples) const;
    /// Returns the density with which `LightSampler::sample` picks `direction`, without the choice of the environment;
    /// zero where that is dimmer than its mean.
    [[nodiscard]] float pdf_solid_angle(const Vec3f& direction) const;

    /// Samples light that arrives at `point` from all of the environment, where nothing but light samples looks for it.
    /// `u` in [0, 1)².
    [[nodiscard]] LightSample sample_all(const Vec3f& point, Vec2f u) const;
    /// Returns the density with which `LightEmitter::sample` and `sample_all` pick `direction`, without the choice of
    /// the environment; zero only where the environment is black.
    [[nodiscard]] float emission_pdf_solid_angle(const Vec3f& direction) const;

  private:
    const WorldData& data_;
};

}  // namespace etendue
