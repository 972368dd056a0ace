// Coverages of ids against what geometry says they are.
#include "render/whole_image.h"
#include "wave/aov/aov_set.h"
#include "world/test_scene.h"

#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Odd, so that the middle pixel lies around the axis.
constexpr int kMatteSide = 9;
constexpr std::size_t kMiddle = kMatteSide * kMatteSide / 2;
constexpr float kDistance = 2.0f;
constexpr std::uint32_t kSpp = 1024;
/// Of the mean of as many independent samples that are 0 or 1; Sobol's are better.
constexpr double kFourDeviations = 4.0 * 0.5 / 32.0;

/// Of the id of each object, from 1 on.
struct Coverages {
    std::vector<std::vector<double>> of;  ///< by id, then by pixel
    std::vector<float> image;
};

std::shared_ptr<const AovSet> object_mattes(std::size_t objects) {
    auto aovs = std::make_shared<AovSet>();
    aovs->layout.mattes = 1;
    aovs->layout.matte_slots = 12;
    MatteIds& ids = aovs->mattes.emplace_back();
    for (std::uint32_t i = 0; i < objects; ++i) ids.ids.push_back(i + 1);
    return aovs;
}

RenderOptions box_filtered(std::uint32_t spp) {
    RenderOptions options = whole_image(kMatteSide, kMatteSide, spp, 3);
    options.filter = PixelFilter(FilterShape::Box);
    return options;
}

Coverages coverages(SceneDesc scene, const std::string& integrator, const RenderOptions& options) {
    const std::size_t objects = scene.instances.size();
    RenderOptions with_mattes = options;
    with_mattes.aovs = object_mattes(objects);
    const World world = compile(std::move(scene));
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    const Film film = render(world, *make_integrator(integrator, {}), with_mattes, threads, stop, {}).film;
    constexpr std::size_t kRanks = 12;
    const std::vector<float> ranked = film.resolve_matte(0, kRanks);
    Coverages result{std::vector(objects + 1, std::vector<double>(film.window().area(), 0.0)), film.resolve()};
    for (std::size_t p = 0; p < film.window().area(); ++p)
        for (std::size_t r = 0; r < kRanks; ++r) {
            const float* const pair = &ranked[(p * kRanks + r) * 2];
            result.of[std::bit_cast<std::uint32_t>(pair[0])][p] += static_cast<double>(pair[1]);
            EXPECT_LE(pair[1], r > 0 ? ranked[(p * kRanks + r) * 2 - 1] : 1.001f) << "ranks are sorted";
        }
    return result;
}

SceneDesc square_scene() {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = kMatteSide;
    scene.settings.film.height = kMatteSide;
    scene.environment.enabled = true;
    scene.environment.color = Rgb(1.0f);
    scene.environment.visible_to_camera = false;
    return scene;
}

/// Metres of a pixel at kDistance.
float pixel_size(const SceneDesc& scene) {
    return 2.0f * std::tan(0.5f * scene.cameras.front().yfov) * kDistance / kMatteSide;
}

/// What lies to the right of `x` at `distance` before the camera.
PrimitiveDesc right_half(float x, float distance = kDistance) {
    constexpr float kHalf = 50.0f;
    return quad({x + kHalf, 0, -distance}, {kHalf, 0, 0}, {0, kHalf, 0});
}

class Mattes : public testing::TestWithParam<std::string> {};

TEST_P(Mattes, OfAnEdgeAreTheAreasOnItsSides) {
    SceneDesc scene = square_scene();
    const float edge = 0.2f * pixel_size(scene);  // 0.3 of the middle column lie to the right of it
    add_object(scene, right_half(edge), add_material(scene, diffuse(Rgb(0.5f))));
    add_object(scene, quad({edge - 50, 0, -kDistance}, {50, 0, 0}, {0, 50, 0}),
               add_material(scene, diffuse(Rgb(0.2f))));
    const Coverages found = coverages(std::move(scene), GetParam(), box_filtered(kSpp));
    for (std::size_t p = 0; p < kMatteSide * kMatteSide; ++p) {
        const std::size_t column = p % kMatteSide;
        const double right = column == kMatteSide / 2 ? 0.3 : column > kMatteSide / 2 ? 1.0 : 0.0;
        EXPECT_NEAR(found.of[1][p], right, 2e-3) << p;
        EXPECT_NEAR(found.of[1][p] + found.of[2][p], 1.0, 1e-6) << p;
    }
}

