#include "wave/lamps_in_view.h"

#include "core/vector_bytes.h"
#include "sampling/hash.h"
#include "transport/scattered_cone.h"
#include "wave/one_kind_tracer.h"
#include "wave/profile/wave_profile.h"
#include "wave/ray_batch.h"
#include "world/motion.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

namespace etendue {

namespace {

/// Pixels to each side whose samples are taken into account.
constexpr int kReach = 1;
/// Offsets of neighbours' neighbours, which densities are asked for.
constexpr int kOffsets = 4 * kReach + 1;

/// Most of the ratio of the brightest to the darkest middle of pixels that keep to their own samples.
constexpr float kEven = 2.0f;

[[nodiscard]] PixelRect grown(const PixelRect& rect, int by) {
    return {rect.x0 - by, rect.y0 - by, rect.x1 + by, rect.y1 + by};
}

/// Index of `pixel` in `rect`, row by row.
[[nodiscard]] std::size_t index_in(const PixelRect& rect, const Vec2i& pixel) {
    return static_cast<std::size_t>(pixel.y - rect.y0) * static_cast<std::size_t>(rect.width()) +
           static_cast<std::size_t>(pixel.x - rect.x0);
}

/// Calls `visit` for all pixels of `rect`, row by row.
template <typename Visit>
void for_each_pixel(const PixelRect& rect, const Visit& visit) {
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x) visit(Vec2i(x, y));
}

/// Returns where `sample` falls on the film, pixels from the middle of its pixel.
[[nodiscard]] Vec2f film_offset(const TileJob& job, const CameraSample& sample) {
    return job.filter->sample(sample_2d(job.sequence, sample.key, kFilmDimension)).offset;
}

[[nodiscard]] PixelRect neighbours(const Vec2i& pixel) {
    return grown({pixel.x, pixel.y, pixel.x + 1, pixel.y + 1}, kReach);
}

/// True if a pixel shows, and shows better, what its neighbours' samples have met.
[[nodiscard]] bool reaches_neighbours(const PixelFilter& filter) {
    return filter.radius() > 0.5f && !filter.has_negative_parts();
}

/// False if no sample of the job's pixels and their neighbours can meet a lamp.
[[nodiscard]] bool may_see_lamps(const World& world, const TileJob& job) {
    constexpr float kRounding = 1.0f;  // pixels
    const float reach = static_cast<float>(kReach) + job.filter->radius() + kRounding;
    const auto corner = [&](int x, int y, float beside) {
        return on_film(job, Vec2f(static_cast<float>(x) + beside, static_cast<float>(y) + beside));
    };
    return world.camera().may_show_lamps(corner(job.rect.x0, job.rect.y0, -reach),
                                         corner(job.rect.x1, job.rect.y1, reach));
}

/// Along one axis, how a place on the film is seen by the pixels around the one whose sample fell there.
class AlongAxis {
  public:
    /// The place is `offset` pixels from the middle of the pixel whose sample it is.
    AlongAxis(const PixelFilter& filter, float offset) {
        std::array<float, kOffsets> densities{};
        for (int i = 0; i < kOffsets; ++i)
            densities[static_cast<std::size_t>(i)] = filter.pdf(offset - static_cast<float>(i - 2 * kReach));
        for (std::size_t i = 0; i < scales_.size(); ++i) {
            float density = 0.0f;
            for (std::size_t k = i; k < i + scales_.size(); ++k) density += densities[k];
            const float value = filter.evaluate(offset - static_cast<float>(static_cast<int>(i) - kReach));
            scales_[i] = density > 0.0f ? value / density : 0.0f;
        }
    }
    /// The filter of the pixel `offset` beside that of the sample, over the density of all of its neighbours' samples.
    [[nodiscard]] float scale(int offset) const {
        const int index = kReach + offset;
        return scales_[static_cast<std::size_t>(index)];
    }

  private:
    std::array<float, 2 * kReach + 1> scales_{};
};

}  // namespace

bool LampsInView::is_lamp(const World& world, const Hit& hit) {
    // What touches other surfaces is told by whoever goes on from there.
    if (!hit.valid() || hit.in_contact) return false;
    const Material& material = *world.materials().at(hit);
    return material.emits && material.lights_camera();
}

