// A point or spot light whose intensity follows a measured profile.
#pragma once

#include "core/frame.h"
#include "light/ies_profile.h"
#include "light/punctual_light.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>

namespace etendue {

/// Intensity is that of `lamp` times the profile's candela. Lamps of one kind share their profile.
struct ProfileLight {
    std::variant<PointLight, SpotLight> lamp;
    /// The lamp's own axes: it points along -normal, and the profile's horizontal angles begin at the tangent.
    Frame frame;
    std::shared_ptr<const IesProfile> profile;

    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] EmissionSample sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const;
    [[nodiscard]] float emission_pdf(const Vec3f& direction, float cos_light, const SceneSphere& scene) const;
    [[nodiscard]] LightCone<float> cone(std::uint32_t) const;
    void turn(EmissionSample& sample, const Vec3f& direction) const;
    /// Returns the power by a rule of 1,024 points over the vertical angle: near enough for a choice, and exact to some
    /// 1e-5 for profiles as they are measured.
    [[nodiscard]] float power(float scene_radius) const;
    /// All directions within the cone into which there is any light count alike.
    [[nodiscard]] LightBounds bounds() const;
    [[nodiscard]] std::optional<Vec3f> point() const { return position(); }
    /// Returns nothing for the profile, which lamps share.
    [[nodiscard]] static constexpr std::size_t bytes() { return 0; }
    [[nodiscard]] static constexpr bool is_delta() { return true; }
    [[nodiscard]] static constexpr bool is_at_infinity() { return false; }
    [[nodiscard]] static constexpr bool is_environment() { return false; }

  private:
    [[nodiscard]] Vec3f position() const {
        return std::visit([](const auto& l) { return l.position; }, lamp);
    }
    /// Returns the intensity along `direction`, W/sr.
    [[nodiscard]] Rgb intensity(const Vec3f& direction) const;
    /// Returns the cosine of the half angle of the cone into which the profile, and the spot, have any light.
    [[nodiscard]] float cos_emission() const;
};

}  // namespace etendue
