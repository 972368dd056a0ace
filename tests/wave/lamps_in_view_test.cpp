// Lamps that camera rays meet: whether pixels show what their filters ask for, with how much noise, and that each
// sample of a pixel is the same whatever is rendered beside it.
#include "wave/lamps_in_view.h"

#include "integrator/bdpt/bdpt_integrator.h"
#include "render/render.h"
#include "render/whole_image.h"
#include "world/test_scene.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kLampSide = 10;  // pixels
constexpr float kLampRadiance = 1000.0f;

/// Metres; the second one is cut by the border of the image.
const Vec3f kInTheMiddle{0.031f, -0.042f, -2.0f};
const Vec3f kAtTheBorder{-0.79f, -0.042f, -2.0f};

/// A rectangular lamp in the dark, which covers some four by three pixels, none of whose borders are pixels'.
SceneDesc lamp_in_the_dark(const Vec3f& middle = kInTheMiddle) {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = kLampSide;
    scene.settings.film.height = kLampSide;
    add_object(scene, quad(middle, {0.37f, 0, 0}, {0, 0.29f, 0}), add_material(scene, emissive(Rgb(kLampRadiance))));
    return scene;
}

/// Where the lamp begins and ends along one axis of the film, pixels.
struct Span {
    double begin;
    double end;
};

std::array<Span, 2> lamp_on_film(const World& world, const Vec3f& middle = kInTheMiddle) {
    const auto on_film = [&](const Vec3f& point) { return world.camera().connect(point, {0.5f, 0.5f}, 0.0f).film; };
    const Vec2f a = on_film(middle + Vec3f(-0.37f, 0.29f, 0.0f));
    const Vec2f b = on_film(middle + Vec3f(0.37f, -0.29f, 0.0f));
    constexpr double kPixels = kLampSide;
    return {Span{static_cast<double>(a.x) * kPixels, static_cast<double>(b.x) * kPixels},
            Span{static_cast<double>(a.y) * kPixels, static_cast<double>(b.y) * kPixels}};
}

/// Along one axis, of what `lamp` brings to a pixel: its mean, and the second moment of one sample of each density.
struct Moments {
    double mean = 0.0;
    double square = 0.0;
};

Moments moments_of(const PixelFilter& filter, const Span& lamp, int pixel) {
    constexpr int kSteps = 40'000;
    Moments moments;
    const double step = (lamp.end - lamp.begin) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
        const double x = lamp.begin + (i + 0.5) * step - pixel - 0.5;
        const auto value = static_cast<double>(filter.evaluate(static_cast<float>(x)));
        if (value == 0.0) continue;
        double density = 0.0;
        for (const int beside : {-1, 0, 1})
            if (pixel + beside >= 0 && pixel + beside < kLampSide)
                density += static_cast<double>(filter.pdf(static_cast<float>(x) - static_cast<float>(beside)));
        moments.mean += value * step;
        moments.square += value * value / density * step;
    }
    return moments;
}

RenderResult render_lamp(const World& world, const Integrator& integrator, const RenderOptions& options) {
    const ThreadPool threads(2);
    const std::atomic<bool> stop{false};
    return render(world, integrator, options, threads, stop, {});
}

struct LampCase {
    std::string name;
    std::string integrator;
    FilterShape shape;
    float radius;
};

class LampsInViewTest : public testing::TestWithParam<LampCase> {};

// The bound of an estimate of nine densities is 5 standard errors of independent samples; it holds for all of some
// 1,200 pixels with a probability of 99.9%. A pixel's own samples alone are far beyond it beside the lamp: they have
// the second moment of the filter, not that of its square.
TEST_P(LampsInViewTest, PixelsShowTheFiltersIntegralWithTheNoiseOfNineDensities) {
    const auto& [name, integrator, shape, radius] = GetParam();
    constexpr std::uint32_t kSamples = 2048;
    RenderOptions options = whole_image(kLampSide, kLampSide, kSamples, 3);
    options.sequence = SampleSequence::Random;
    options.filter = PixelFilter(shape, radius);
    for (const Vec3f& middle : {kInTheMiddle, kAtTheBorder}) {
        const World world = compile(lamp_in_the_dark(middle));
        const std::vector<float> image = render_lamp(world, *make_integrator(integrator, {}), options).film.resolve();
        const auto [columns, rows] = lamp_on_film(world, middle);
        for (int y = 0; y < kLampSide; ++y)
            for (int x = 0; x < kLampSide; ++x) {
                const Moments along_x = moments_of(options.filter, columns, x);
                const Moments along_y = moments_of(options.filter, rows, y);
                const double bound = 5.0 * std::sqrt(along_x.square * along_y.square / kSamples) + 2e-5;
                const float found = image[4 * static_cast<std::size_t>(y * kLampSide + x)] / kLampRadiance;
                EXPECT_NEAR(static_cast<double>(found), along_x.mean * along_y.mean, bound) << x << ", " << y;
            }
    }
}

