#include "integrator/bdpt/met_light.h"

#include "transport/shadow_catcher.h"
#include "wave/aov/first_hits.h"
#include "wave/one_kind_tracer.h"
#include "wave/profile/wave_profile.h"

namespace etendue {

void MetLight::on_first_hits(std::span<const Ray> rays, std::span<const Hit> hits) {
    find_first_hits(parts_.job.world(), parts_.job.job, parts_.job.samples, rays, hits, parts_.tile);
    parts_.lamps.note(parts_.job.samples, rays, hits, parts_.counters);
}

void MetLight::on_replaced_surface(SubpathState& state, const Ray& ray, const Interior& interior, const Hit& hit) {
    const BdptJob& job = parts_.job;
    const SeenInPlace seen = trace_seen_in_place(job.world(), job.job, ray, interior, hit, job.samples[state.slot].key,
                                                 state.slot, parts_.found, parts_.counters);
    if (seen.is_hole) parts_.alpha[state.slot] = alpha_over_background(state.throughput);
    state.throughput *= seen.passed;
}

void MetLight::count(const SubpathState& state) const {
    WaveProfile* const profile = parts_.job.job.profile;
    if (profile != nullptr && state.index > kDirectlySeen) ++profile->use().bsdf_met_light;
}

void MetLight::add(const SubpathState& state, const Rgb& light, const StrategySums& sums,
                   const AovSet::Source& source) {
    const BdptJob& job = parts_.job;
    PathWords& words = parts_.eye.vertices().words();
    if (!job.wants({.s = 0, .t = state.index + 1})) return;
    const float share = job.weight(sums);
    shares_.clear();
    if (words.are_followed()) words.end_at_light(state.words, source, shares_);
    parts_.found.add(state.slot,
                     state.throughput * light * job.wavelength_weight(state.slot, state.is_dispersed) * share,
                     kind_of_met_light(state.index == kDirectlySeen, state.lights_directly), shares_);
}

void MetLight::on_emitter(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction,
                          const SubpathDensities& arrived) {
    if (!parts_.job.lengths.is_long_enough(state.edges)) return;
    if (state.only_deltas && state.edges > 1 && parts_.lamps.finds_image(parts_.job.samples[state.slot])) return;
    const World& world = parts_.job.world();
    const Rgb emitted = world.materials().emission(point, -direction);
    if (is_black(emitted)) return;
    count(state);
    add(state, emitted,
        sums_of_met_lamp(parts_.job.mis, state, point, -direction, parts_.job.camera_rays[state.slot].time, arrived),
        parts_.eye.vertices().words().surface_source(point));
}

void MetLight::on_unlit(const SubpathState& state, const SurfacePoint& point) {
    // Only what the eye sees directly or in mirrors shows an unlit surface; it lights nothing.
    if (state.only_deltas && parts_.job.lengths.is_long_enough(state.edges))
        add(state, parts_.job.world().materials().unlit_color(point), {},
            parts_.eye.vertices().words().surface_source(point));
}

void MetLight::on_escape(const SubpathState& state, const Vec3f& direction) {
    const World& world = parts_.job.world();
    const bool is_direct = state.index == kDirectlySeen;
    const std::span<const std::uint32_t> met = world.environment().met(is_direct);
    // A subpath without light has met a holdout, which has given the sample its alpha.
    if (is_direct && met.empty() && !is_black(state.throughput))
        parts_.alpha[state.slot] = alpha_over_background(state.throughput);
    if (!parts_.job.lengths.is_long_enough(state.edges)) return;
    for (const std::uint32_t light : met) {
        const Rgb radiance = world.environment().radiance(light, direction);
        // What is black of an environment is met, too, and weighed.
        if (light != world.environment().light() && is_black(radiance)) continue;
        StrategySums sums;
        if (!is_direct) sums = sums_from_afar(parts_.job.mis, state.from, light, direction, state.departing);
        if (!is_black(radiance)) count(state);
        add(state, radiance, sums, parts_.eye.vertices().words().light_source(world, light));
    }
}

}  // namespace etendue
