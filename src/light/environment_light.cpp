#include "light/environment_light.h"

#include "core/trigonometry.h"
#include "light/punctual_light.h"
#include "sampling/warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace etendue {

namespace {

/// Negative and non-finite values become zero, and none is so large that sums of them overflow; in place.
ImageF& sanitize(ImageF& image) {
    constexpr float kBrightest = 1e30f;
    for (float& value : image.pixels)
        value = value >= 0.0f && std::isfinite(value) ? std::min(value, kBrightest) : 0.0f;
    return image;
}

/// A ray from where `towards` lies.
EmissionSample emission_from(const LightSample& towards, const EmissionNumbers& u, const SceneSphere& scene) {
    if (!(towards.pdf_solid_angle > 0.0f)) return {};
    EmissionSample sample = sample_emission_from_afar(-towards.wi, scene, u.position);
    sample.radiance = towards.radiance;
    sample.pdf_direction_solid_angle = towards.pdf_solid_angle;
    return sample;
}

/// Mean of the bilinear reconstruction over each texel's cell, average of the channels: a 3 × 3 stencil (1, 6, 1)² / 64
/// that wraps around in x and clamps in y. It is zero only where the reconstruction is zero.
std::vector<float> mean_of_cells(const ImageF& image) {
    constexpr float kStencil[3] = {0.125f, 0.75f, 0.125f};
    const int width = image.width;
    const int height = image.height;
    std::vector<float> grey(image.pixels.size() / 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto p = image.pixel(x, y);
            grey[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
                (p[0] + p[1] + p[2]) * (1.0f / 3.0f);
        }
    std::vector<float> means(grey.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float sum = 0.0f;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const auto row = static_cast<std::size_t>(std::clamp(y + dy, 0, height - 1));
                    const auto column = static_cast<std::size_t>((x + dx + width) % width);
                    sum += kStencil[dx + 1] * kStencil[dy + 1] * grey[row * static_cast<std::size_t>(width) + column];
                }
            means[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = sum;
        }
    return means;
}

/// Makes densities in proportion to the mean of each cell and to what of it is above that of the sphere, both times its
/// solid angle.
ImageEnvironment::Densities make_densities(const ImageF& image) {
    std::vector<float> cells = mean_of_cells(image);
    std::vector<float> sines;
    sines.reserve(static_cast<std::size_t>(image.height));
    for (int y = 0; y < image.height; ++y)
        sines.push_back(std::sin(kPi * (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height)));
    const auto row = [&](std::size_t y) {
        const auto width = static_cast<std::size_t>(image.width);
        return std::span(cells).subspan(y * width, width);
    };
    double sum = 0.0;
    double solid_angle = 0.0;
    for (std::size_t y = 0; y < sines.size(); ++y)
        for (float& cell : row(y)) {
            cell *= sines[y];
            sum += static_cast<double>(cell);
            solid_angle += static_cast<double>(sines[y]);
        }
    // What is brighter by less is rounding: an image of one colour is a constant environment.
    constexpr double kRounding = 1e-4;
    const auto mean = static_cast<float>(sum / solid_angle * (1.0 + kRounding));
    ImageEnvironment::Densities densities{.complete = {cells, image.width, image.height}, .compensated = {}};
    for (std::size_t y = 0; y < sines.size(); ++y)
        for (float& cell : row(y)) cell = std::max(cell - mean * sines[y], 0.0f);
    densities.compensated = {cells, image.width, image.height};
    return densities;
}

}  // namespace

Vec3f latitude_longitude_direction(Vec2f position) {
    const SinCos theta = sin_cos_turns(0.5f * position.y);
    // Half a turn from the middle of the image, which changes the signs of both.
    const SinCos phi = sin_cos_turns(position.x);
    return {-theta.sin * phi.sin, theta.cos, theta.sin * phi.cos};
}

LightSample ConstantEnvironment::sample(const Vec3f&, Vec2f u) const {
    LightSample sample;
    sample.wi = square_to_sphere(u);
    sample.radiance = value;
    sample.pdf_solid_angle = sphere_pdf_solid_angle();
    return sample;
}

EmissionSample ConstantEnvironment::sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const {
    return emission_from(sample(scene.center, u.direction), u, scene);
}

float ConstantEnvironment::emission_pdf(const Vec3f&, float, const SceneSphere& scene) const {
    return emission_from_afar_pdf_area(scene);
}

float ConstantEnvironment::pdf_solid_angle(const Vec3f&) const {
    return sphere_pdf_solid_angle();
}

float ConstantEnvironment::power(float scene_radius) const {
    return 4.0f * kPi * kPi * scene_radius * scene_radius * average(value);
}

ImageEnvironment::ImageEnvironment(ImageF image, float rotation)
    : densities_(make_densities(sanitize(image))),
      // Never filtered, so that hits and light samples see one function.
      texture_(Texture::without_levels(std::move(image), {.wrap_u = Wrap::Repeat, .wrap_v = Wrap::Clamp})),
      sin_rotation_(std::sin(rotation)),
      cos_rotation_(std::cos(rotation)) {}

Vec2f ImageEnvironment::to_image(const Vec3f& direction) const {
    const float x = direction.x * cos_rotation_ - direction.z * sin_rotation_;
    const float z = direction.x * sin_rotation_ + direction.z * cos_rotation_;
    const float u = 0.5f + std::atan2(x, -z) * (0.5f * kInvPi);
    // Not the arc cosine of y, which loses all digits near the poles.
    const float v = std::atan2(std::hypot(x, z), direction.y) * kInvPi;
    return {std::clamp(u, 0.0f, kOneMinusEpsilon), std::clamp(v, 0.0f, kOneMinusEpsilon)};
}

Vec3f ImageEnvironment::from_image(Vec2f position) const {
    const Vec3f d = latitude_longitude_direction(position);
    return {d.x * cos_rotation_ + d.z * sin_rotation_, d.y, -d.x * sin_rotation_ + d.z * cos_rotation_};
}

Rgb ImageEnvironment::radiance(const Vec3f& direction) const {
    return texture_.lookup(to_image(direction)).rgb;
}

LightSample ImageEnvironment::sample_at(const Distribution2D::Sample& position) const {
    const float sin_theta = sin_cos_turns(0.5f * position.position.y).sin;
    if (!(sin_theta > 0.0f) || !(position.pdf > 0.0f)) return {};
    LightSample sample;
    sample.wi = from_image(position.position);
    sample.radiance = texture_.lookup(position.position).rgb;
    sample.pdf_solid_angle = position.pdf / (2.0f * kPi * kPi * sin_theta);
    return sample;
}

float ImageEnvironment::density_of(const Distribution2D& distribution, const Vec3f& direction, Vec2f position) {
    const float sin_theta = std::hypot(direction.x, direction.z);
    if (!(sin_theta > 0.0f)) return 0.0f;
    return distribution.pdf(position) / (2.0f * kPi * kPi * sin_theta);
}

// A row between the polar angles a and b covers 2 pi (cos a - cos b) = 4 pi sin((a + b) / 2) sin(pi / (2 height)); the
// first sine is in the weights already, the sphere has 4 pi.
double ImageEnvironment::sphere_mean(const Distribution2D& distribution) const {
    return distribution.integral() * texture_.height() * std::sin(0.5 * std::numbers::pi / texture_.height());
}

LightSample ImageEnvironment::sample(const Vec3f&, Vec2f u) const {
    return sample_at(densities_.complete.sample(u));
}

LightSample ImageEnvironment::sample_compensated(const Vec3f&, Vec2f u) const {
    return sample_at(densities_.compensated.sample(u));
}

void ImageEnvironment::sample_compensated(std::span<const Vec2f> u, std::span<LightSample> samples) const {
    constexpr std::size_t kAtOnce = 64;
    std::array<Distribution2D::Sample, kAtOnce> positions;
    for (std::size_t first = 0; first < samples.size(); first += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, samples.size() - first);
        densities_.compensated.sample(u.subspan(first), std::span(positions).first(count));
        for (std::size_t i = 0; i < count; ++i) texture_.fetch(positions[i].position);
        for (std::size_t i = 0; i < count; ++i) samples[first + i] = sample_at(positions[i]);
    }
}

