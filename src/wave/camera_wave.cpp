#include "wave/camera_wave.h"

#include "wave/number_pairs.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace etendue {

namespace {

/// The pixel of the job's tile that comes `k`-th: in bands of four rows, column by column, so that sixteen pixels, as
/// many as a packet has rays, are a square.
std::uint32_t pixel_in_order(const TileJob& job, std::uint32_t k) {
    constexpr std::uint32_t kRows = 4;
    const auto width = static_cast<std::uint32_t>(job.rect.width());
    const auto height = static_cast<std::uint32_t>(job.rect.height());
    const std::uint32_t top = k / (kRows * width) * kRows;
    const std::uint32_t rows = std::min(kRows, height - top);
    const std::uint32_t in_band = k - top * width;
    return (top + in_band % rows) * width + in_band / rows;
}

/// Offers `counters` the contributions in `light` that are bright enough for the list of the brightest.
void offer_brightest(const TileJob& job, std::span<const CameraSample> samples, const SampleLight& light,
                     RenderCounters& counters) {
    for (const BrightLight& bright : light.bright()) {
        const CameraSample& sample = samples[bright.slot];
        if (sample.is_blind && !bright.position) continue;
        const Vec2i maker = pixel_position(job, sample.pixel);
        BrightSample found{.x = maker.x,
                           .y = maker.y,
                           .sample_x = maker.x,
                           .sample_y = maker.y,
                           .sample = sample.key.index,
                           .value = bright.value};
        if (bright.position) {
            // The filter may show what falls beside the image.
            found.x = std::clamp(static_cast<int>(std::floor(bright.position->x)), job.window.x0, job.window.x1 - 1);
            found.y = std::clamp(static_cast<int>(std::floor(bright.position->y)), job.window.y0, job.window.y1 - 1);
            found.is_splat = 1;
        }
        counters.brightest.offer(found);
    }
}

void add_to_bucket(const BucketLayers& buckets, const CameraSample& sample, const Rgb& radiance, LayerBuffer& layers) {
    const std::size_t bucket = buckets.of(sample.key.index);
    const auto weight = static_cast<double>(sample.weight);
    layers.add_rgb(sample.pixel, 3 * (buckets.first_light + bucket), radiance, weight);
    const std::span<double> values =
        layers.sums(sample.pixel).subspan(layers.layout().value_sums() + buckets.first_value, buckets.value_count());
    values[bucket] += weight;
    values[buckets.count + bucket] += 1.0;
}

/// Adds what sample `slot` of a wave has found to the layers of its pixel.
void add_to_layers(const TileJob& job, const CameraSample& sample, std::size_t slot, const SampleLight& light,
                   const Rgb& radiance, float alpha, TileBuffer& tile) {
    LayerBuffer& layers = tile.layers();
    const LayerLayout& layout = layers.layout();
    const auto weight = static_cast<double>(sample.weight);
    if (job.aovs != nullptr && job.aovs->needs_first_hits())
        tile.wave_hits().add_to(layers, sample.pixel, slot, weight);
    if (layout.is_deep) {
        const auto part = [weight](float value) { return weight * static_cast<double>(value); };
        layers.deep().add(sample.pixel, {.front = tile.wave_hits().depth(slot),
                                         .back = tile.wave_hits().depth(slot),
                                         .alpha = part(alpha),
                                         .r = part(radiance.r),
                                         .g = part(radiance.g),
                                         .b = part(radiance.b)});
    }
    const std::span<const Rgb> parts = light.layers(slot);
    for (std::size_t layer = 0; layer < parts.size(); ++layer)
        layers.add_rgb(sample.pixel, 3 * layer, sample.is_blind ? Rgb() : parts[layer], weight);
    if (job.aovs != nullptr && job.aovs->buckets.count > 0) add_to_bucket(job.aovs->buckets, sample, radiance, layers);
    if (layout.has_moments) layers.add_moments(sample.pixel, radiance, weight);
    if (layout.has_ray_counts) layers.sums(sample.pixel)[layout.ray_sum()] += static_cast<double>(light.rays(slot));
}

}  // namespace

