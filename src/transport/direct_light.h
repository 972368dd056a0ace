// Light that vertices receive from lights: met by chance, and sampled. Both estimate the same light and are combined by
// multiple importance sampling (Veach 1997, chapter 9).
#pragma once

#include "core/rgb.h"
#include "sampling/mis.h"
#include "transport/walk.h"

#include <cstdint>

namespace etendue {

/// Returns the weight of light that a ray has met by chance. The ray left the last vertex with density
/// `pdf_solid_angle`; each of `samples` light samples there would have found the light with `light_pdf_solid_angle`.
/// Without light samples the weight is 1.
[[nodiscard]] inline float met_light_weight(float pdf_solid_angle, float light_pdf_solid_angle, std::uint32_t samples) {
    if (samples == 0) return 1.0f;
    // How many samples of the light are expected, not how probable one is (Veach 1997, section 9.2.1).
    return power_heuristic(pdf_solid_angle, light_pdf_solid_angle * static_cast<float>(samples));
}

/// Returns the weight of a light sample, over its density, that the scattering at hand would have found with
/// `pdf_solid_angle`.
[[nodiscard]] inline float light_sample_scale(const ChosenLight& chosen, float pdf_solid_angle) {
    const LightSample& light = chosen.sample;
    // A delta light can be found in no other way.
    return (light.is_delta ? 1.0f : power_heuristic(light.pdf_solid_angle, pdf_solid_angle)) / chosen.density();
}

/// Makes `choice` one of `samples` that share an estimate: weights and densities then are of how many samples of the
/// light are expected, not of how probable one is (Veach 1997, section 9.2.1).
inline void share_estimate(LightTree::Choice& choice, std::uint32_t samples) {
    choice.probability *= static_cast<float>(samples);
}

/// Returns the density, 1/sr, with which the light that is chosen for `receiver` is this one, infinitely far away, and
/// is sampled along `direction`; 0 if no lights are sampled.
[[nodiscard]] inline float chosen_pdf_from_afar(const World& world, const LightReceiver& receiver, std::uint32_t light,
                                                const Vec3f& direction) {
    if (!world.traits().has_sampled_lights) return 0.0f;
    return world.lights().probability(receiver, light) * world.environment().pdf_solid_angle(light, direction);
}

/// Returns the light, on its way to the eye, that the path's ray has met at `vertex` by chance.
[[nodiscard]] Rgb met_light(const World& world, const EyePath& path, const Vertex& vertex);

/// Returns the light, on its way to the eye, that `samples` light samples find at `vertex`.
[[nodiscard]] Rgb sampled_light(const World& world, const EyePath& path, const Vertex& vertex,
                                const SampleNumbers& numbers, const VertexNumbers& u, std::uint32_t samples);

/// Says how the ray to a sampled light is traced.
struct ShadowTrace {
    float time;  ///< while the shutter is open, [0, 1]
    std::uint32_t alpha_key;
    SampleTracer* tracer = nullptr;  ///< null if the World traces it
};

/// Returns the light of a light sample that `vertex` scatters back along its path, times the path's `throughput`.
/// `f_cos` is the BSDF times the cosine along the sample's direction, or the phase function. `scale` is the sample's
/// weight over its density.
[[nodiscard]] Rgb light_contribution(const World& world, const Vertex& vertex, const Rgb& throughput,
                                     const LightSample& light, const Rgb& f_cos, float scale, const ShadowTrace& trace);

}  // namespace etendue
