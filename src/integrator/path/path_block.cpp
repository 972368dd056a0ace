#include "integrator/path/path_block.h"

#include "core/vector_bytes.h"

#include <span>

namespace etendue {

void PathBlock::draw_numbers(const PathContext& context, const WavePaths& wave) {
    const std::span pixel_seeds(wave.pixel_seed.data() + first, count);
    const std::span indices(wave.index.data() + first, count);
    const bool has_bodies = context.world.traits().has_bodies;
    const bool ends =
        context.rays >= context.settings.lengths.max_depth && !has_bodies && !context.world.traits().has_clear_surfaces;
    const auto draw = [&](std::uint32_t dimension, NumberPairs& numbers, bool is_needed = true) {
        if (is_needed && !ends)
            numbers.draw(context.job.sequence, pixel_seeds, indices, dimension);
        else
            numbers.draw_none(count);
    };
    if (has_bodies) draw(body_dimension(context.rays, kMedium), medium, context.world.traits().has_scattering_bodies);
    if (context.samples_lights() && context.world.traits().has_sampled_lights && !ends)
        draw_light_numbers(context, wave, 0);
    draw(bounce_dimension(context.rays, kBsdfDirection), bsdf_direction);
    draw(bounce_dimension(context.rays, kChoices), choices);
}

void PathBlock::draw_light_numbers(const PathContext& context, const WavePaths& wave, std::uint32_t round) {
    std::span pixel_seeds(wave.pixel_seed.data() + first, count);
    std::span indices(wave.index.data() + first, count);
    std::array<std::uint32_t, kBlockLanes> split_seeds;
    std::array<std::uint32_t, kBlockLanes> split_indices;
    if (context.settings.light_samples > 1) {
        for (std::size_t k = 0; k < count; ++k) {
            const SampleKey key = wave.light_sample_key(context, first + k, round);
            split_seeds[k] = key.pixel_seed;
            split_indices[k] = key.index;
        }
        pixel_seeds = std::span(split_seeds).first(count);
        indices = std::span(split_indices).first(count);
    }
    const auto draw = [&](BounceDimension which, NumberPairs& numbers) {
        numbers.draw(context.job.sequence, pixel_seeds, indices, bounce_dimension(context.rays, which));
    };
    if (context.world.traits().chooses_lights)
        draw(kLightChoice, light_choice);
    else
        light_choice.draw_none(count);
    draw(kLightTriangle, light_triangle);
    draw(kLightDirection, light_direction);
}

VertexEvent PathBlock::wide_event(const World& world, const PathWords& words, std::size_t k, const Vec3f& wi) const {
    const auto label = words.label(world, singles[k].point);
    return paths[k].glossy == nullptr
               ? diffuse_event(label)
               : surface_event(*singles[k].scattering, wi, false, TransportMode::Radiance, label);
}

std::size_t PathBlock::bytes() const {
    std::size_t bytes = vector_bytes(singles, clear);
    for (const NumberPairs* numbers :
         {&light_choice, &light_triangle, &light_direction, &bsdf_direction, &choices, &medium})
        bytes += numbers->bytes();
    return bytes;
}

}  // namespace etendue
