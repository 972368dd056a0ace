// Light from infinitely far away in every direction: constant, or a latitude-longitude image.
//
// Image mapping (before `rotation`): the centre of the image lies towards -Z, its right half towards +X, its top row
// towards +Y.
//
// Its light is sampled in two ways. `sample` and `sample_emission` find all of it, with a density that follows the
// radiance. `sample_compensated` finds what is brighter than the mean over the sphere, with a density that follows the
// difference: for points where samples of the BSDF or of the phase function look for the same light and the two are
// combined by multiple importance sampling, which leaves the dim parts to those (Karlík, Šik, Vévoda, Skřivan and
// Křivánek, "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling", 2019, section 5.1).
// Nothing of a constant environment is brighter than its mean: where others look for it, it needs no samples at all.
#pragma once

#include "light/emission_sample.h"
#include "light/light_sample.h"
#include "sampling/distribution.h"
#include "texture/texture.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace etendue {

/// The direction, before any rotation, at `position` in [0, 1]² of an image, v down from its top row.
[[nodiscard]] Vec3f latitude_longitude_direction(Vec2f position);

/// Holds what a ray meets that leaves the scene.
struct EnvironmentRadiance {
    Rgb radiance;
    float pdf_solid_angle = 0.0f;  ///< with which `sample_compensated` picks the ray's direction
};

/// Shines with the same radiance from everywhere.
struct ConstantEnvironment {
    Rgb value{1.0f};

    [[nodiscard]] Rgb radiance(const Vec3f&) const { return value; }
    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] EmissionSample sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const;
    [[nodiscard]] float emission_pdf(const Vec3f& direction, float cos_light, const SceneSphere& scene) const;
    [[nodiscard]] float pdf_solid_angle(const Vec3f& direction) const;
    [[nodiscard]] float power(float scene_radius) const;
    // Nothing of it is brighter than its mean, so that samples of that are black.
    [[nodiscard]] LightSample sample_compensated(const Vec3f&, Vec2f) const { return {}; }
    void sample_compensated(std::span<const Vec2f>, std::span<LightSample> samples) const {
        std::ranges::fill(samples, LightSample());
    }
    [[nodiscard]] float compensated_pdf_solid_angle(const Vec3f&) const { return 0.0f; }
    void look(std::span<const Vec3f>, std::span<EnvironmentRadiance> seen) const {
        std::ranges::fill(seen, EnvironmentRadiance{value});
    }
    [[nodiscard]] float compensated_power(float) const { return 0.0f; }
    [[nodiscard]] static std::optional<Vec3f> point() { return std::nullopt; }
    [[nodiscard]] static constexpr std::size_t bytes() { return 0; }
    [[nodiscard]] static constexpr bool is_delta() { return false; }
    [[nodiscard]] static constexpr bool is_at_infinity() { return true; }
    [[nodiscard]] static constexpr bool is_environment() { return true; }
};

/// An image, importance-sampled in two dimensions by its bilinear reconstruction's mean over each cell, times the sine
/// of the polar angle. A texel costs 12 bytes for its colour and 5 for each of its densities.
class ImageEnvironment {
  public:
    /// `image` has 3 linear channels in the working space, already scaled; `rotation` in radians about +Y,
    /// counter-clockwise seen from above. Negative and non-finite values are taken as zero.
    ImageEnvironment(ImageF image, float rotation);

    [[nodiscard]] Rgb radiance(const Vec3f& direction) const;
    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] EmissionSample sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const;
    [[nodiscard]] float emission_pdf(const Vec3f& direction, float cos_light, const SceneSphere& scene) const;
    [[nodiscard]] float pdf_solid_angle(const Vec3f& direction) const;
    [[nodiscard]] float power(float scene_radius) const;
    [[nodiscard]] LightSample sample_compensated(const Vec3f& point, Vec2f u) const;
    /// Takes as many compensated samples at once as there are `samples`, one for each of the numbers `u`.
    void sample_compensated(std::span<const Vec2f> u, std::span<LightSample> samples) const;
    [[nodiscard]] float compensated_pdf_solid_angle(const Vec3f& direction) const;
    /// Fills `seen` with what a ray meets along each of as many `directions`: what each reads is on its way while the
    /// others are looked at.
    void look(std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen) const;
    [[nodiscard]] float compensated_power(float scene_radius) const;
    [[nodiscard]] static std::optional<Vec3f> point() { return std::nullopt; }
    [[nodiscard]] static constexpr bool is_delta() { return false; }
    [[nodiscard]] static constexpr bool is_at_infinity() { return true; }
    [[nodiscard]] static constexpr bool is_environment() { return true; }
    [[nodiscard]] std::size_t bytes() const {
        return texture_.bytes() + densities_.complete.bytes() + densities_.compensated.bytes();
    }

    struct Densities {
        Distribution2D complete, compensated;
    };

  private:
    [[nodiscard]] LightSample sample_at(const Distribution2D::Sample& position) const;
    /// `position` is where `direction` is in the image.
    [[nodiscard]] static float density_of(const Distribution2D& distribution, const Vec3f& direction, Vec2f position);
    /// Returns the mean over the sphere of the function that `distribution` is made from.
    [[nodiscard]] double sphere_mean(const Distribution2D& distribution) const;
    [[nodiscard]] Vec2f to_image(const Vec3f& direction) const;
    [[nodiscard]] Vec3f from_image(Vec2f position) const;

    Densities densities_;
    Texture texture_;
    float sin_rotation_ = 0.0f;
    float cos_rotation_ = 1.0f;
};

}  // namespace etendue
