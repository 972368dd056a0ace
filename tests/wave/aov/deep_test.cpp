// Deep films, against the images that they are flattened to and the depths of what they show.
#include "render/whole_image.h"
#include "wave/aov/aov_set.h"
#include "world/test_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kSide = 16;

Film deep_film(SceneDesc scene, const std::string& integrator, RenderOptions options) {
    auto aovs = std::make_shared<AovSet>();
    aovs->layout.is_deep = true;
    options.aovs = aovs;
    const World world = compile(std::move(scene));
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    return render(world, *make_integrator(integrator, {}), options, threads, stop, {}).film;
}

std::vector<float> flattened(const Film& film) {
    std::vector<float> image;
    for (const std::vector<DeepSample>& pixel : film.resolve_deep()) {
        float sum[4] = {};
        for (const DeepSample& s : pixel) {
            const float through = 1.0f - sum[3];
            const float color[4] = {s.r, s.g, s.b, s.alpha};
            for (int c = 0; c < 4; ++c) sum[c] += through * color[c];
        }
        image.insert(image.end(), sum, sum + 4);
    }
    return image;
}

/// A sheet that lets half through, glass, what moves, a lens, a lamp in view, and holes to the background.
SceneDesc deep_scene(bool has_background) {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = kSide;
    scene.settings.film.height = kSide;
    scene.cameras.front().lens_radius = 0.02f;
    scene.cameras.front().focus_distance = 2.0f;
    MaterialDesc glass;
    glass.override_model = DielectricDesc{1.5f, 0.0f};
    MaterialDesc sheet = diffuse({0.2f, 0.6f, 0.3f});
    sheet.alpha_mode = AlphaMode::Blend;
    sheet.base_alpha = 0.5f;
    add_object(scene, quad({0, 0, -1.5f}, {0.35f, 0, 0}, {0, 0.35f, 0}), add_material(scene, sheet));
    add_object(scene, sphere({-0.4f, 0.0f, -2.5f}, 0.35f, 10), add_material(scene, glass));
    add_object(scene, sphere({0.4f, 0.0f, -2.5f}, 0.3f, 10), add_material(scene, diffuse(Rgb(0.7f))));
    scene.instances.back().motion = {translation({-0.1f, 0, 0}), translation({0.1f, 0, 0})};
    add_object(scene, quad({0, -0.6f, -3}, {1.2f, 0, 0}, {0, 0, -1.2f}), add_material(scene, diffuse(Rgb(0.7f))));
    add_object(scene, quad({0, 0.8f, -3}, {0.4f, 0, 0}, {0, 0, 0.4f}), add_material(scene, emissive(Rgb(6.0f))));
    scene.environment.enabled = true;
    scene.environment.color = {0.2f, 0.3f, 0.5f};
    scene.environment.visible_to_camera = has_background;
    return scene;
}

class Deep : public testing::TestWithParam<std::string> {};

TEST_P(Deep, FlattensToTheImage) {
    for (const bool has_background : {true, false})
        for (const FilterShape shape : {FilterShape::BlackmanHarris, FilterShape::Mitchell}) {
            RenderOptions options = whole_image(kSide, kSide, 64, 3);
            options.filter = PixelFilter(shape);
            const Film film = deep_film(deep_scene(has_background), GetParam(), options);
            const std::vector<float> image = film.resolve();
            const std::vector<float> flat = flattened(film);
            ASSERT_EQ(flat.size(), image.size());
            for (std::size_t i = 0; i < image.size(); ++i) {
                // A filter with negative parts leaves alphas that no deep sample has.
                if (image[i / 4 * 4 + 3] < 0.0f || image[i / 4 * 4 + 3] > 1.0f) continue;
                EXPECT_NEAR(flat[i], image[i], 1e-3f * std::max(1.0f, std::abs(image[i]))) << GetParam() << " " << i;
            }
            std::size_t deepest = 0;
            for (std::size_t p = 0; p < film.window().area(); ++p)
                deepest = std::max(deepest, film.layers().deep().bins(p).size());
            EXPECT_GE(deepest, 3u);
            EXPECT_LE(deepest, 2 * DeepBuffer::kMostBins);
        }
}

// The image itself does not know of it.
TEST_P(Deep, LeavesTheImageAsItIs) {
    const RenderOptions options = whole_image(kSide, kSide, 4, 3);
    const World world = compile(deep_scene(true));
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    const Film film = render(world, *make_integrator(GetParam(), {}), options, threads, stop, {}).film;
    EXPECT_EQ(deep_film(deep_scene(true), GetParam(), options).resolve(), film.resolve());
}

INSTANTIATE_TEST_SUITE_P(Integrators, Deep, testing::Values("path", "light", "bdpt", "whitted"),
                         [](const auto& each) { return each.param; });

/// Two metres away a card of half alpha before a wall at three metres; both fill the view and face the camera.
SceneDesc card_and_wall() {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = kSide;
    scene.settings.film.height = kSide;
    MaterialDesc card = diffuse({0.8f, 0.0f, 0.0f});
    card.alpha_mode = AlphaMode::Blend;
    card.base_alpha = 0.5f;
    add_object(scene, quad({0, 0, -2}, {9, 0, 0}, {0, 9, 0}), add_material(scene, card));
    add_object(scene, quad({0, 0, -3}, {9, 0, 0}, {0, 9, 0}), add_material(scene, diffuse({0.0f, 0.8f, 0.0f})));
    LightDesc spot;
    spot.type = LightType::Point;
    spot.intensity = 3.0f;
    scene.lights.push_back(spot);
    return scene;
}

// Light of bdpt that falls on the film goes to the depth of the surface that it comes from: card and wall have a colour
// each, and what is red is at the card's.
TEST(DeepDepths, AreThoseOfTheSurfacesThatTheLightComesFrom) {
    for (const char* integrator : {"path", "bdpt", "light"}) {
        const Film film = deep_film(card_and_wall(), integrator, whole_image(kSide, kSide, 256, 3));
        double red[2] = {};
        double green[2] = {};
        for (const std::vector<DeepSample>& pixel : film.resolve_deep()) {
            ASSERT_EQ(pixel.size(), 2u) << integrator;
            for (std::size_t i = 0; i < 2; ++i) {
                EXPECT_NEAR(pixel[i].front, i == 0 ? 2.0f : 3.0f, 1e-3f);
                EXPECT_NEAR(pixel[i].back, i == 0 ? 2.0f : 3.0f, 1e-3f);
                red[i] += static_cast<double>(pixel[i].r);
                green[i] += static_cast<double>(pixel[i].g);
            }
            EXPECT_NEAR(pixel[0].alpha, 0.5f, 0.125f) << "four deviations";
            EXPECT_EQ(pixel[1].alpha, 1.0f);
        }
        EXPECT_GT(red[0], 0.0) << integrator;
        EXPECT_EQ(red[1], 0.0) << integrator;
        EXPECT_EQ(green[0], 0.0) << integrator;
        EXPECT_GT(green[1], 0.0) << integrator;
    }
}

}  // namespace

}  // namespace etendue::test
