// Windows of path lengths add up: what paths of 1, 2, ... edges show, each rendered alone, is what all of them show
// together.
#include "metrics/block_agreement.h"
#include "render/whole_image.h"
#include "support/chi2.h"
#include "world/test_scene.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kWidth = 32;
constexpr int kHeight = 24;
constexpr int kLongest = 5;
constexpr std::uint32_t kSeeds = 6;

/// Light by every way: a lamp, a point, glass, a mirror and plastic in a corner.
SceneDesc corner_scene() {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = kWidth;
    scene.settings.film.height = kHeight;
    MaterialDesc glass;
    glass.override_model = DielectricDesc{1.5f, 0.0f};
    MaterialDesc mirror;
    mirror.override_model = ConductorDesc{"Cu", 0.0f};
    MaterialDesc plastic;
    plastic.metallic = 0.0f;
    plastic.roughness = 0.5f;
    add_object(scene, sphere({-0.4f, -0.3f, -2.5f}, 0.35f, 10), add_material(scene, glass));
    add_object(scene, sphere({0.4f, -0.3f, -2.5f}, 0.3f, 10), add_material(scene, plastic));
    add_object(scene, quad({0.9f, 0.2f, -3.0f}, {0, 0, 0.5f}, {0, 0.5f, 0}), add_material(scene, mirror));
    add_object(scene, quad({0, -0.7f, -3}, {1.5f, 0, 0}, {0, 0, -1.5f}), add_material(scene, diffuse(Rgb(0.7f))));
    add_object(scene, quad({0, 0.4f, -4}, {1.5f, 0, 0}, {0, 1.2f, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    add_object(scene, quad({0, 1.1f, -3}, {0.4f, 0, 0}, {0, 0, 0.4f}), add_material(scene, emissive(Rgb(6.0f))));
    LightDesc point;
    point.intensity = 2.0f;
    point.to_world = translation({0.5f, 0.6f, -2.0f});
    scene.lights.push_back(point);
    return scene;
}

World corner() {
    return compile(corner_scene());
}

/// With a ball of fog before all that: paths of one block have come along different numbers of edges, since what
/// scatters in it adds none.
World foggy_corner() {
    SceneDesc scene = corner_scene();
    MaterialDesc fog;
    fog.override_model = DielectricDesc{1.1f,
                                        0.0f,
                                        {.closed = true,
                                         .attenuation_color = Rgb(0.5f),
                                         .attenuation_distance = 0.3f,
                                         .multiscatter_color = Rgb(0.9f)}};
    add_object(scene, sphere({0.0f, 0.0f, -2.2f}, 0.5f, 12), add_material(scene, fog));
    return compile(std::move(scene));
}

/// Colours of paths of `shortest` to `longest` edges.
ImageF image_of(const World& world, const std::string& integrator, int shortest, int longest, std::uint32_t seed) {
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    RenderOptions options = whole_image(kWidth, kHeight, 32, seed);
    options.filter = PixelFilter(FilterShape::Box);
    // No roulette: it is a matter of chance like the rest, but has tests of its own.
    const auto made = make_integrator(integrator, {.lengths = {longest, shortest, kLongest + 1}});
    const std::vector<float> rgba = render(world, *made, options, threads, stop, {}).film.resolve();
    ImageF image(kWidth, kHeight, 3);
    for (std::size_t p = 0; p < rgba.size() / 4; ++p) std::copy_n(&rgba[4 * p], 3, &image.pixels[3 * p]);
    return image;
}

ImageF sum_of_windows(const World& world, const std::string& integrator, std::uint32_t seed, std::uint32_t seed_step) {
    ImageF sum(kWidth, kHeight, 3);
    for (int edges = 1; edges <= kLongest; ++edges) {
        const ImageF one =
            image_of(world, integrator, edges, edges, seed + static_cast<std::uint32_t>(edges) * seed_step);
        for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += one.pixels[i];
    }
    return sum;
}

class DepthWindows : public testing::TestWithParam<const char*> {};

// A path is the same whatever lengths are wanted: with the same numbers the sum is equal but for rounding.
TEST_P(DepthWindows, AddUpPixelByPixel) {
    const World world = corner();
    const ImageF whole = image_of(world, GetParam(), 1, kLongest, 7);
    const ImageF sum = sum_of_windows(world, GetParam(), 7, 0);
    EXPECT_GT(*std::ranges::max_element(whole.pixels), 0.1f);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i)
        ASSERT_NEAR(sum.pixels[i], whole.pixels[i], 1e-5f + 1e-4f * whole.pixels[i]) << "value " << i;
}

TEST(DepthWindowsInFog, AddUpPixelByPixel) {
    const World world = foggy_corner();
    const ImageF whole = image_of(world, "path", 1, kLongest, 7);
    const ImageF sum = sum_of_windows(world, "path", 7, 0);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i)
        ASSERT_NEAR(sum.pixels[i], whole.pixels[i], 1e-5f + 1e-4f * whole.pixels[i]) << "value " << i;
}

TEST_P(DepthWindows, AddUpWithOtherNumbers) {
    const World world = corner();
    std::vector<ImageF> wholes;
    std::vector<ImageF> sums;
    for (std::uint32_t i = 0; i < kSeeds; ++i) {
        wholes.push_back(image_of(world, GetParam(), 1, kLongest, 100 + i));
        sums.push_back(sum_of_windows(world, GetParam(), 200 + i, 100));
    }
    constexpr std::size_t kIntegrators = 5;
    const BlockAgreement result = test_agreement(
        estimate_image(wholes), estimate_image(sums),
        {.block_size = 8, .significance = sidak_level(kFamilyLevel, kIntegrators), .mean_tolerance = 0.05});
    EXPECT_TRUE(result.agree()) << result.str();
}

INSTANTIATE_TEST_SUITE_P(All, DepthWindows, testing::Values("path", "naive", "light", "bdpt", "whitted"),
                         [](const auto& param) { return std::string(param.param); });

}  // namespace

}  // namespace etendue::test