INSTANTIATE_TEST_SUITE_P(Integrators, LampsInViewTest,
                         testing::Values(LampCase{"path", "path", FilterShape::BlackmanHarris, 0.0f},
                                         LampCase{"naive", "naive", FilterShape::BlackmanHarris, 0.0f},
                                         LampCase{"direct", "direct", FilterShape::BlackmanHarris, 0.0f},
                                         LampCase{"whitted", "whitted", FilterShape::BlackmanHarris, 0.0f},
                                         LampCase{"bdpt", "bdpt", FilterShape::BlackmanHarris, 0.0f},
                                         LampCase{"light", "light", FilterShape::BlackmanHarris, 0.0f},
                                         LampCase{"Gaussian", "path", FilterShape::Gaussian, 0.0f},
                                         LampCase{"WideBox", "path", FilterShape::Box, 1.0f},
                                         LampCase{"WideBlackmanHarris", "path", FilterShape::BlackmanHarris, 2.5f},
                                         LampCase{"NarrowBlackmanHarris", "path", FilterShape::BlackmanHarris, 0.75f}),
                         [](const auto& each) { return each.param.name; });

TEST(LampsInView, ALampThatFillsThePixelsHasNoNoise) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -1}, {9, 0, 0}, {0, 9, 0}), add_material(scene, emissive(Rgb(4.0f, 2.0f, 1.0f))));
    const World world = compile(std::move(scene));
    for (const char* integrator : {"path", "whitted"}) {
        const std::vector<float> image =
            render_lamp(world, *make_integrator(integrator, {}), whole_image(4, 4, 1)).film.resolve();
        for (std::size_t i = 0; i < image.size(); i += 4) EXPECT_NEAR(image[i], 4.0f, 1e-5f) << integrator;
    }
}

/// Sums of pixels of one tile after a job.
std::vector<double> sums_of(const World& world, const TileJob& job) {
    const auto integrator = make_integrator("path", {});
    const auto scratch = integrator->make_scratch();
    TileBuffer tile;
    tile.reset(job.rect);
    RenderCounters counters;
    integrator->render_tile(world, job, *scratch, tile, counters);
    std::vector<double> sums;
    for (std::size_t i = 0; i < job.rect.area(); ++i) sums.push_back(tile.pixel(i).r);
    return sums;
}

// As adaptive passes, crops and ranges of samples take them.
TEST(LampsInView, ASampleIsTheSameWhateverItsNeighboursTake) {
    const World world = compile(lamp_in_the_dark());
    const PixelFilter filter(FilterShape::BlackmanHarris);
    constexpr std::uint32_t kFirst = 3;
    constexpr std::uint32_t kCount = 5;
    TileJob all{{0, 0, kLampSide, kLampSide}, {},     kLampSide, kLampSide, kFirst, kCount, 7,
                SampleSequence::Sobol,        &filter};
    const std::vector<double> whole = sums_of(world, all);
    EXPECT_GT(std::ranges::count_if(whole, [](double sum) { return sum > 0.0; }), 20);
    TileJob some = all;
    std::vector<PixelJob> pixels;
    for (std::uint32_t p = 0; p < whole.size(); p += 3) pixels.push_back({p, kFirst});
    some.pixels = pixels;
    const std::vector<double> part = sums_of(world, some);
    for (std::size_t p = 0; p < whole.size(); ++p) EXPECT_EQ(part[p], p % 3 == 0 ? whole[p] : 0.0) << p;
    // Neighbours are two samples ahead of each other.
    std::vector<double> added(whole.size(), 0.0);
    for (std::uint32_t pass = 0; pass < kCount; ++pass) {
        pixels.clear();
        for (std::uint32_t p = 0; p < whole.size(); ++p) pixels.push_back({p, kFirst + (pass + 2 * (p % 7)) % kCount});
        some.pixels = pixels;
        some.sample_count = 1;
        const std::vector<double> one = sums_of(world, some);
        for (std::size_t p = 0; p < whole.size(); ++p) added[p] += one[p];
    }
    for (std::size_t p = 0; p < whole.size(); ++p) EXPECT_NEAR(added[p], whole[p], 1e-12 * whole[p]) << p;
    // A crop of one pixel.
    for (const std::size_t p : {std::size_t{33}, std::size_t{46}, std::size_t{0}}) {
        TileJob one = all;
        const int x = static_cast<int>(p) % kLampSide;
        const int y = static_cast<int>(p) / kLampSide;
        one.rect = {x, y, x + 1, y + 1};
        EXPECT_EQ(sums_of(world, one).front(), whole[p]) << p;
    }
}