void LampsInView::start(const World& world, const TileJob& job, const PathLengths& lengths, bool filters_textures,
                        Share share) {
    world_ = &world;
    job_ = &job;
    filters_textures_ = filters_textures;
    share_ = std::move(share);
    const bool is_spelled = job.aovs != nullptr && job.aovs->speller != nullptr;
    const std::optional<Interior>& around = world.media().camera_interior();
    is_active_ = reaches_neighbours(*job.filter) && around && around->is_empty() && lengths.min_depth <= 1 &&
                 !is_spelled && may_see_lamps(world, job);
    met_.clear();
    found_.clear();
    lengths_ = lengths;
    images_ = job.lamp_images;
    if (!is_active_ && images_ == nullptr) return;
    around_ = grown(job.rect, kReach);
    first_samples_.assign(job.rect.area(), job.pixels.empty() ? job.first_sample : kNone);
    for (const PixelJob& pixel : job.pixels) first_samples_[pixel.pixel] = pixel.first_sample;
    if (job.aovs != nullptr && job.aovs->layout.has_moments) found_.assign(job.rect.area() * job.sample_count, {});
    words_.reset(job.aovs);
}

std::size_t LampsInView::bytes() const {
    return vector_bytes(first_samples_, met_, found_, middles_, asks_for_middle_, is_even_, positions_, samples_, rays_,
                        hits_, film_, shares_, seen_);
}

SurfacePoint LampsInView::surface_point(const Ray& ray, const Hit& hit) const {
    const bool has_cone = filters_textures_ && world_->traits().has_textures;
    return world_->geometry().surface_point(
        hit, ray, has_cone ? camera_cone(*world_, job_->full_width, job_->full_height, ray) : RayCone{});
}

Vec2f LampsInView::film_position(const CameraSample& sample) const {
    const Vec2i pixel = pixel_position(*job_, sample.pixel);
    return Vec2f(static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f) + film_offset(*job_, sample);
}

bool LampsInView::has_sample(const Vec2i& pixel, std::uint32_t sample) const {
    if (!job_->rect.contains(pixel.x, pixel.y)) return false;
    const std::uint32_t first = first_samples_[index_in(job_->rect, pixel)];
    return first != kNone && sample >= first && sample - first < job_->sample_count;
}

void LampsInView::note(std::span<const CameraSample> samples, std::span<const Ray> rays, std::span<const Hit> hits,
                       RenderCounters& counters) {
    if (!is_active_) return;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (is_lamp(*world_, hits[i]))
            note(samples[i], pixel_position(*job_, samples[i].pixel), rays[i], hits[i], &counters);
}

void LampsInView::note(const CameraSample& sample, const Vec2i& pixel, const Ray& ray, const Hit& hit,
                       RenderCounters* counters) {
    const SurfacePoint point = surface_point(ray, hit);
    const Rgb emitted = world_->materials().emission(point, -ray.direction);
    if (is_black(emitted)) return;
    const Rgb light = share_ ? emitted * share_(sample, ray, point) : emitted;
    if (!is_finite(light)) {
        if (counters != nullptr) counters->drop({pixel.x, pixel.y, sample.key.index});
        return;
    }
    shares_.clear();
    if (words_.are_followed()) words_.end_at_camera(words_.surface_source(point), shares_);
    met_.push_back({.pixel = pixel,
                    .sample = sample.key.index,
                    .offset = film_offset(*job_, sample),
                    .light = light,
                    .expressions = shares_.empty() ? ExpressionMask{0} : shares_.front().expressions,
                    .depth = job_->aovs != nullptr && job_->aovs->layout.is_deep
                                 ? world_->camera().depth(point.position, ray.time)
                                 : 0.0f});
}

void LampsInView::note_radiance(std::span<const CameraSample> samples, const SampleLight& light) {
    if (found_.empty()) return;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Rgb& radiance = light.radiance(i);
        if (!samples[i].is_blind && is_finite(radiance) && min_component(radiance) >= 0.0f)
            found_by(samples[i].pixel, samples[i].key.index) = radiance;
    }
}

Rgb& LampsInView::found_by(std::uint32_t pixel, std::uint32_t sample) {
    return found_[std::size_t{pixel} * job_->sample_count + (sample - first_samples_[pixel])];
}

void LampsInView::trace_neighbours(RenderCounters& counters) {
    positions_.clear();
    samples_.clear();
    std::vector<std::uint32_t> needed;
    for_each_pixel(around_, [&](const Vec2i& pixel) {
        // Of most tiles, all that is missing is beside them.
        if (job_->pixels.empty() && job_->rect.contains(pixel.x, pixel.y)) return;
        needed.clear();
        for_each_pixel(intersection(neighbours(pixel), job_->rect), [&](const Vec2i& target) {
            const std::uint32_t first = first_samples_[index_in(job_->rect, target)];
            if (first != kNone && std::ranges::find(needed, first) == needed.end()) needed.push_back(first);
        });
        std::ranges::sort(needed);
        const std::uint32_t seed =
            make_pixel_seed(job_->seed, static_cast<std::uint32_t>(pixel.x), static_cast<std::uint32_t>(pixel.y));
        std::uint32_t next = 0;
        for (const std::uint32_t first : needed)
            for (next = std::max(next, first); next < first + job_->sample_count; ++next) {
                if (has_sample(pixel, next)) continue;
                positions_.push_back(pixel);
                samples_.push_back({.key = {seed, next}});
            }
    });
    if (samples_.empty()) return;
    rays_.resize(samples_.size());
    hits_.resize(samples_.size());
    generate_camera_rays(*world_, *job_, positions_, samples_, rays_);
    intersect_batch(*world_, *job_, RayKind::LampInView, rays_, hits_, counters);
    hide_unseen_hits(*world_, rays_, hits_);
    for (std::size_t i = 0; i < samples_.size(); ++i)
        if (is_lamp(*world_, hits_[i])) note(samples_[i], positions_[i], rays_[i], hits_[i], nullptr);
}