void generate_camera_rays(const World& world, const TileJob& job, std::size_t first, std::span<CameraSample> samples,
                          std::span<Ray> rays, SampleOrder order) {
    const bool by_pixel = order == SampleOrder::PixelByPixel;
    const std::size_t pixels = job.pixels.empty() ? job.rect.area() : job.pixels.size();
    std::vector<Vec2i> positions(rays.size());
    PixelJob pixel;
    Vec2i position(0, 0);
    std::uint32_t seed = 0;
    std::size_t entered = pixels;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::size_t which = by_pixel ? (first + i) / job.sample_count : (first + i) % pixels;
        const std::size_t round = by_pixel ? (first + i) % job.sample_count : (first + i) / pixels;
        if (which != entered) {
            pixel = job.pixels.empty()
                        ? PixelJob{pixel_in_order(job, static_cast<std::uint32_t>(which)), job.first_sample}
                        : job.pixels[which];
            position = pixel_position(job, pixel.pixel);
            seed = make_pixel_seed(job.seed, static_cast<std::uint32_t>(position.x),
                                   static_cast<std::uint32_t>(position.y));
            entered = which;
        }
        positions[i] = position;
        samples[i].pixel = pixel.pixel;
        samples[i].key = {seed, pixel.first_sample + static_cast<std::uint32_t>(round)};
    }
    generate_camera_rays(world, job, positions, samples, rays);
}

void generate_camera_rays(const World& world, const TileJob& job, std::span<const Vec2i> positions,
                          std::span<CameraSample> samples, std::span<Ray> rays) {
    const Vec2f to_film{1.0f / static_cast<float>(job.full_width), 1.0f / static_cast<float>(job.full_height)};
    SampleKeys keys;
    SampleKeys shared;
    for (const CameraSample& sample : samples) {
        keys.push_back(sample.key);
        if (world.traits().has_motion) shared.push_back(shared_key(job, sample.key));
    }
    NumberPairs film;
    NumberPairs lens;
    NumberPairs time;
    film.draw(job.sequence, keys, kFilmDimension);
    if (world.traits().has_lens) lens.draw(job.sequence, keys, kLensDimension);
    if (world.traits().has_motion) time.draw(job.sequence, shared, kTimeDimension);
    std::vector<Vec2f> on_film(samples.size());
    std::vector<Vec2f> on_lens(samples.size(), Vec2f(0.0f));
    std::vector<float> times(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const PixelFilter::Sample filtered = job.filter->sample(film[i]);
        on_film[i] = {(static_cast<float>(positions[i].x) + 0.5f + filtered.offset.x) * to_film.x,
                      (static_cast<float>(positions[i].y) + 0.5f + filtered.offset.y) * to_film.y};
        if (world.traits().has_lens) on_lens[i] = lens[i];
        if (world.traits().has_motion) times[i] = time[i].x;
        samples[i].weight = filtered.weight;
        samples[i].lens = on_lens[i];
    }
    world.camera().generate_rays(on_film, on_lens, times, rays);
    if (world.traits().has_blind_film)
        for (std::size_t i = 0; i < samples.size(); ++i) samples[i].is_blind = !(rays[i].t_max > 0.0f);
    if (!world.traits().has_transparency) return;
    for (std::size_t i = 0; i < samples.size(); ++i)
        rays[i].alpha_key = sample_bits(samples[i].key, kCameraAlphaDimension);
}

bool accumulate(const TileJob& job, const CameraSample& sample, const Rgb& radiance, float alpha, TileBuffer& tile,
                RenderCounters& counters) {
    ++counters.samples;
    if (!is_finite(radiance) || min_component(radiance) < 0.0f) {
        counters.drop(located(job, sample));
        return false;
    }
    tile.pixel(sample.pixel).add(radiance, alpha, sample.weight);
    return true;
}

void accumulate(const TileJob& job, std::span<const CameraSample> samples, const SampleLight& light,
                std::span<const float> alpha, TileBuffer& tile, RenderCounters& counters) {
    offer_brightest(job, samples, light, counters);
    const bool has_layers = !tile.layers().layout().empty();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const bool is_blind = samples[i].is_blind;
        const Rgb radiance = is_blind ? Rgb() : light.radiance(i);
        const float opacity = is_blind ? 0.0f : alpha[i];
        if (accumulate(job, samples[i], radiance, opacity, tile, counters) && has_layers)
            add_to_layers(job, samples[i], i, light, radiance, opacity, tile);
    }
}

}  // namespace etendue