TEST(LampsInView, AreAmongTheBrightestBesideThem) {
    const World world = compile(lamp_in_the_dark());
    RenderOptions options = whole_image(kLampSide, kLampSide, 16, 1);
    options.brightest = 6;
    const RenderResult result = render_lamp(world, *make_integrator("path", {}), options);
    const auto samples = result.counters.brightest.samples();
    ASSERT_EQ(samples.size(), options.brightest);
    const auto [columns, rows] = lamp_on_film(world);
    for (const BrightSample& sample : samples) {
        EXPECT_EQ(std::string(sample.word.data()), "C O");
        EXPECT_EQ(sample.s, 0);
        EXPECT_EQ(sample.t, 2);
        EXPECT_EQ(sample.edges, 1);
        const auto within = [](const Span& lamp, int pixel) {
            return lamp.begin < pixel + 0.5 && pixel + 0.5 < lamp.end;
        };
        EXPECT_FALSE(within(columns, sample.x) && within(rows, sample.y)) << "its middle shows the lamp";
    }
}

/// Mean of red over the image of lamps by bdpt.
double mean_lamp(const World& world, std::optional<Strategy> only, bool is_weighted, std::uint32_t seed) {
    IntegratorSettings options;
    options.lengths = {.max_depth = 1};
    options.strategy = only;
    options.weighted = is_weighted;
    options.merging.at = MergeAt::Nothing;
    const std::vector<float> image =
        render_lamp(world, BdptIntegrator(options), whole_image(kLampSide, kLampSide, 64, seed)).film.resolve();
    double sum = 0.0;
    for (std::size_t i = 0; i < image.size(); i += 4) sum += static_cast<double>(image[i]);
    return sum / (kLampSide * kLampSide);
}

// 64 samples of all pixels, well spread: measured, each is within 0.3% of the truth.
TEST(LampsInView, BothStrategiesOfBdptSeeTheSameLamp) {
    const World world = compile(lamp_in_the_dark());
    const auto [columns, rows] = lamp_on_film(world);
    const double truth = static_cast<double>(kLampRadiance) * (columns.end - columns.begin) * (rows.end - rows.begin) /
                         (kLampSide * kLampSide);
    for (const Strategy& strategy : {Strategy{0, 2}, Strategy{1, 1}})
        EXPECT_NEAR(mean_lamp(world, strategy, false, 5) / truth, 1.0, 0.01) << strategy.s << "," << strategy.t;
    EXPECT_NEAR(mean_lamp(world, std::nullopt, true, 5) / truth, 1.0, 0.01);
}

TEST(LampsInView, WeightedStrategiesOfBdptAddUpToTheLamp) {
    const World world = compile(lamp_in_the_dark());
    const double eye = mean_lamp(world, Strategy{0, 2}, true, 9);
    const double light = mean_lamp(world, Strategy{1, 1}, true, 9);
    EXPECT_GT(eye, 0.0);
    EXPECT_GT(light, 0.0);
    EXPECT_NEAR((eye + light) / mean_lamp(world, std::nullopt, true, 9), 1.0, 1e-5);
}

TEST(LampsInView, TilesThatNoLampLiesBehindAreLeftOut) {
    const World world = compile(lamp_in_the_dark());
    EXPECT_TRUE(world.camera().may_show_lamps({0.0f, 0.0f}, {1.0f, 1.0f}));
    EXPECT_TRUE(world.camera().may_show_lamps({0.5f, 0.5f}, {0.51f, 0.51f}));
    EXPECT_FALSE(world.camera().may_show_lamps({0.0f, 0.0f}, {0.2f, 1.0f}));
    EXPECT_FALSE(world.camera().may_show_lamps({0.0f, 0.0f}, {1.0f, 0.2f}));
    EXPECT_FALSE(world.camera().may_show_lamps({0.8f, 0.0f}, {1.2f, 1.0f}));
    EXPECT_FALSE(world.camera().may_show_lamps({0.0f, 0.8f}, {1.0f, 1.2f}));
}

}  // namespace

}  // namespace etendue::test
