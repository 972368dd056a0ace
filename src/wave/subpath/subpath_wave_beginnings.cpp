// Where subpaths begin: at the eye and at the lights.
#include "core/in_place.h"
#include "transport/subpath.h"
#include "wave/ray_batch.h"
#include "wave/subpath/subpath_wave.h"

#include <algorithm>

namespace etendue {

void SubpathWave::begin_at_eye(const SubpathJob& job) {
    PathWords& words = vertices_.words();
    if (job.world().traits().has_bodies)
        for (const Ray& ray : rays_) interiors_.push_back(job.world().media().interior_at_camera(ray));
    for (std::size_t i = 0; i < states_.size(); ++i) {
        states_[i].slot = static_cast<std::uint32_t>(i);
        states_[i].from = rays_[i].origin;
        if (words.are_followed()) states_[i].words = words.begin_at_eye();
    }
}

void SubpathWave::begin_at_lights(const SubpathJob& job) {
    const World& world = job.world();
    PathWords& words = vertices_.words();
    emissions_.resize(job.samples.size());
    keys_.clear();
    for (const CameraSample& sample : job.samples) keys_.push_back(sample.key);
    const auto draw = [&](std::uint32_t which, NumberPairs& numbers) {
        numbers.draw(job.job.sequence, keys_, kFirstLightDimension + which);
    };
    if (world.traits().chooses_emitters)
        draw(kEmitterChoice, light_choice_);
    else
        light_choice_.draw_none(keys_.size());
    draw(kTriangle, triangle_);
    draw(kPosition, position_);
    draw(kDirection, direction_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < job.samples.size(); ++i) {
        const EmissionNumbers u{triangle_[i], position_[i], direction_[i]};
        const Emission& emission = emissions_[i];
        make_in_place(emissions_[i],
                      [&] { return world.emitters().sample(light_choice_[i], u, rays_[i].time, job.mis.aims); });
        if (job.lengths.max_depth < edges_to_connect(world) || is_black(emission.weight)) continue;
        const EmissionSample& sample = emission.sample;
        SubpathState state;
        state.throughput = emission.weight;
        state.roulette_scale = 1.0f / max_component(emission.weight);
        state.from = sample.position;
        state.slot = static_cast<std::uint32_t>(i);
        if (words.are_followed()) state.words = words.begin_at_light(words.light_source(world, emission.light));
        state.departing = leave_light(job.mis, emission);
        states_[kept] = state;
        rays_[kept] = emission.ray;
        rays_[kept].alpha_key = sample_bits(keys_[i], kFirstLightDimension);
        if (world.traits().has_bodies)
            interiors_.push_back(world.emitters().interior(emission, emission.ray.direction));
        ++kept;
    }
    states_.resize(kept);
    rays_.resize(kept);
}

}  // namespace etendue
