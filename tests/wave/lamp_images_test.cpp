// Images of small lamps in mirrors and glass: whether they are where mirrors show them, as bright as closed forms and a
// path tracer without light samples have them, nearly without noise, and the same whatever is rendered beside them.
#include "wave/lamp_images.h"

#include "integrator/agreement_cases.h"
#include "integrator/agreement_room.h"
#include "integrator/integrator.h"
#include "render/render.h"
#include "render/whole_image.h"
#include "support/t_test.h"
#include "support/z_test.h"
#include "wave/aov/layered_render.h"
#include "world/test_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kMirrorSide = 12;  // pixels of the image's sides
constexpr float kTinyLampRadiance = 1e5f;
constexpr float kTinyLampHalf = 0.004f;  // metres
const Vec3f kTinyLamp{0.31f, 0.12f, 1.0f};
/// Metres from the camera to the mirror.
constexpr float kMirrorDistance = 2.0f;

/// Reflects all light.
MaterialDesc perfect_mirror() {
    MaterialDesc material;
    material.roughness = 0.0f;
    return material;
}

/// A square lamp behind the camera, which a mirror in front of it shows; a fiftieth of a pixel wide.
void add_lamp_in_a_mirror(SceneDesc& scene) {
    add_object(scene, quad({0, 0, -kMirrorDistance}, {3, 0, 0}, {0, 3, 0}), add_material(scene, perfect_mirror()));
    add_object(scene, quad(kTinyLamp, {-kTinyLampHalf, 0, 0}, {0, kTinyLampHalf, 0}),
               add_material(scene, emissive(Rgb(kTinyLampRadiance))));
}

SceneDesc lamp_in_a_mirror() {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = kMirrorSide;
    scene.settings.film.height = kMirrorSide;
    add_lamp_in_a_mirror(scene);
    return scene;
}

/// Where the mirror shows a point of the lamp's plane, pixels.
Vec2f image_position(const World& world, const Vec3f& point) {
    const Vec3f image{point.x, point.y, -2.0f * kMirrorDistance - point.z};
    return world.camera().connect(image, {0.5f, 0.5f}, 0.0f).film * static_cast<float>(kMirrorSide);
}

TileJob job_of_all(const PixelFilter& filter) {
    return {.rect = {0, 0, kMirrorSide, kMirrorSide},
            .window = {0, 0, kMirrorSide, kMirrorSide},
            .full_width = kMirrorSide,
            .full_height = kMirrorSide,
            .sample_count = 4,
            .seed = 5,
            .filter = &filter};
}

std::vector<float> render_with(const World& world, const std::string& integrator, const RenderOptions& options,
                               const IntegratorSettings& settings = {}) {
    const ThreadPool threads(2);
    const std::atomic<bool> stop{false};
    return render(world, *make_integrator(integrator, settings), options, threads, stop, {}).film.resolve();
}

/// The sum of a channel over all pixels.
double sum_of_image(const std::vector<float>& image, std::size_t channel = 0) {
    double sum = 0.0;
    for (std::size_t i = channel; i < image.size(); i += 4) sum += static_cast<double>(image[i]);
    return sum;
}

}  // namespace

TEST(LampImages, AreFoundWhereAMirrorShowsThem) {
    const World world = compile(lamp_in_a_mirror());
    const PixelFilter filter(FilterShape::Box);
    const PixelRect window{0, 0, kMirrorSide, kMirrorSide};
    const auto images = find_lamp_images(world, job_of_all(filter), window);
    ASSERT_NE(images, nullptr);
    float area = 0.0f;
    images->for_each_in(window, [&](const LampPixels&, const LampPixel& pixel) { area += pixel.area; });
    const Vec2f a = image_position(world, kTinyLamp - Vec3f(kTinyLampHalf, kTinyLampHalf, 0.0f));
    const Vec2f b = image_position(world, kTinyLamp + Vec3f(kTinyLampHalf, kTinyLampHalf, 0.0f));
    const float true_area = std::abs((b.x - a.x) * (b.y - a.y));
    EXPECT_LT(true_area, 0.001f);
    EXPECT_LT(area, 30.0f * true_area);
    for (const Vec2f& inside : {a, b, (a + b) * 0.5f}) EXPECT_TRUE(images->contain(inside)) << inside.x;
    EXPECT_FALSE(images->contain((a + b) * 0.5f + Vec2f(0.5f, 0.0f)));
    EXPECT_FALSE(images->contain({-1.0f, 3.0f}));
    // None where nothing mirrors.
    EXPECT_EQ(find_lamp_images(compile(empty_scene()), job_of_all(filter), window), nullptr);
}

