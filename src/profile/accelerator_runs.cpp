#include "profile/accelerator_runs.h"

#include "core/vec.h"
#include "session/interrupt.h"
#include "world/accelerated_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

namespace etendue {

namespace {

/// Limits the time of one kind of rays, s.
constexpr double kSecondsPerKind = 0.5;
/// Sets the rays between two looks at the time.
constexpr std::size_t kChunk = 64;
/// Sets of how many chunks the slowest one is left out.
constexpr std::size_t kSlowestShare = 10;
/// Limits the width of maps of visited nodes, pixels.
constexpr int kMostMapWidth = 480;
/// Limits the triangles of which the growth of brute force is measured: a ray takes a millisecond there.
constexpr std::uint64_t kMostBruteTriangles = 100'000;
constexpr std::size_t kGrowthRays = std::size_t{1} << 15;

/// Holds a few successive rays, the time that tracing them took, and what they met.
struct TracedChunk {
    std::span<const Ray> rays{};
    double seconds = 0.0;
    RayWork work{};
    HitAgreement agreement{};
};

/// One structure over a World, or Embree, which the World has anyway.
class Tracer {
  public:
    Tracer(const World& world, AcceleratorKind kind) : geometry_(world.geometry()) {
        if (kind != AcceleratorKind::Embree) scene_ = geometry_.accelerate(kind);
        const WorldStatistics of_world = world.statistics();
        measure_.name = accelerator_name(kind);
        measure_.triangles = of_world.instanced_triangles;
        measure_.build_seconds = of_world.bvh_build_seconds;
        measure_.bytes = of_world.bvh_bytes;
        if (!scene_) return;
        const AcceleratorStatistics built = scene_->statistics();
        measure_.build_seconds = built.build_seconds;
        measure_.bytes = built.bytes;
        measure_.nodes = built.nodes;
        measure_.references = built.references;
        measure_.depth = built.depth;
    }

    [[nodiscard]] const AcceleratorMeasure& measure() const { return measure_; }
    /// Returns the structure, or null for Embree.
    [[nodiscard]] const AcceleratedScene* scene() const { return scene_.get(); }

    /// Traces as many of `rays` as kSecondsPerKind allows, and then compares their hits with Embree's if `compares`.
    [[nodiscard]] std::vector<TracedChunk> trace(std::span<const Ray> rays, bool occlusion, bool compares) const {
        std::vector<TracedChunk> chunks;
        double sum = 0.0;
        for (std::span<const Ray> left = rays; !left.empty() && sum < kSecondsPerKind;) {
            const auto traced = left.first(std::min(kChunk, left.size()));
            TracedChunk& chunk = chunks.emplace_back(TracedChunk{.rays = traced});
            chunk.seconds = scene_ ? scene_->replay(traced, occlusion, chunk.work)
                                   : geometry_.replay(traced, occlusion, Coherence::Incoherent, QueryForm::Single);
            sum += chunk.seconds;
            left = left.subspan(traced.size());
        }
        if (scene_ && compares)
            for (TracedChunk& chunk : chunks) chunk.agreement = scene_->compare_with_embree(chunk.rays, occlusion);
        return chunks;
    }