TEST_P(Mattes, OfACardOfHalfAlphaAndOfTheWallBehindItAreHalves) {
    SceneDesc scene = square_scene();
    MaterialDesc card = diffuse(Rgb(0.5f));
    card.alpha_mode = AlphaMode::Blend;
    card.base_alpha = 0.5f;
    add_object(scene, right_half(-50.0f), add_material(scene, card));
    add_object(scene, right_half(-50.0f, 3.0f), add_material(scene, diffuse(Rgb(0.5f))));
    const Coverages found = coverages(std::move(scene), GetParam(), box_filtered(kSpp));
    for (std::size_t p = 0; p < kMatteSide * kMatteSide; ++p) {
        EXPECT_NEAR(found.of[1][p], 0.5, kFourDeviations) << p;
        EXPECT_NEAR(found.of[1][p] + found.of[2][p], 1.0, 1e-6) << p;
    }
}

// Its edge passes the middle after a quarter of the time, and the pixel lies evenly around it.
TEST_P(Mattes, OfWhatMovesAreItsSharesOfTheTime) {
    SceneDesc scene = square_scene();
    add_object(scene, right_half(0.0f), add_material(scene, diffuse(Rgb(0.5f))));
    scene.instances.back().motion = {translation({-1, 0, 0}), translation({3, 0, 0})};
    const Coverages found = coverages(std::move(scene), GetParam(), box_filtered(kSpp));
    EXPECT_NEAR(found.of[1][kMiddle], 0.25, 4e-3);
    for (std::size_t p = 0; p < kMatteSide * kMatteSide; ++p)
        EXPECT_NEAR(found.of[1][p], static_cast<double>(found.image[4 * p + 3]), 1e-6) << p;
}

/// The share of a disc of radius 1 on one side of a line at `x`.
double disc_share(double x) {
    if (std::abs(x) >= 1.0) return x > 0.0 ? 1.0 : 0.0;
    return 0.5 + (x * std::sqrt(1.0 - x * x) + std::asin(x)) / std::numbers::pi;
}

// Seen through point l of the lens and in focus at half the distance, a pixel around x there is at 2 x - l.
TEST_P(Mattes, OfWhatIsOutOfFocusAreItsSharesOfTheLens) {
    SceneDesc scene = square_scene();
    CameraDesc& camera = scene.cameras.front();
    camera.focus_distance = kDistance / 2.0f;
    camera.lens_radius = 0.6f;
    add_object(scene, right_half(0.0f), add_material(scene, diffuse(Rgb(0.5f))));
    const auto size = static_cast<double>(pixel_size(scene)) / 2.0;
    const auto radius = static_cast<double>(camera.lens_radius);
    const Coverages found = coverages(std::move(scene), GetParam(), box_filtered(kSpp));
    int blurred = 0;
    for (std::size_t column = 0; column < kMatteSide; ++column) {
        double expected = 0.0;
        constexpr int kSteps = 100;
        for (int i = 0; i < kSteps; ++i) {
            const double x = (static_cast<double>(column) + (i + 0.5) / kSteps - 0.5 * kMatteSide) * size;
            expected += disc_share(2.0 * x / radius) / kSteps;
        }
        blurred += expected > 0.02 && expected < 0.98 ? 1 : 0;
        double mean = 0.0;
        for (std::size_t row = 0; row < kMatteSide; ++row) mean += found.of[1][row * kMatteSide + column] / kMatteSide;
        EXPECT_NEAR(mean, expected, kFourDeviations / std::sqrt(kMatteSide)) << column;
    }
    EXPECT_GE(blurred, 5);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Mattes, testing::Values("path", "bdpt"),
                         [](const auto& each) { return each.param; });

/// Some of everything that decides what a camera ray meets.
SceneDesc cluttered_scene() {
    SceneDesc scene = square_scene();
    scene.cameras.front().lens_radius = 0.02f;
    scene.cameras.front().focus_distance = 2.0f;
    MaterialDesc card = diffuse(Rgb(0.5f));
    card.alpha_mode = AlphaMode::Blend;
    card.base_alpha = 0.3f;
    MaterialDesc glass;
    glass.override_model = DielectricDesc{1.5f, 0.0f};
    add_object(scene, quad({0.1f, 0.1f, -1.5f}, {0.3f, 0.1f, 0}, {0, 0.3f, 0}), add_material(scene, card));
    add_object(scene, sphere({-0.3f, 0.1f, -2.5f}, 0.4f, 8), add_material(scene, glass));
    add_object(scene, sphere({0.3f, -0.2f, -2.2f}, 0.4f, 8), add_material(scene, diffuse(Rgb(0.5f))));
    scene.instances.back().motion = {translation({-0.2f, 0, 0}), translation({0.2f, 0, 0})};
    return scene;
}