// The middle of the pixel sees past the mirror, which is a strip 0.4 pixels wide.
TEST(LampImages, AreFoundAtTheEdgeOfAMirror) {
    const World camera = compile(lamp_in_a_mirror());
    const float left = image_position(camera, {0.0f, 0.0f, 1.0f}).x;
    const float pixels_per_metre = image_position(camera, {1.0f, 0.0f, 1.0f}).x - left;
    const auto lamp_x = [&](float film) { return (film - left) / pixels_per_metre; };
    // The image lies behind the mirror, at two and a half times its distance.
    const float middle = 0.4f * lamp_x(4.1f);
    const float half = 0.4f * 0.2f / std::abs(pixels_per_metre);
    SceneDesc scene = empty_scene();
    scene.settings.film.width = kMirrorSide;
    scene.settings.film.height = kMirrorSide;
    add_object(scene, quad({middle, 0, -kMirrorDistance}, {half, 0, 0}, {0, 3, 0}),
               add_material(scene, perfect_mirror()));
    const Vec3f lamp{lamp_x(4.15f), 0.12f, 1.0f};
    add_object(scene, quad(lamp, {-kTinyLampHalf, 0, 0}, {0, kTinyLampHalf, 0}),
               add_material(scene, emissive(Rgb(kTinyLampRadiance))));
    const World world = compile(scene);
    const PixelFilter filter(FilterShape::Box);
    const auto images = find_lamp_images(world, job_of_all(filter), {0, 0, kMirrorSide, kMirrorSide});
    ASSERT_NE(images, nullptr);
    EXPECT_NEAR(image_position(world, lamp).x, 4.15f, 0.01f);
    EXPECT_TRUE(images->contain(image_position(world, lamp)));
}

// The sum over the pixels is the radiance times the image's area, whatever the filter. The standard error of 512
// samples is below 3% (two samples each, of which one in ten or more meets the lamp); six of them are asked for. With
// the image left to chance, one sample in 6,000 of one pixel meets it.
TEST(LampImages, AreAsBrightAsTheirSolidAngleSays) {
    const World world = compile(lamp_in_a_mirror());
    const Vec2f a = image_position(world, kTinyLamp - Vec3f(kTinyLampHalf, kTinyLampHalf, 0.0f));
    const Vec2f b = image_position(world, kTinyLamp + Vec3f(kTinyLampHalf, kTinyLampHalf, 0.0f));
    for (const char* integrator : {"path", "bdpt", "vcm"})
        for (const FilterShape shape : {FilterShape::BlackmanHarris, FilterShape::Mitchell, FilterShape::Box}) {
            RenderOptions options = whole_image(kMirrorSide, kMirrorSide, 512, 9);
            options.filter = PixelFilter(shape);
            const double expected = static_cast<double>(kTinyLampRadiance * std::abs((b.x - a.x) * (b.y - a.y)));
            EXPECT_NEAR(sum_of_image(render_with(world, integrator, options)) / expected, 1.0, 0.18) << integrator;
        }
}

/// Sums of pixels of one tile after a job of `path`.
std::vector<double> sums_with_images(const World& world, const TileJob& job) {
    const auto integrator = make_integrator("path", {});
    const auto scratch = integrator->make_scratch();
    TileBuffer tile;
    tile.reset(job.rect);
    RenderCounters counters;
    integrator->render_tile(world, job, *scratch, tile, counters);
    std::vector<double> sums;
    for (std::size_t i = 0; i < job.rect.area(); ++i) sums.push_back(tile.pixel(static_cast<std::uint32_t>(i)).r);
    return sums;
}

