#include "transport/shadow_catcher.h"

#include "core/frame.h"
#include "sampling/warp.h"
#include "transport/bodies.h"
#include "transport/connecting_ray.h"

#include <algorithm>

namespace etendue {

namespace {

/// Bounds the samples that are taken while no light is found.
constexpr std::uint32_t kMostCatcherSamples = 4 * kCatcherSamples;

/// Sums the irradiance of samples, as if nothing stood in their way and as it is.
struct CaughtLight {
    double all = 0.0;
    double arriving = 0.0;
};

/// Returns the key of a round: of the rounds beyond kCatcherSamples, none takes the numbers of another sample.
SampleKey round_key(SampleKey key, std::uint32_t samples, std::uint32_t round) {
    if (const std::uint32_t more = round / samples; more > 0) key.pixel_seed = hash_combine(key.pixel_seed, more);
    return light_sample_key(key, samples, round % samples);
}

/// Returns light of the environment from a direction that every second round draws by its radiance and the others by
/// the cosine with `normal`; the density is that of both together, so that light behind the surface takes no more than
/// half of the samples.
LightSample sample_environment_above(const World& world, const Vec3f& point, const Vec3f& normal,
                                     const SampleNumbers& numbers, std::uint32_t round) {
    const SampleNumbers own{numbers.sequence, round_key(numbers.key, kCatcherSamples / 2, round / 2)};
    const std::uint32_t environment = world.environment().light();
    LightSample light;
    if (round % 2 == 0) {
        light = world.environment().sample_all(point, own.pair(bounce_dimension(1, kBsdfDirection)));
        if (!(light.pdf_solid_angle > 0.0f)) return light;
    } else {
        const Vec3f local = square_to_cosine_hemisphere(own.pair(bounce_dimension(1, kChoices)));
        light.wi = Frame::from_normal(normal).to_world(local);
        light.radiance = world.environment().radiance(environment, light.wi);
    }
    const float by_radiance = world.environment().emission_pdf_solid_angle(environment, light.wi);
    const float by_cosine = std::max(0.0f, dot(normal, light.wi)) * kInvPi;
    light.pdf_solid_angle = 0.5f * (by_radiance + by_cosine);
    return light;
}

}  // namespace

CaughtShadow caught_shadow(const World& world, const SurfacePoint& point, const Ray& arriving, const Interior& interior,
                           const SampleNumbers& numbers, SampleTracer* tracer) {
    const bool from_front = dot(point.geometric_normal, arriving.direction) <= 0.0f;
    const Vec3f normal = from_front ? point.geometric_normal : -point.geometric_normal;
    const LightReceiver receiver(point.position, normal);
    const std::uint32_t environment = world.environment().light();
    CaughtLight sum;
    CaughtShadow shadow;
    const auto add = [&](const LightSample& light, float weight, std::uint32_t alpha_key) {
        const float cosine = dot(normal, light.wi);
        if (!(cosine > 0.0f) || is_black(light.radiance) || !(weight > 0.0f)) return;
        const Rgb irradiance = light.radiance * (cosine * weight);
        Ray ray = shadow_ray(offset_origin(point.position, point.geometric_normal, point.clearance, light.wi), light);
        ray.time = arriving.time;
        ray.alpha_key = alpha_key;
        ++shadow.rays;
        sum.all += static_cast<double>(average(irradiance));
        sum.arriving += static_cast<double>(
            average(irradiance * visibility(world, ray, tracer) * transmittance(world, interior, ray, light.distance)));
    };
    const std::uint32_t alpha_key = numbers.bits(bounce_dimension(1, kAlpha));
    for (std::uint32_t round = 0; round < kCatcherSamples || (!(sum.all > 0.0) && round < kMostCatcherSamples);
         ++round) {
        // Those of the lamps' choice find only what is brighter than an environment's mean.
        if (environment != kNone) {
            const LightSample light = sample_environment_above(world, point.position, normal, numbers, round);
            if (light.pdf_solid_angle > 0.0f)
                add(light, 1.0f / light.pdf_solid_angle, shadow_alpha_key(alpha_key, 2 * round));
        }
        if (!world.traits().has_sampled_lights) continue;
        const SampleNumbers own{numbers.sequence, round_key(numbers.key, kCatcherSamples, round)};
        const auto draw = [&](BounceDimension which) { return own.pair(bounce_dimension(1, which)); };
        const LightNumbers u{draw(kLightChoice), draw(kLightTriangle), draw(kLightDirection)};
        const ChosenLight chosen = world.lights().sample(receiver, u, arriving.time);
        if (chosen.light == environment) continue;
        if (const float density = chosen.density(); density > 0.0f)
            add(chosen.sample, 1.0f / density, shadow_alpha_key(alpha_key, 2 * round + 1));
    }
    if (sum.all > 0.0) shadow.share = static_cast<float>(std::clamp(1.0 - sum.arriving / sum.all, 0.0, 1.0));
    return shadow;
}

SeenInPlace seen_in_place(const World& world, const SurfacePoint& point, const Ray& ray, const Interior& interior,
                          const SampleNumbers& numbers, SampleTracer* tracer) {
    if (point.material->seen_as == SeenAs::Hole) return {.is_hole = true};
    const CaughtShadow caught = caught_shadow(world, point, ray, interior, numbers, tracer);
    return {.passed = 1.0f - caught.share, .rays = caught.rays};
}

}  // namespace etendue