  private:
    const SceneGeometry& geometry_;
    std::unique_ptr<const AcceleratedScene> scene_;
    AcceleratorMeasure measure_;
};

/// Returns the rate, rays per second, of the `count` rays of `chunks`, without the slowest chunks: most likely, some
/// other process ran during these.
double undisturbed_rate(std::span<const TracedChunk> chunks, double count) {
    if (chunks.empty()) return 0.0;
    std::vector<double> seconds;
    seconds.reserve(chunks.size());
    for (const TracedChunk& chunk : chunks) seconds.push_back(chunk.seconds);
    std::ranges::sort(seconds);
    const std::size_t kept = std::max<std::size_t>(1, seconds.size() - seconds.size() / kSlowestShare);
    const double share = static_cast<double>(kept) / static_cast<double>(seconds.size());
    const double sum = std::accumulate(seconds.begin(), seconds.begin() + static_cast<std::ptrdiff_t>(kept), 0.0);
    return sum > 0.0 ? share * count / sum : 0.0;
}

/// Sums up what a structure did with the rays of `chunks`. Embree does not tell what it visits.
TracedKind sum_up(std::span<const TracedChunk> chunks, AcceleratorKind kind) {
    TracedKind result;
    RayWork work;
    for (const TracedChunk& chunk : chunks) {
        result.traced.rays += chunk.rays.size();
        work.add(chunk.work);
        result.ties += chunk.agreement.ties;
        result.differ += chunk.agreement.differ;
    }
    const auto count = static_cast<double>(result.traced.rays);
    result.traced.rays_per_second = undisturbed_rate(chunks, count);
    if (kind == AcceleratorKind::Embree || chunks.empty()) return result;
    result.traced.nodes = static_cast<double>(work.nodes) / count;
    result.traced.triangles = static_cast<double>(work.triangles) / count;
    return result;
}

VisitMap map_visits(const World& world, const AcceleratedScene& scene, const std::string& name, int width, int height) {
    const int shown_width = std::min(width, kMostMapWidth);
    const int shown_height =
        std::max(1, static_cast<int>(std::lround(static_cast<double>(height) * shown_width / width)));
    VisitMap map{.name = name, .width = shown_width, .height = shown_height};
    for (int y = 0; y < shown_height; ++y)
        for (int x = 0; x < shown_width; ++x) {
            const Vec2f film((static_cast<float>(x) + 0.5f) / static_cast<float>(shown_width),
                             (static_cast<float>(y) + 0.5f) / static_cast<float>(shown_height));
            RayWork work;
            (void)scene.closest(world.camera().generate_ray(film, {0.5f, 0.5f}, 0.5f), RayEnds::AtCamera, work);
            map.nodes.push_back(static_cast<float>(work.nodes));
            map.triangles.push_back(static_cast<float>(work.triangles));
        }
    return map;
}

/// Returns the height of the hilly ground at a place in [0, 1]².
float ground_height(float x, float z) {
    constexpr float kTurn = 2.0f * kPi;
    return 0.06f * std::sin(kTurn * 2.0f * x) * std::cos(kTurn * 3.0f * z) +
           0.02f * std::sin(kTurn * (11.0f * x + 7.0f * z));
}

/// Makes a ground of about `triangles` triangles, one unit long and wide.
SceneDesc hilly_ground(std::uint64_t triangles) {
    const auto cells = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(triangles) / 2.0)));
    PrimitiveDesc ground;
    for (std::uint32_t row = 0; row <= cells; ++row)
        for (std::uint32_t column = 0; column <= cells; ++column) {
            const float x = static_cast<float>(column) / static_cast<float>(cells);
            const float z = static_cast<float>(row) / static_cast<float>(cells);
            ground.positions.emplace_back(x, ground_height(x, z), z);
        }
    for (std::uint32_t row = 0; row < cells; ++row)
        for (std::uint32_t column = 0; column < cells; ++column) {
            const std::uint32_t corner = row * (cells + 1) + column;
            ground.triangles.push_back({corner, corner + cells + 1, corner + 1});
            ground.triangles.push_back({corner + 1, corner + cells + 1, corner + cells + 2});
        }
    SceneDesc scene;
    scene.name = "hilly ground";
    scene.cameras.emplace_back();
    scene.materials.emplace_back();
    ground.material = {0};
    scene.meshes.emplace_back().primitives.push_back(std::move(ground));
    scene.instances.emplace_back().mesh = {0};
    return scene;
}

/// Makes rays to places on the ground: from far above, as from a camera, and from close to it, as paths go on. The low
/// bits of numbers that are multiples of the golden ratio fill space evenly.
std::vector<Ray> rays_to_ground() {
    std::vector<Ray> rays(kGrowthRays);
    const auto even = [](std::size_t i, double step) {
        const double value = step * static_cast<double>(i);
        return static_cast<float>(value - std::floor(value));
    };
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const float x = even(i, 0.8191725133961645), z = even(i, 0.6710436067037893);
        const Vec3f target(x, ground_height(x, z), z);
        const bool is_far = i % 2 == 0;
        const Vec3f from =
            is_far ? Vec3f(0.5f, 1.0f, 2.0f) : Vec3f(even(i, 0.5497004779019703), 0.15f, even(i, 0.7548776662466927));
        rays[i].origin = from;
        rays[i].direction = normalize(target - from);
    }
    return rays;
}

}  // namespace

