#include "integrator/camera_wave.h"

namespace etendue {

namespace {

Vec2i pixel_position(const TileJob& job, std::uint32_t pixel) {
    const auto width = static_cast<std::uint32_t>(job.rect.width());
    return {job.rect.x0 + static_cast<int>(pixel % width), job.rect.y0 + static_cast<int>(pixel / width)};
}

}  // namespace

void generate_camera_rays(const World& world, const TileJob& job, std::size_t first, std::span<CameraSample> samples,
                          std::span<Ray> rays) {
    const std::size_t area = job.rect.area();
    const Vec2f to_film{1.0f / static_cast<float>(job.full_width), 1.0f / static_cast<float>(job.full_height)};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto pixel = static_cast<std::uint32_t>((first + i) % area);
        const auto index = job.first_sample + static_cast<std::uint32_t>((first + i) / area);
        const Vec2i position = pixel_position(job, pixel);
        CameraSample& sample = samples[i];
        sample.pixel = pixel;
        sample.key = {
            make_pixel_seed(job.seed, static_cast<std::uint32_t>(position.x), static_cast<std::uint32_t>(position.y)),
            index};
        const PixelFilter::Sample filtered = job.filter->sample(sample_2d(job.sequence, sample.key, kFilmDimension));
        sample.weight = filtered.weight;
        const Vec2f film{(static_cast<float>(position.x) + 0.5f + filtered.offset.x) * to_film.x,
                         (static_cast<float>(position.y) + 0.5f + filtered.offset.y) * to_film.y};
        const float time = world.has_motion() ? sample_2d(job.sequence, sample.key, kTimeDimension).x : 0.0f;
        rays[i] = world.generate_ray(film, sample_2d(job.sequence, sample.key, kLensDimension), time);
        rays[i].alpha_key = sample_bits(sample.key, kCameraAlphaDimension);
    }
}

void accumulate(const TileJob& job, const CameraSample& sample, const Rgb& radiance, float alpha, TileBuffer& tile,
                RenderCounters& counters) {
    ++counters.samples;
    if (!is_finite(radiance) || min_component(radiance) < 0.0f) {
        const Vec2i position = pixel_position(job, sample.pixel);
        counters.drop({position.x, position.y, sample.key.index});
        return;
    }
    tile.pixel(sample.pixel).add(radiance, alpha, sample.weight);
}

}  // namespace etendue
