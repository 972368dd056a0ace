#include "wave/lamp_image_sampler.h"

#include "sampling/hash.h"
#include "transport/scattered_cone.h"
#include "wave/one_kind_tracer.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// Holds what a branch has passed.
struct WayPassed {
    WordRange words;
    Vec3f first_position{0.0f};
    bool has_first = false;
};

/// Collects the lamps that branches meet.
struct LampCollector {
    const World& world;
    const PathLengths& lengths;
    PathWords& words;
    std::vector<LampSeen>& seen;
    std::vector<ExpressionShare> shares{};

    void visit(const DeltaBranch& branch, const WayPassed& way, const Vertex& vertex) {
        const EyePath& path = branch.path;
        if (path.edges < std::max(lengths.min_depth, 2) || vertex.surface.material == nullptr ||
            !vertex.surface.material->emits)
            return;
        const Rgb light = path.throughput * world.materials().emission(vertex.surface, vertex.wo);
        if (is_black(light) || !is_finite(light)) return;
        shares.clear();
        if (words.are_followed()) words.end_at_light(way.words, words.surface_source(vertex.surface), shares);
        Rgb left = Rgb(1.0f);
        for (const ExpressionShare& share : shares) {
            seen.push_back({light * share.share, share.expressions, way.first_position, path.ray.time});
            left -= share.share;
        }
        if (shares.empty() || max_component(left) > 1e-4f)
            seen.push_back({light * left, 0, way.first_position, path.ray.time});
    }
    [[nodiscard]] WayPassed after(WayPassed way, const Vertex& vertex, const BsdfSample& delta) const {
        if (!way.has_first) way.first_position = vertex.position;
        way.has_first = true;
        if (!words.are_followed() || goes_straight_on(*vertex.surface.material, delta)) return way;
        way.words = words.scatter_from_eye(way.words,
                                           surface_event(vertex.scattering(), delta.wi, true, TransportMode::Radiance,
                                                         words.label(world, vertex.surface)));
        return way;
    }
};

/// Returns true if one of the `pixels` takes sample number `index`.
bool takes_any(const PixelRect& pixels, std::uint32_t index, const LampImageSampler::HasSample& has_sample) {
    for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x)
            if (has_sample({x, y}, index)) return true;
    return false;
}

}  // namespace

DeltaBranch branch_along(const World& world, const TileJob& job, const Ray& ray, SampleKey key, SampleTracer* tracer) {
    const EyeSample sample{.ray = ray,
                           .cone = camera_cone(world, job.full_width, job.full_height, ray),
                           .numbers = {job.sequence, key},
                           .tracer = tracer};
    return {begin_at_eye(world, sample), sample.numbers};
}

DeltaBranch branch_through(const World& world, const TileJob& job, const Vec2f& film, SampleKey key,
                           SampleTracer* tracer) {
    const SampleNumbers numbers{job.sequence, key};
    const Vec2f lens = world.traits().has_lens ? numbers.pair(kLensDimension) : Vec2f(0.0f);
    const float time =
        world.traits().has_motion ? SampleNumbers{job.sequence, shared_key(job, key)}.pair(kTimeDimension).x : 0.0f;
    Ray ray = world.camera().generate_ray(on_film(job, film), lens, time);
    ray.alpha_key = numbers.bits(kCameraAlphaDimension);
    return branch_along(world, job, ray, key, tracer);
}

void look_for_lamps(const World& world, const DeltaBranch& branch, const PathLengths& lengths, PathWords& words,
                    std::vector<LampSeen>& seen) {
    const std::size_t words_before = words.size();
    LampCollector collector{world, lengths, words, seen};
    WayPassed start;
    if (words.are_followed()) start.words = words.begin_at_eye();
    follow_deltas(world, branch, start, lengths.max_depth, collector);
    words.shrink_to(words_before);
}

void LampImageSampler::start(const World& world, const TileJob& job, const PathLengths& lengths) {
    world_ = &world;
    job_ = &job;
    lengths_ = lengths;
    images_ = job.lamp_images;
    words_.reset(job.aovs);
}

void LampImageSampler::sample(std::uint32_t first, std::uint32_t end, const HasSample& has_sample, const Add& add,
                              RenderCounters& counters) {
    OneKindTracer tracer(*world_, *job_, RayKind::LampImage, counters);
    const PixelFilter& filter = *job_->filter;
    const float radius = filter.radius();
    const int beyond = static_cast<int>(std::ceil(radius + 0.5f));
    const PixelRect& rect = job_->rect;
    const PixelRect asked{rect.x0 - beyond, rect.y0 - beyond, rect.x1 + beyond, rect.y1 + beyond};
    images_->for_each_in(asked, [&](const LampPixels& found, const LampPixel& image) {
        const std::uint32_t seed = hash_u32(make_pixel_seed(job_->seed, static_cast<std::uint32_t>(image.pixel.x),
                                                            static_cast<std::uint32_t>(image.pixel.y)));
        for (std::uint32_t index = first; index < end; ++index)
            for (std::uint32_t round = 0; round < image.samples(); ++round) {
                const SampleKey key{seed, index * image.samples() + round};
                const Vec2f film = found.point(image, sample_2d(job_->sequence, key, kFilmDimension));
                const PixelRect around{static_cast<int>(std::floor(film.x - radius - 0.5f)) + 1,
                                       static_cast<int>(std::floor(film.y - radius - 0.5f)) + 1,
                                       static_cast<int>(std::floor(film.x + radius - 0.5f)) + 1,
                                       static_cast<int>(std::floor(film.y + radius - 0.5f)) + 1};
                const PixelRect pixels = intersection(around, rect);
                if (!takes_any(pixels, index, has_sample)) continue;
                seen_.clear();
                look_for_lamps(*world_, branch_through(*world_, *job_, film, key, &tracer), lengths_, words_, seen_);
                if (seen_.empty()) continue;
                const float share = image.area / static_cast<float>(image.samples());
                for (int y = pixels.y0; y < pixels.y1; ++y)
                    for (int x = pixels.x0; x < pixels.x1; ++x) {
                        if (!has_sample({x, y}, index)) continue;
                        const float scale = share * filter.evaluate(film.x - (static_cast<float>(x) + 0.5f)) *
                                            filter.evaluate(film.y - (static_cast<float>(y) + 0.5f));
                        if (scale == 0.0f) continue;
                        for (const LampSeen& seen : seen_) add({x, y}, index, seen, seen.light * scale);
                    }
            }
    });
}

}  // namespace etendue