// As crops, tiles and adaptive passes take them.
TEST(LampImages, ASampleIsTheSameWhateverIsRenderedBesideIt) {
    const World world = compile(lamp_in_a_mirror());
    const PixelFilter filter(FilterShape::BlackmanHarris);
    TileJob all = job_of_all(filter);
    const auto images = find_lamp_images(world, all, {-4, -4, kMirrorSide + 4, kMirrorSide + 4});
    all.lamp_images = images.get();
    all.sample_count = 32;
    const std::vector<double> whole = sums_with_images(world, all);
    ASSERT_GT(std::ranges::count_if(whole, [](double sum) { return sum > 0.0; }), 3);
    for (std::size_t p = 0; p < whole.size(); ++p) {
        TileJob one = all;
        const int x = static_cast<int>(p) % kMirrorSide;
        const int y = static_cast<int>(p) / kMirrorSide;
        one.rect = {x, y, x + 1, y + 1};
        EXPECT_EQ(sums_with_images(world, one).front(), whole[p]) << p;
    }
    TileJob some = all;
    std::vector<PixelJob> pixels;
    for (std::uint32_t p = 0; p < whole.size(); p += 3) pixels.push_back({p, 0});
    some.pixels = pixels;
    const std::vector<double> part = sums_with_images(world, some);
    for (std::size_t p = 0; p < whole.size(); ++p) EXPECT_EQ(part[p], p % 3 == 0 ? whole[p] : 0.0) << p;
    // All of the light is the images': without them, chance finds none.
    all.lamp_images = nullptr;
    EXPECT_EQ(std::ranges::count_if(sums_with_images(world, all), [](double sum) { return sum > 0.0; }), 0);
}

// A ball of glass shows a lamp by reflection, by two refractions and by ways within it. `naive` meets the lamp by
// chance, with one sample of a hundred. |z| is above 4.5 in 1 of 100,000 runs if both have one mean.
TEST(LampImages, OfABallOfGlassAreThoseThatChanceFinds) {
    SceneDesc scene = empty_scene();
    add_ball(scene, glass(0.0f, 0.0f, Rgb(1.0f)));
    add_object(scene, quad({0.4f, 0.9f, 0.5f}, {-0.7f, 0, 0}, {0, 0.7f, 0}),
               add_material(scene, emissive(Rgb(100.0f))));
    const World world = compile(scene);
    IntegratorSettings settings;
    settings.lengths.max_depth = 6;
    const auto estimate = [&](const char* integrator, std::uint32_t spp) {
        std::vector<double> sums;
        for (std::uint32_t seed = 1; seed <= 8; ++seed)
            sums.push_back(sum_of_image(render_with(world, integrator, whole_image(24, 24, spp, seed), settings)));
        const TTestResult of_sums = t_test(sums, 0.0);
        return Estimate{of_sums.mean, of_sums.standard_error * of_sums.standard_error};
    };
    const Estimate by_chance = estimate("naive", 768);
    for (const char* integrator : {"path", "bdpt"}) {
        const Estimate found = estimate(integrator, 128);
        EXPECT_GT(found.mean, 0.0);
        const ZTestResult test = z_test(found, by_chance);
        EXPECT_LT(std::abs(test.z), 4.5) << integrator << ": " << test.str();
        EXPECT_LT(std::sqrt(found.variance + by_chance.variance), 0.06 * by_chance.mean)
            << integrator << ": " << found.mean << " +- " << std::sqrt(found.variance) << ", " << by_chance.mean
            << " +- " << std::sqrt(by_chance.variance);
    }
}

// The room is dim beside the lamp that the mirror shows, which is all of one layer; both add up to the image.
TEST(LampImages, AreOfTheExpressionsOfTheirPaths) {
    const AgreementCase shown{.name = "LampInAMirror", .make = add_lamp_in_a_mirror};
    const World world = compile(agreement_scene(shown));
    RenderOptions options = whole_image(kMirrorSide, kMirrorSide, 16, 3);
    options.aovs = std::make_shared<AovSet>(expression_layers(shown, {"C <RS> O", "!C <RS> O"}));
    const ThreadPool threads(2);
    const std::atomic<bool> stop{false};
    const RenderResult result = render(world, *make_integrator("path", {}), options, threads, stop, {});
    const double image = sum_of_image(result.film.resolve());
    const auto sum_of_layer = [&](std::size_t layer) {
        double sum = 0.0;
        const std::vector<float> light = result.film.resolve_light(layer);
        for (std::size_t i = 0; i < light.size(); i += 3) sum += static_cast<double>(light[i]);
        return sum;
    };
    EXPECT_GT(image, 0.0);
    EXPECT_GT(sum_of_layer(0), 0.9 * image);
    EXPECT_NEAR(sum_of_layer(0) + sum_of_layer(1), image, 1e-5 * image);
}

}  // namespace etendue::test
