#include "wave/camera_wave.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {

namespace {

/// Random numbers of a few camera rays, drawn together.
class CameraNumbers {
  public:
    static constexpr std::size_t kCapacity = 64;

    /// Draws a pair of `dimension` for each of the samples, at most kCapacity.
    void draw(SampleSequence sequence, std::span<const CameraSample> samples, std::uint32_t dimension) {
        draw(sequence, samples, dimension, [](SampleKey key) { return key; });
    }
    /// Draws a pair for each of the samples by the key that `key_of` returns for theirs.
    template <typename KeyOf>
    void draw(SampleSequence sequence, std::span<const CameraSample> samples, std::uint32_t dimension,
              const KeyOf& key_of) {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const SampleKey key = key_of(samples[i].key);
            pixel_seeds_[i] = key.pixel_seed;
            indices_[i] = key.index;
        }
        const auto part = [&](auto& all) { return std::span(all).first(samples.size()); };
        sample_2d(sequence, part(pixel_seeds_), part(indices_), dimension, part(x_), part(y_));
    }
    [[nodiscard]] Vec2f operator[](std::size_t i) const { return {x_[i], y_[i]}; }

  private:
    std::array<std::uint32_t, kCapacity> pixel_seeds_;
    std::array<std::uint32_t, kCapacity> indices_;
    std::array<float, kCapacity> x_;
    std::array<float, kCapacity> y_;
};

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

/// Makes the camera rays of at most CameraNumbers::kCapacity samples, whose keys are known, as are their pixels'
/// `positions` in the full image.
void generate_few(const World& world, const TileJob& job, std::span<CameraSample> samples,
                  std::span<const Vec2i> positions, std::span<Ray> rays) {
    const Vec2f to_film{1.0f / static_cast<float>(job.full_width), 1.0f / static_cast<float>(job.full_height)};
    CameraNumbers film;
    CameraNumbers lens;
    CameraNumbers time;
    film.draw(job.sequence, samples, kFilmDimension);
    if (world.traits().has_lens) lens.draw(job.sequence, samples, kLensDimension);
    if (world.traits().has_motion)
        time.draw(job.sequence, samples, kTimeDimension, [&](SampleKey key) { return shared_key(job, key); });
    std::array<Vec2f, CameraNumbers::kCapacity> on_film;
    std::array<Vec2f, CameraNumbers::kCapacity> on_lens;
    std::array<float, CameraNumbers::kCapacity> times;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const PixelFilter::Sample filtered = job.filter->sample(film[i]);
        on_film[i] = {(static_cast<float>(positions[i].x) + 0.5f + filtered.offset.x) * to_film.x,
                      (static_cast<float>(positions[i].y) + 0.5f + filtered.offset.y) * to_film.y};
        on_lens[i] = world.traits().has_lens ? lens[i] : Vec2f(0.0f);
        times[i] = world.traits().has_motion ? time[i].x : 0.0f;
        samples[i].weight = filtered.weight;
        samples[i].lens = on_lens[i];
    }
    const auto part = [&](auto& all) { return std::span(all).first(samples.size()); };
    world.camera().generate_rays(part(on_film), part(on_lens), part(times), rays);
    if (world.traits().has_blind_film)
        for (std::size_t i = 0; i < samples.size(); ++i) samples[i].is_blind = !(rays[i].t_max > 0.0f);
    if (!world.traits().has_transparency) return;
    for (std::size_t i = 0; i < samples.size(); ++i)
        rays[i].alpha_key = sample_bits(samples[i].key, kCameraAlphaDimension);
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
    if (rays.empty()) return;
    const bool by_pixel = order == SampleOrder::PixelByPixel;
    const std::size_t pixels = job.pixels.empty() ? job.rect.area() : job.pixels.size();
    std::size_t which = by_pixel ? first / job.sample_count : first % pixels;
    auto round = static_cast<std::uint32_t>(by_pixel ? first % job.sample_count : first / pixels);
    PixelJob pixel;
    Vec2i position;
    std::uint32_t seed = 0;
    const auto enter_pixel = [&] {
        pixel = job.pixels.empty() ? PixelJob{pixel_in_order(job, static_cast<std::uint32_t>(which)), job.first_sample}
                                   : job.pixels[which];
        position = pixel_position(job, pixel.pixel);
        seed =
            make_pixel_seed(job.seed, static_cast<std::uint32_t>(position.x), static_cast<std::uint32_t>(position.y));
    };
    const auto advance = [&] {
        if (by_pixel) {
            if (++round < job.sample_count) return;
            round = 0;
            ++which;
        } else if (++which == pixels) {
            which = 0;
            ++round;
        }
        enter_pixel();
    };
    enter_pixel();
    std::array<Vec2i, CameraNumbers::kCapacity> positions;
    for (std::size_t begin = 0; begin < rays.size(); begin += CameraNumbers::kCapacity) {
        const auto few = samples.subspan(begin, std::min(CameraNumbers::kCapacity, rays.size() - begin));
        for (std::size_t i = 0; i < few.size(); ++i) {
            if (begin + i > 0) advance();
            positions[i] = position;
            few[i].pixel = pixel.pixel;
            few[i].key = {seed, pixel.first_sample + round};
        }
        generate_few(world, job, few, positions, rays.subspan(begin, few.size()));
    }
}

void generate_camera_rays(const World& world, const TileJob& job, std::span<const Vec2i> positions,
                          std::span<CameraSample> samples, std::span<Ray> rays) {
    for (std::size_t begin = 0; begin < rays.size(); begin += CameraNumbers::kCapacity) {
        const std::size_t count = std::min(CameraNumbers::kCapacity, rays.size() - begin);
        generate_few(world, job, samples.subspan(begin, count), positions.subspan(begin, count),
                     rays.subspan(begin, count));
    }
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