std::vector<std::string> accelerator_names() {
    std::vector<std::string> names;
    names.reserve(kAcceleratorNames.size());
    for (const auto& [name, kind] : kAcceleratorNames) names.emplace_back(name);
    return names;
}

std::vector<AcceleratorKind> accelerator_kinds(const std::vector<std::string>& names) {
    std::vector<AcceleratorKind> kinds;
    for (const auto& [name, kind] : kAcceleratorNames)
        if (std::ranges::find(names, name) != names.end()) kinds.push_back(kind);
    return kinds;
}

void require_acceleratable(const World& world, const std::vector<AcceleratorKind>& kinds) {
    // Brute force is built at once, and refuses what the others refuse.
    if (std::ranges::any_of(kinds, [](AcceleratorKind kind) { return kind != AcceleratorKind::Embree; }))
        (void)world.geometry().accelerate(AcceleratorKind::BruteForce);
}

void RecordedRays::add(const WaveProfile& profile) {
    for (std::size_t i = 0; i < kRayKinds; ++i)
        for (const std::vector<Ray>& segment : profile.recorder(static_cast<RayKind>(i)).segments()) {
            if (rays_[i].size() + segment.size() > kMost) break;
            rays_[i].insert(rays_[i].end(), segment.begin(), segment.end());
        }
}

AcceleratorRuns measure_accelerators(const World& world, const std::vector<AcceleratorKind>& kinds,
                                     const RecordedRays& rays, int width, int height) {
    AcceleratorRuns runs;
    std::vector<std::array<std::vector<TracedChunk>, kRayKinds>> traced;  // by structure
    std::array<std::size_t, kRayKinds> common;                            // chunks that all so far have traced
    common.fill(std::numeric_limits<std::size_t>::max() / kChunk);
    for (const AcceleratorKind kind : kinds) {
        const Tracer tracer(world, kind);
        auto& of_structure = traced.emplace_back();
        for (std::size_t i = 0; i < kRayKinds; ++i) {
            const auto ray_kind = static_cast<RayKind>(i);
            runs.interrupted = interrupt_requested().load();
            if (runs.interrupted) return runs;
            const std::span<const Ray> of_kind = rays.of(ray_kind);
            of_structure[i] = tracer.trace(of_kind.first(std::min(of_kind.size(), common[i] * kChunk)),
                                           asks_for_occlusion(ray_kind), true);
            common[i] = of_structure[i].size();
        }
        const AcceleratorMeasure& measure = runs.report.measures.emplace_back(tracer.measure());
        if (measure.nodes > 0) runs.visits.push_back(map_visits(world, *tracer.scene(), measure.name, width, height));
    }
    for (std::size_t i = 0; i < kRayKinds; ++i) {
        if (rays.of(static_cast<RayKind>(i)).empty()) continue;
        for (std::size_t s = 0; s < kinds.size(); ++s) {
            TracedKind& kind = runs.report.measures[s].kinds.emplace_back();
            kind = sum_up(std::span(traced[s][i]).first(common[i]), kinds[s]);
            kind.kind = kRayKindNames[i];
        }
    }
    return runs;
}

std::vector<GrowthPoint> measure_growth(const std::vector<AcceleratorKind>& kinds, std::uint64_t most,
                                        const std::function<World(SceneDesc)>& compile) {
    std::vector<GrowthPoint> points;
    const std::vector<Ray> rays = rays_to_ground();
    for (std::uint64_t triangles = 100; triangles <= most && !interrupt_requested().load(); triangles *= 10) {
        const World world = compile(hilly_ground(triangles));
        for (const AcceleratorKind kind : kinds) {
            if (kind == AcceleratorKind::BruteForce && triangles > kMostBruteTriangles) continue;
            const Tracer tracer(world, kind);
            const AcceleratorMeasure& measure = tracer.measure();
            points.push_back({.name = measure.name,
                              .triangles = measure.triangles,
                              .build_seconds = measure.build_seconds,
                              .bytes = measure.bytes,
                              .traced = sum_up(tracer.trace(rays, false, false), kind).traced});
        }
    }
    return points;
}

}  // namespace etendue