void LampsInView::look_at_middles(RenderCounters& counters) {
    asks_for_middle_.assign(around_.area(), 0);
    for (const Met& met : met_)
        for_each_pixel(intersection(grown(neighbours(met.pixel), kReach), around_),
                       [&](const Vec2i& pixel) { asks_for_middle_[index_in(around_, pixel)] = 1; });
    positions_.clear();
    for_each_pixel(around_, [&](const Vec2i& pixel) {
        if (asks_for_middle_[index_in(around_, pixel)] != 0) positions_.push_back(pixel);
    });
    const std::size_t count = positions_.size();
    film_.clear();
    for (const Vec2i& pixel : positions_)
        film_.push_back(on_film(*job_, {static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f}));
    const std::vector<Vec2f> lens(count, Vec2f(0.5f, 0.5f));
    const std::vector<float> times(count, kMidShutter);
    rays_.assign(count, {});
    hits_.resize(count);
    world_->camera().generate_rays(film_, lens, times, rays_);
    intersect_batch(*world_, *job_, RayKind::LampInView, rays_, hits_, counters);
    hide_unseen_hits(*world_, rays_, hits_);
    middles_.assign(around_.area(), 0.0f);
    for (std::size_t i = 0; i < count; ++i)
        if (is_lamp(*world_, hits_[i]))
            middles_[index_in(around_, positions_[i])] =
                max_component(world_->materials().emission(surface_point(rays_[i], hits_[i]), -rays_[i].direction));
    is_even_.clear();
    for_each_pixel(job_->rect, [&](const Vec2i& pixel) { is_even_.push_back(has_even_middles(pixel) ? 1 : 0); });
}

bool LampsInView::has_even_middles(const Vec2i& pixel) const {
    float least = middles_[index_in(around_, pixel)];
    float most = least;
    for_each_pixel(neighbours(pixel), [&](const Vec2i& beside) {
        least = std::min(least, middles_[index_in(around_, beside)]);
        most = std::max(most, middles_[index_in(around_, beside)]);
    });
    return least > 0.0f && most <= kEven * least;
}

void LampsInView::spread(const Met& met, TileBuffer& tile, RenderCounters& counters) {
    // Within a lamp, nothing is asked of the filter.
    std::optional<std::pair<AlongAxis, AlongAxis>> axes;
    for_each_pixel(intersection(neighbours(met.pixel), job_->rect), [&](const Vec2i& pixel) {
        if (!has_sample(pixel, met.sample)) return;
        if (is_even_[index_in(job_->rect, pixel)] != 0) {
            if (pixel == met.pixel) add(met, pixel, met.light, tile);
            return;
        }
        if (!axes) axes.emplace(AlongAxis(*job_->filter, met.offset.x), AlongAxis(*job_->filter, met.offset.y));
        const float scale = axes->first.scale(pixel.x - met.pixel.x) * axes->second.scale(pixel.y - met.pixel.y);
        if (scale == 0.0f) return;
        offer(met, pixel, met.light * scale, counters);
        add(met, pixel, met.light * scale, tile);
    });
}

void LampsInView::offer(const Met& met, const Vec2i& position, const Rgb& light, RenderCounters& counters) const {
    // Where the middle of a pixel shows the lamp, it is as bright in every sample, and no firefly.
    if (max_component(light) < counters.brightest.threshold() || middles_[index_in(around_, position)] > 0.0f) return;
    BrightSample bright{.x = position.x,
                        .y = position.y,
                        .sample_x = met.pixel.x,
                        .sample_y = met.pixel.y,
                        .sample = met.sample,
                        .value = light,
                        .s = 0,
                        .t = 2,
                        .edges = 1};
    constexpr std::string_view kWord = "C O";
    std::ranges::copy(kWord, bright.word.begin());
    counters.brightest.offer(bright);
}