void ImageEnvironment::look(std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen) const {
    constexpr std::size_t kAtOnce = 64;
    std::array<Vec2f, kAtOnce> positions;
    for (std::size_t first = 0; first < directions.size(); first += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, directions.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            positions[i] = to_image(directions[first + i]);
            texture_.fetch(positions[i]);
            densities_.compensated.fetch_pdf(positions[i]);
        }
        for (std::size_t i = 0; i < count; ++i)
            seen[first + i] = {texture_.lookup(positions[i]).rgb,
                               density_of(densities_.compensated, directions[first + i], positions[i])};
    }
}

EmissionSample ImageEnvironment::sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const {
    return emission_from(sample(scene.center, u.direction), u, scene);
}

float ImageEnvironment::emission_pdf(const Vec3f&, float, const SceneSphere& scene) const {
    return emission_from_afar_pdf_area(scene);
}

float ImageEnvironment::pdf_solid_angle(const Vec3f& direction) const {
    return density_of(densities_.complete, direction, to_image(direction));
}

float ImageEnvironment::compensated_pdf_solid_angle(const Vec3f& direction) const {
    return density_of(densities_.compensated, direction, to_image(direction));
}

float ImageEnvironment::power(float scene_radius) const {
    return static_cast<float>(sphere_mean(densities_.complete)) * 4.0f * kPi * kPi * scene_radius * scene_radius;
}

float ImageEnvironment::compensated_power(float scene_radius) const {
    return static_cast<float>(sphere_mean(densities_.compensated)) * 4.0f * kPi * kPi * scene_radius * scene_radius;
}

}  // namespace etendue
