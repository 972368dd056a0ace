#include "integrator/path/wave_paths.h"

#include "core/vector_bytes.h"
#include "transport/scattered_cone.h"

#include <algorithm>

namespace etendue {

void WavePaths::begin(const World& world, const TileJob& job, std::span<const Ray> rays) {
    if (world.traits().has_bodies) {
        interiors.resize(kCapacity);
        std::ranges::transform(rays, interiors.begin(),
                               [&](const Ray& ray) { return world.media().interior_at_camera(ray); });
    }
    if (world.traits().chooses_lights_by_receiver) receivers.resize(kCapacity);
    if (world.traits().has_clear_surfaces) passed.assign(kCapacity, 0.0f);
    words.reset(job.aovs);
    if (words.are_followed()) ranges.assign(kCapacity, words.begin_at_eye());
    PathColumns::begin(rays, samples);
    if (world.traits().has_textures)
        for (std::size_t i = 0; i < rays.size(); ++i)
            set_cone(i, camera_cone(world, job.full_width, job.full_height, rays[i]));
}

// By value, so that no store to a column can be taken for one to `survivors`.
void WavePaths::move(BlockSurvivors survivors, const SceneTraits& traits) {
    for (auto* column : {&origin.x, &origin.y, &origin.z, &direction.x, &direction.y, &direction.z, &throughput.r,
                         &throughput.g, &throughput.b, &roulette_scale, &pdf_solid_angle})
        survivors.move(*column);
    for (auto* column : {&slot, &pixel_seed, &index, &history}) survivors.move(*column);
    if (traits.has_motion) survivors.move(time);
    if (traits.has_transparency) survivors.move(alpha_key);
    if (traits.has_textures) {
        survivors.move(cone_width);
        survivors.move(cone_spread);
    }
    if (traits.has_bodies) {
        survivors.move(wavelength_nm);
        survivors.for_each([&](std::size_t from, std::size_t to) { interiors[to] = interiors[from]; });
    }
    if (!receivers.empty())
        survivors.for_each([&](std::size_t from, std::size_t to) { receivers[to] = receivers[from]; });
    if (!passed.empty()) survivors.for_each([&](std::size_t from, std::size_t to) { passed[to] = passed[from]; });
    if (words.are_followed()) survivors.for_each([&](std::size_t from, std::size_t to) { ranges[to] = ranges[from]; });
}

std::size_t WavePaths::bytes() const {
    return vector_bytes(hits, interiors, receivers, passed, ranges, samples);
}

}  // namespace etendue
