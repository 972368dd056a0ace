// The recursion of the weights against their definition, over the paths of rooms with every kind of light, material
// and camera.
#include "integrator/agreement_cases.h"
#include "integrator/bdpt/bdpt_integrator.h"
#include "integrator/bdpt/reference_weights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr double kTolerance = 1e-4;
/// Where vertices are close to each other or edges graze a surface, positions in single precision tell directions and
/// cosines less exactly than the walk knew them; so does the density of a rough interface near its critical angle.
constexpr float kShortEdge = 0.1f;
constexpr float kSmallCosine = 0.3f;
constexpr double kRoundingTolerance = 1e-2;

bool is_well_conditioned(const CompletePath& path) {
    bool is_well = true;
    const auto see = [&](const PathVertex& vertex, const Vec3f& edge) {
        const float distance = length(edge);
        is_well = is_well && distance >= kShortEdge && vertex.cosine(edge / distance) >= kSmallCosine;
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

class Comparison final : public WeightObserver {
  public:
    void on_weight(const CompletePath& path, double weight, std::span<const double> reference) override {
        const double error = std::abs(weight - reference[path.s]);
        ++paths;
        strategies = std::max(strategies, reference.size());
        if (!(error <= kTolerance)) {
            ++different;
            if (is_well_conditioned(path)) ++different_without_excuse;
        }
        if (error <= worst) return;
        worst = error;
        worst_path = "s = " + std::to_string(path.s) + " of " + std::to_string(reference.size()) +
                     " strategies: " + std::to_string(weight) + ", by definition " + std::to_string(reference[path.s]);
    }

    std::size_t paths = 0;
    std::size_t different = 0;
    std::size_t different_without_excuse = 0;
    std::size_t strategies = 0;
    double worst = 0.0;
    std::string worst_path;
};

class BdptWeights : public testing::TestWithParam<AgreementCase> {};

TEST_P(BdptWeights, RecursionSaysWhatTheDefinitionSays) {
    constexpr std::size_t kPaths = 100'000;
    const World world = agreement_world(GetParam());
    const PixelFilter filter(FilterShape::Box);
    for (const Heuristic heuristic : {Heuristic::Power, Heuristic::Balance}) {
        Comparison comparison;
        BdptOptions options{.lengths = GetParam().lengths, .heuristic = heuristic};
        options.lengths.min_depth = 1;
        options.observer = &comparison;
        const BdptIntegrator integrator(options);
        const auto scratch = integrator.make_scratch();
        const PixelRect all{0, 0, kAgreementWidth, kAgreementHeight};
        RenderCounters counters;
        for (std::uint32_t seed = 0; comparison.paths < kPaths / 2; ++seed) {
            const TileJob job{all, all, all.x1, all.y1, 0, 1, seed, SampleSequence::Sobol, &filter};
            TileBuffer tile;
            tile.reset(all);
            integrator.render_tile(world, job, *scratch, tile, counters);
        }
        EXPECT_LE(comparison.different_without_excuse, comparison.paths / 10'000) << comparison.worst_path;
        EXPECT_LE(comparison.different, comparison.paths / 400) << comparison.worst_path;
        EXPECT_LE(comparison.worst, kRoundingTolerance) << comparison.worst_path;
        EXPECT_GE(comparison.strategies, 4u);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, BdptWeights, testing::ValuesIn(agreement_cases()),
                         [](const auto& agreement) { return agreement.param.name; });

}  // namespace

}  // namespace etendue::test
