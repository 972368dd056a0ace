#include "wave/lamps_by_deltas.h"

#include "transport/scattered_cone.h"

#include <algorithm>

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

}  // namespace etendue
