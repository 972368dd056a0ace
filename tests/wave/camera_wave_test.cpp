#include "wave/camera_wave.h"

#include "wave/aov/aov_set.h"
#include "world/test_scene.h"

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

class CameraWave : public testing::Test {
  protected:
    void generate(std::size_t first, std::size_t count) {
        samples_.resize(count);
        rays_.resize(count);
        generate_camera_rays(world_, job_, first, samples_, rays_);
    }

    World world_ = compile(empty_scene());
    PixelFilter filter_{FilterShape::Box};
    TileJob job_{{10, 20, 15, 24}, {0, 0, 40, 30}, 40, 30, 3, 6, 9, SampleSequence::Sobol, &filter_};
    std::vector<CameraSample> samples_;
    std::vector<Ray> rays_;
};

TEST_F(CameraWave, EveryPixelGetsEachOfItsSamplesOnce) {
    generate(0, camera_sample_count(job_));
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    for (const CameraSample& s : samples_) {
        EXPECT_LT(s.pixel, job_.rect.area());
        EXPECT_GE(s.key.index, 3u);
        EXPECT_LT(s.key.index, 9u);
        EXPECT_TRUE(seen.emplace(s.pixel, s.key.index).second);
        // All of one pixel after those of another, of four rows column by column.
        const std::size_t which = (seen.size() - 1) / 6;
        EXPECT_EQ(s.pixel, which % 4 * 5 + which / 4);
    }
    EXPECT_EQ(seen.size(), job_.rect.area() * 6);
}

TEST_F(CameraWave, SampleBySampleTheSameSamplesComeInAnotherOrder) {
    generate(0, camera_sample_count(job_));
    const std::vector<CameraSample> by_pixel = samples_;
    const std::vector<Ray> all = rays_;
    const std::size_t pixels = job_.rect.area();
    generate_camera_rays(world_, job_, 0, samples_, rays_, SampleOrder::SampleBySample);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        const std::size_t same = i % pixels * 6 + i / pixels;
        EXPECT_EQ(samples_[i].pixel, by_pixel[same].pixel);
        EXPECT_EQ(samples_[i].key.index, by_pixel[same].key.index);
        EXPECT_EQ(rays_[i].direction, all[same].direction);
    }
    // From the middle on.
    const CameraSample later = samples_[pixels + 3];
    generate_camera_rays(world_, job_, pixels + 3, std::span(samples_).first(1), std::span(rays_).first(1),
                         SampleOrder::SampleBySample);
    EXPECT_EQ(samples_[0].pixel, later.pixel);
    EXPECT_EQ(samples_[0].key.index, later.key.index);
}

TEST_F(CameraWave, OnlyChosenPixelsGetSamplesEachItsOwn) {
    generate(0, camera_sample_count(job_));
    const std::vector<Ray> all = rays_;
    const std::vector<PixelJob> chosen{{7, 5}, {19, 3}, {2, 100}};
    job_.pixels = chosen;
    job_.sample_count = 2;
    ASSERT_EQ(camera_sample_count(job_), 6u);
    generate(0, 6);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(samples_[i].pixel, chosen[i / 2].pixel);
        EXPECT_EQ(samples_[i].key.index, chosen[i / 2].first_sample + i % 2);
    }
    // The rays that all pixels together got with these indices, from 3 on; pixel 7 of five a row is their tenth.
    EXPECT_EQ(rays_[0].direction, all[9 * 6 + 2].direction);
    EXPECT_EQ(rays_[3].direction, all[19 * 6 + 1].direction);
}

TEST_F(CameraWave, RaysPassThroughTheirPixels) {
    generate(0, camera_sample_count(job_));
    const Mat4f to_screen = world_to_screen(world_.camera().model()).value();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        Vec3f screen;
        to_screen.multVecMatrix(rays_[i].origin + rays_[i].direction, screen);
        const float x = (screen.x + 1.0f) * 0.5f * 40.0f;
        const float y = (1.0f - screen.y) * 0.5f * 30.0f;
        const auto left = static_cast<float>(10 + samples_[i].pixel % 5);
        const int row = static_cast<int>(samples_[i].pixel) / 5;
        const auto top = static_cast<float>(20 + row);
        EXPECT_TRUE(x >= left - 1e-3f && x <= left + 1.0f + 1e-3f) << x << " in pixel " << left;
        EXPECT_TRUE(y >= top - 1e-3f && y <= top + 1.0f + 1e-3f) << y << " in pixel " << top;
    }
}

TEST_F(CameraWave, SamplesDoNotDependOnWavesOrTiles) {
    generate(0, camera_sample_count(job_));
    const std::vector<Ray> all = rays_;
    generate(37, 20);
    for (std::size_t i = 0; i < 20; ++i) {
        EXPECT_EQ(rays_[i].direction, all[37 + i].direction);
        EXPECT_EQ(rays_[i].alpha_key, all[37 + i].alpha_key);
    }
    // The same pixel in another tile: pixel (12, 21) is the tenth of the first and the first of the second.
    job_.rect = {12, 21, 14, 22};
    generate(0, 1);
    EXPECT_EQ(rays_[0].direction, all[9 * 6].direction);
    EXPECT_EQ(rays_[0].alpha_key, all[9 * 6].alpha_key);
}

