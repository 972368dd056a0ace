#include "transport/shadow_catcher.h"

#include "transport/connecting_ray.h"
#include "transport/walk.h"

#include <algorithm>

namespace etendue {

namespace {

/// Sums the irradiance of samples, as if nothing stood in their way and as it is.
struct CaughtLight {
    double all = 0.0;
    double arriving = 0.0;
};

}  // namespace

float caught_shadow(const World& world, const SurfacePoint& point, const Vec3f& wo, float time,
                    const SampleNumbers& numbers) {
    const Vec3f normal = dot(point.geometric_normal, wo) < 0.0f ? -point.geometric_normal : point.geometric_normal;
    const LightReceiver receiver(point.position, normal);
    const std::uint32_t environment = world.environment().light();
    CaughtLight sum;
    const auto add = [&](const LightSample& light, float weight, std::uint32_t alpha_key) {
        const float cosine = dot(normal, light.wi);
        if (!(cosine > 0.0f) || is_black(light.radiance) || !(weight > 0.0f)) return;
        const Rgb irradiance = light.radiance * (cosine * weight);
        Ray ray = shadow_ray(offset_origin(point.position, point.geometric_normal, point.clearance, light.wi), light);
        ray.time = time;
        ray.alpha_key = alpha_key;
        sum.all += static_cast<double>(average(irradiance));
        sum.arriving += static_cast<double>(average(irradiance * visibility(world, ray)));
    };
    const std::uint32_t alpha_key = numbers.bits(bounce_dimension(1, kAlpha));
    for (std::uint32_t round = 0; round < kCatcherSamples; ++round) {
        const SampleNumbers own{numbers.sequence, light_sample_key(numbers.key, kCatcherSamples, round)};
        const auto draw = [&](BounceDimension which) { return own.pair(bounce_dimension(1, which)); };
        // Those of the lamps' choice find only what is brighter than an environment's mean.
        if (environment != kNone) {
            const LightSample light = world.environment().sample_all(point.position, draw(kBsdfDirection));
            if (light.pdf_solid_angle > 0.0f)
                add(light, 1.0f / light.pdf_solid_angle, shadow_alpha_key(alpha_key, 2 * round));
        }
        if (!world.traits().has_sampled_lights) continue;
        const LightNumbers u{draw(kLightChoice), draw(kLightTriangle), draw(kLightDirection)};
        const ChosenLight chosen = world.lights().sample(receiver, u);
        if (chosen.light == environment) continue;
        const LightSample& light = chosen.sample;
        const float density = light.is_delta ? chosen.expected_samples : light.pdf_solid_angle;
        if (density > 0.0f) add(light, 1.0f / density, shadow_alpha_key(alpha_key, 2 * round + 1));
    }
    if (!(sum.all > 0.0)) return 0.0f;
    return static_cast<float>(std::clamp(1.0 - sum.arriving / sum.all, 0.0, 1.0));
}

}  // namespace etendue
