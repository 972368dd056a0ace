#include "integrator/bdpt/weight_comparison.h"

#include "integrator/bdpt/emitted_ray.h"
#include "integrator/bdpt/made_paths.h"
#include "integrator/bdpt/recursive_weights.h"
#include "integrator/bdpt/reference_weights.h"
#include "wave/subpath/subpath_wave.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr double kTolerance = 1e-4;
constexpr double kRoundingTolerance = 1e-2;
/// Of the angle between an edge and a normal. Below it rounding moves the density of a rough interface near its
/// critical angle, too.
constexpr float kSmallCosine = 0.3f;
/// Of what a short edge is: positions do not tell where it points.
constexpr float kTellsNothing = 0.01f;
/// The same of its height above the surface at either end: positions do not tell its cosine, which of so low an edge
/// their roundings make up by hundredths.
constexpr float kTellsNoCosine = 0.001f;

float shortest_edge(const CompletePath& path) {
    float shortest = length(path.camera.lens - path.inner.back()->position);
    for (std::size_t i = 0; i + 1 < path.inner.size(); ++i)
        shortest = std::min(shortest, length(path.inner[i + 1]->position - path.inner[i]->position));
    return shortest;
}

float least_height(const CompletePath& path) {
    const auto height = [](const WalkedVertex& vertex, const Vec3f& edge) {
        return length(edge) * vertex.cosine(normalize(edge));
    };
    float least = height(*path.inner.back(), path.camera.lens - path.inner.back()->position);
    for (std::size_t i = 0; i + 1 < path.inner.size(); ++i) {
        const Vec3f edge = path.inner[i + 1]->position - path.inner[i]->position;
        least = std::min({least, height(*path.inner[i], edge), height(*path.inner[i + 1], edge)});
    }
    return least;
}

/// Returns whether the path leaves its light along the edge of what lights aim at, where the density of the emission
/// jumps: rounding of the point on the light decides on which side of it the path is.
bool leaves_along_an_edge(const MisContext& mis, const CompletePath& path) {
    if (path.end.light == kNone || mis.world.lights().is_at_infinity(path.end.light)) return false;
    const EmittedRay ray = emitted_ray(mis.world, path);
    EmittedRay rounded = ray;
    const Vec3f& next = path.inner.front()->position;
    rounded.point = next - path.end.direction * length(path.end.position - next);
    const float density = mis.world.emitters().pdf(ray, mis.aims);
    return std::abs(mis.world.emitters().pdf(rounded, mis.aims) / density - 1.0f) > 0.01f;
}

class Comparison {
  public:
    explicit Comparison(float short_edge) : short_edge_(short_edge) {}

    void add(const MisContext& mis, const CompletePath& path, double weight) {
        const std::vector<double> reference = reference_weights(mis, path);
        const std::vector<double> all = recursive_weights(mis, path);
        const double sum = std::accumulate(all.begin(), all.end(), 0.0);
        double error = std::max(std::abs(weight - all[path.s]), std::abs(sum - 1.0));
        for (std::size_t s = 0; s < all.size(); ++s) error = std::max(error, std::abs(all[s] - reference[s]));
        ++paths;
        const auto merging = std::span(reference).subspan(path.inner.size() + 2);
        if (std::ranges::any_of(merging, [](double share) { return share > 0.01; })) ++merged;
        strategies = std::max(strategies, path.inner.size() + 2);
        if (!(error <= kTolerance)) {
            ++different;
            if (is_well_conditioned(path)) ++different_without_excuse;
        }
        if (error <= worst || shortest_edge(path) < kTellsNothing * short_edge_ ||
            least_height(path) < kTellsNoCosine * short_edge_ || leaves_along_an_edge(mis, path))
            return;
        worst = error;
        worst_path = fmt::format(
            "s = {}: {:.6f}; of all strategies and merges: {:.6f}, which sum to {:.6f}; by definition: {:.6f}", path.s,
            weight, fmt::join(all, " "), sum, fmt::join(reference, " "));
    }

    std::size_t paths = 0;
    std::size_t merged = 0;  ///< paths of which merges have a share
    std::size_t different = 0;
    std::size_t different_without_excuse = 0;
    std::size_t strategies = 0;
    double worst = 0.0;
    std::string worst_path;

  private:
    [[nodiscard]] bool is_well_conditioned(const CompletePath& path) const {
        bool is_well = shortest_edge(path) >= short_edge_;
        const auto see = [&](const WalkedVertex& vertex, const Vec3f& edge) {
            is_well = is_well && vertex.cosine(normalize(edge)) >= kSmallCosine;
        };
        for (std::size_t i = 0; i + 1 < path.inner.size(); ++i) {
            const Vec3f edge = path.inner[i + 1]->position - path.inner[i]->position;
            see(*path.inner[i], edge);
            see(*path.inner[i + 1], edge);
        }
        see(*path.inner.front(), path.end.direction);
        see(*path.inner.back(), path.camera.lens - path.inner.back()->position);
        return is_well && std::abs(path.end.cos_light) >= kSmallCosine;
    }

    float short_edge_;
};

}  // namespace

std::size_t expect_right_weights(const World& world, PathLengths lengths, Heuristic heuristic, MergeAt merge,
                                 std::span<const TileJob> jobs, std::size_t paths, float short_edge) {
    Comparison comparison(short_edge);
    lengths.min_depth = 1;
    const IntegratorSettings settings{.lengths = lengths, .heuristic = heuristic};
    for (std::uint32_t seed = 0; comparison.paths < paths; ++seed) {
        TileJob job = jobs[seed % jobs.size()];
        job.seed = seed;
        job.merging = make_merging(world, job.full_width, job.full_height, static_cast<double>(job.window.area()), 0,
                                   {.at = merge});
        const MisContext mis = mis_context(world, job, settings);
        const std::size_t before = comparison.paths;
        for_each_path(world, job, settings,
                      [&](const CompletePath& path, double weight) { comparison.add(mis, path, weight); });
        if (comparison.paths > before) continue;
        ADD_FAILURE() << "samples without paths";
        return 0;
    }
    EXPECT_LE(comparison.different_without_excuse, comparison.paths / 10'000) << comparison.worst_path;
    // Paths through glasses in glasses, at which lights aim, have refractions enough to make rounding large.
    EXPECT_LE(comparison.different, comparison.paths / 200) << comparison.worst_path;
    if (merge != MergeAt::Nothing) {
        EXPECT_GE(comparison.merged, comparison.paths / 10'000 + 1);
    }
    EXPECT_LE(comparison.worst, kRoundingTolerance) << comparison.worst_path;
    return comparison.strategies;
}

}  // namespace etendue::test