TEST(MattesOfAllIntegrators, AreOne) {
    const RenderOptions options = box_filtered(16);
    const Coverages first = coverages(cluttered_scene(), "path", options);
    for (const char* integrator : {"light", "bdpt", "whitted", "direct", "naive", "normals", "albedo"})
        EXPECT_EQ(coverages(cluttered_scene(), integrator, options).of, first.of) << integrator;
}

TEST(MattesOfEmptyBackgrounds, AddUpToAlpha) {
    for (const FilterShape shape : {FilterShape::Box, FilterShape::BlackmanHarris, FilterShape::Gaussian}) {
        RenderOptions options = box_filtered(64);
        options.filter = PixelFilter(shape);
        const Coverages found = coverages(cluttered_scene(), "path", options);
        double all = 0.0;
        for (std::size_t p = 0; p < kMatteSide * kMatteSide; ++p) {
            const double sum = found.of[1][p] + found.of[2][p] + found.of[3][p];
            EXPECT_NEAR(sum, static_cast<double>(found.image[4 * p + 3]), 1e-6);
            all += sum;
        }
        EXPECT_GT(all, 0.1 * kMatteSide * kMatteSide);
        EXPECT_LT(all, 0.9 * kMatteSide * kMatteSide);
    }
}

// A lamp so bright that what single samples find of it on the wall is more than a float holds: they are dropped, and
// with them all that they have met.
TEST(MattesOfDroppedSamples, AreDroppedToo) {
    SceneDesc scene = square_scene();
    scene.environment.enabled = false;
    add_object(scene, right_half(-50.0f), add_material(scene, diffuse(Rgb(0.9f))));
    add_object(scene, quad({0, 3, 0}, {4, 0, 0}, {0, 0, 4}), add_material(scene, emissive(Rgb(3e38f))));
    RenderOptions options = box_filtered(64);
    auto aovs = std::make_shared<AovSet>(*object_mattes(scene.instances.size()));
    aovs->layout.values = 1;
    aovs->values = {FirstHitValue::ObjectId};
    aovs->layout.nearest = 1;
    aovs->nearest = {FirstHitValue::Depth};
    options.aovs = aovs;
    const World world = compile(std::move(scene));
    const ThreadPool threads;
    for (const char* integrator : {"path", "bdpt", "direct"}) {
        const std::atomic<bool> stop{false};
        const RenderResult rendered = render(world, *make_integrator(integrator, {}), options, threads, stop, {});
        EXPECT_GT(rendered.counters.dropped, 64u) << integrator;
        EXPECT_GT(rendered.film.sample_count(), 64u) << integrator;
        const std::vector<float> image = rendered.film.resolve();
        const std::vector<float> ranked = rendered.film.resolve_matte(0, 1);
        const std::vector<float> numbers = rendered.film.resolve_values(0, 1);
        const std::vector<float> depths = rendered.film.resolve_nearest(0, 1, -1.0f);
        for (std::size_t p = 0; p < kMatteSide * kMatteSide; ++p) {
            EXPECT_NEAR(ranked[2 * p + 1], image[4 * p + 3], 1e-6f) << integrator << p;
            EXPECT_NEAR(numbers[p], image[4 * p + 3], 1e-6f) << "the wall is object 1";
            EXPECT_EQ(depths[p] > 0.0f, image[4 * p + 3] > 0.0f);
        }
    }
}

TEST(MattesOfMaterials, AreByTheMaterialOfThePrimitive) {
    SceneDesc scene = square_scene();
    std::vector<PrimitiveDesc> halves{right_half(0.0f), quad({-50, 0, -kDistance}, {50, 0, 0}, {0, 50, 0})};
    for (PrimitiveDesc& half : halves) half.material = add_material(scene, diffuse(Rgb(0.5f)));
    place(scene, add_mesh(scene, halves));
    RenderOptions options = box_filtered(64);
    auto aovs = std::make_shared<AovSet>();
    aovs->layout.mattes = 1;
    aovs->layout.matte_slots = 4;
    aovs->mattes.push_back({true, {std::bit_cast<std::uint32_t>(3.0f), std::bit_cast<std::uint32_t>(5.0f)}});
    options.aovs = aovs;
    const World world = compile(std::move(scene));
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    const std::vector<float> ranked =
        render(world, *make_integrator("path", {}), options, threads, stop, {}).film.resolve_matte(0, 1);
    for (std::size_t p = 0; p < kMatteSide * kMatteSide; ++p)
        if (p % kMatteSide != kMatteSide / 2) {
            EXPECT_EQ(ranked[2 * p], p % kMatteSide > kMatteSide / 2 ? 3.0f : 5.0f);
            EXPECT_EQ(ranked[2 * p + 1], 1.0f);
        }
}

}  // namespace

}  // namespace etendue::test