// Film, lens, time and what transparent surfaces are asked with are drawn from numbers of their own. Of 4096 unrelated
// pairs, the correlation is above 5 / 64 with probability 6e-7: of all 15 pairs, in both sequences, with 2e-5.
TEST(CameraRays, TakeUnrelatedNumbersForEachPurpose) {
    constexpr std::uint32_t kSamples = 4096;
    constexpr float kFocus = 2.0f;
    SceneDesc scene = empty_scene();
    scene.cameras.front().lens_radius = 0.1f;
    scene.cameras.front().focus_distance = kFocus;
    MaterialDesc veil = diffuse(Rgb(0.5f));
    veil.alpha_mode = AlphaMode::Blend;
    veil.base_alpha = 0.5f;
    add_object(scene, quad({0, 0, -9}, {1, 0, 0}, {0, 1, 0}), add_material(scene, veil));
    scene.instances.back().motion = {translation({-1, 0, 0}), translation({1, 0, 0})};
    const World world = compile(std::move(scene));
    const PixelFilter filter(FilterShape::Box);
    for (const SampleSequence sequence : {SampleSequence::Sobol, SampleSequence::Random}) {
        const TileJob job{{0, 0, 1, 1}, {0, 0, 1, 1}, 1, 1, 0, kSamples, 7, sequence, &filter};
        std::vector<CameraSample> samples(kSamples);
        std::vector<Ray> rays(kSamples);
        generate_camera_rays(world, job, 0, samples, rays);
        std::array<std::vector<double>, 6> numbers;
        for (std::size_t i = 0; i < kSamples; ++i) {
            // Where the ray is in focus, every point of the lens sees the same place on the film.
            const Vec3f in_focus = rays[i].origin + rays[i].direction * (kFocus / -rays[i].direction.z);
            const Vec2f film = world.camera().connect(in_focus, {0.5f, 0.5f}, rays[i].time).film;
            const double each[] = {static_cast<double>(film.x),
                                   static_cast<double>(film.y),
                                   static_cast<double>(samples[i].lens.x),
                                   static_cast<double>(samples[i].lens.y),
                                   static_cast<double>(rays[i].time),
                                   static_cast<double>(rays[i].alpha_key) / 4294967296.0};
            for (std::size_t n = 0; n < numbers.size(); ++n) numbers[n].push_back(each[n] - 0.5);
        }
        for (std::size_t a = 0; a < numbers.size(); ++a)
            for (std::size_t b = 0; b <= a; ++b) {
                // A uniform number has the variance 1/12.
                const double correlation =
                    12.0 * std::inner_product(numbers[a].begin(), numbers[a].end(), numbers[b].begin(), 0.0) / kSamples;
                EXPECT_NEAR(correlation, a == b ? 1.0 : 0.0, 5.0 / 64.0) << "numbers " << a << " and " << b;
            }
    }
}

TEST_F(CameraWave, AccumulateWeighsAndDrops) {
    generate(0, 8);
    TileBuffer tile;
    tile.reset(job_.rect);
    RenderCounters counters;
    CameraSample sample = samples_[7];
    sample.weight = 2.0f;
    accumulate(job_, sample, {1.0f, 2.0f, 3.0f}, 0.5f, tile, counters);
    EXPECT_EQ(sample.pixel, 5u);
    EXPECT_EQ(tile.pixel(5).g, 4.0);
    EXPECT_EQ(tile.pixel(5).alpha, 1.0);
    EXPECT_EQ(tile.pixel(5).samples, 1u);
    EXPECT_EQ(counters.dropped, 0u);

    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    std::uint64_t dropped = 0;
    for (const Rgb& bad : {Rgb(nan, 0, 0), Rgb(0, infinity, 0), Rgb(0, 0, -1e-3f)}) {
        accumulate(job_, sample, bad, 1.0f, tile, counters);
        EXPECT_EQ(counters.dropped, ++dropped);
    }
    EXPECT_EQ(tile.pixel(5).g, 4.0);
    EXPECT_EQ(tile.pixel(5).samples, 1u) << "they do not darken the pixel";
    EXPECT_EQ(counters.samples, 4u);
    EXPECT_EQ(counters.first_dropped[0].x, 10);
    EXPECT_EQ(counters.first_dropped[0].y, 21);
    EXPECT_EQ(counters.first_dropped[0].sample, sample.key.index);
}

// Radiance as the layers of a pixel keep it: with the weight of its sample once, and with its square for the variance.
TEST_F(CameraWave, AccumulateWeighsWhatLayersAverage) {
    auto aovs = std::make_shared<AovSet>();
    aovs->layout.light = 1;
    aovs->layout.has_moments = true;
    job_.aovs = aovs.get();
    generate(0, 1);
    samples_[0].weight = -0.5f;
    TileBuffer tile;
    tile.reset(job_.rect, aovs->layout);
    RenderCounters counters;
    SampleLight light;
    light.reset(1, job_, std::numeric_limits<float>::infinity());
    const ExpressionShare first{.expressions = 1, .share = Rgb(1.0f)};
    light.add(0, {1.0f, 2.0f, 3.0f}, LightKind::Direct, {&first, 1});
    const std::vector<float> alpha{1.0f};
    accumulate(job_, samples_, light, alpha, tile, counters);
    const std::span<const double> sums = tile.layers().sums(samples_[0].pixel);
    EXPECT_EQ(std::vector(sums.begin(), sums.begin() + 3), (std::vector{-0.5, -1.0, -1.5})) << "light";
    const std::span<const double> moments = sums.subspan(aovs->layout.moment_sums());
    EXPECT_EQ(std::vector(moments.begin(), moments.end()), (std::vector{0.25, 1.0, 2.25, 0.25, 0.5, 0.75, 0.25}));
}

}  // namespace

}  // namespace etendue::test