void LampsInView::add(const Met& met, const Vec2i& position, const Rgb& light, TileBuffer& tile) {
    const auto pixel = static_cast<std::uint32_t>(index_in(job_->rect, position));
    PixelSum& sum = tile.pixel(pixel);
    sum.r += static_cast<double>(light.r);
    sum.g += static_cast<double>(light.g);
    sum.b += static_cast<double>(light.b);
    LayerBuffer& layers = tile.layers();
    const LayerLayout& layout = layers.layout();
    if (layout.empty()) return;
    for (ExpressionMask left = met.expressions; left != 0; left &= left - 1)
        layers.add_rgb(pixel, 3 * static_cast<std::size_t>(std::countr_zero(left)), light, 1.0);
    const BucketLayers* const buckets = job_->aovs != nullptr ? &job_->aovs->buckets : nullptr;
    if (buckets != nullptr && buckets->count > 0)
        layers.add_rgb(pixel, 3 * (buckets->first_light + buckets->of(met.sample)), light, 1.0);
    if (layout.is_deep)
        layers.deep().add(pixel, {.front = met.depth,
                                  .back = met.depth,
                                  .r = static_cast<double>(light.r),
                                  .g = static_cast<double>(light.g),
                                  .b = static_cast<double>(light.b)});
    if (found_.empty()) return;
    Rgb& found = found_by(pixel, met.sample);
    layers.grow_moments(pixel, found, light);
    found += light;
}

void LampsInView::sample_images(TileBuffer& tile, RenderCounters& counters) {
    std::uint32_t first = kNone;
    std::uint32_t last = 0;
    for (const std::uint32_t of_pixel : first_samples_)
        if (of_pixel != kNone) {
            first = std::min(first, of_pixel);
            last = std::max(last, of_pixel);
        }
    if (first == kNone) return;
    const std::uint32_t end = last + job_->sample_count;
    OneKindTracer tracer(*world_, *job_, RayKind::LampImage, counters);
    const PixelFilter& filter = *job_->filter;
    const float radius = filter.radius();
    const PixelRect asked = grown(job_->rect, static_cast<int>(std::ceil(radius + 0.5f)));
    const bool is_deep = job_->aovs != nullptr && job_->aovs->layout.is_deep;
    images_->for_each_in(asked, [&](const LampPixels& found, const LampPixel& image) {
        const std::uint32_t seed = hash_u32(make_pixel_seed(job_->seed, static_cast<std::uint32_t>(image.pixel.x),
                                                            static_cast<std::uint32_t>(image.pixel.y)));
        const float share = image.area / static_cast<float>(image.samples());
        for (std::uint32_t index = first; index < end; ++index)
            for (std::uint32_t round = 0; round < image.samples(); ++round) {
                const SampleKey key{seed, index * image.samples() + round};
                const Vec2f film = found.point(image, sample_2d(job_->sequence, key, kFilmDimension));
                const PixelRect around{static_cast<int>(std::floor(film.x - radius - 0.5f)) + 1,
                                       static_cast<int>(std::floor(film.y - radius - 0.5f)) + 1,
                                       static_cast<int>(std::floor(film.x + radius - 0.5f)) + 1,
                                       static_cast<int>(std::floor(film.y + radius - 0.5f)) + 1};
                bool has_looked = false;
                for_each_pixel(intersection(around, job_->rect), [&](const Vec2i& pixel) {
                    if (!has_sample(pixel, index)) return;
                    if (!std::exchange(has_looked, true)) {
                        seen_.clear();
                        look_for_lamps(*world_, branch_through(*world_, *job_, film, key, &tracer), lengths_, words_,
                                       seen_);
                    }
                    const float scale = share * filter.evaluate(film.x - (static_cast<float>(pixel.x) + 0.5f)) *
                                        filter.evaluate(film.y - (static_cast<float>(pixel.y) + 0.5f));
                    if (scale == 0.0f) return;
                    for (const LampSeen& seen : seen_) {
                        const Rgb light = seen.light * scale;
                        add({.pixel = pixel,
                             .sample = index,
                             .offset = {},
                             .light = light,
                             .expressions = seen.expressions,
                             .depth = is_deep ? world_->camera().depth(seen.first_position, seen.time) : 0.0f},
                            pixel, light, tile);
                    }
                });
            }
    });
}

void LampsInView::finish(TileBuffer& tile, RenderCounters& counters) {
    if (images_ != nullptr) sample_images(tile, counters);
    if (is_active_) trace_neighbours(counters);
    if (!met_.empty()) {
        look_at_middles(counters);
        // One order for a pixel's sums, whichever tile or crop its neighbours belong to.
        std::ranges::sort(met_, {}, [](const Met& met) { return std::tuple(met.sample, met.pixel.y, met.pixel.x); });
        for (const Met& met : met_) spread(met, tile, counters);
    }
    stamp(job_->profile, Stage::Emission);
}

}  // namespace etendue
