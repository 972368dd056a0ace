// What texture filtering is for, and what it must not do: no aliasing at one sample per pixel, no change of the mean.
#include "integrator/path/path_integrator.h"
#include "integrator/render_tile.h"
#include "world/test_scene.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kFilteredWidth = 64;
constexpr int kFilteredHeight = 48;
/// The rows below the horizon, which lies at half the height: in the first three, pixels cover several periods; in the
/// others a period covers up to three pixels.
constexpr PixelRect kNearHorizon{0, kFilteredHeight / 2 + 1, kFilteredWidth, kFilteredHeight / 2 + 4};
constexpr PixelRect kBelowHorizon{0, kFilteredHeight / 2 + 1, kFilteredWidth, kFilteredHeight / 2 + 9};

const PathIntegrator kPath({.lengths = {8, 1, 8}});

std::vector<std::array<int, 4>> checkerboard(int size) {
    std::vector<std::array<int, 4>> texels;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const int value = ((x < size / 2) != (y < size / 2)) ? 255 : 0;
            texels.push_back({value, value, value, 255});
        }
    return texels;
}

class TextureAliasing : public testing::Test {
  protected:
    /// An unlit checkerboard, 2 m a period, one metre below the camera and out to the horizon.
    SceneDesc plain() {
        SceneDesc scene = empty_scene();
        scene.cameras[0].yfov = 0.6f;
        add_texture(scene, png_, 64, checkerboard(64));
        MaterialDesc material;
        material.unlit = true;
        material.base_color_texture.texture = {0};
        PrimitiveDesc ground = quad({0, -1, -1000}, {1000, 0, 0}, {0, 0, -1000});
        for (Vec2f& uv : ground.uv0) uv *= 1000.0f;
        add_object(scene, std::move(ground), add_material(scene, material));
        return scene;
    }
    static std::vector<Rgb> render(const World& world, const PixelRect& window, std::uint32_t spp) {
        return render_pixels(world, kPath, window, kFilteredWidth, kFilteredHeight, spp);
    }
    /// Root of the mean squared difference of green.
    static double rms(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const double difference = static_cast<double>(a[i].g) - static_cast<double>(b[i].g);
            sum += difference * difference;
        }
        return std::sqrt(sum / static_cast<double>(a.size()));
    }
    static SceneDesc without_mip_levels(SceneDesc scene) {
        for (TextureDesc& texture : scene.textures) texture.mip_filter = TextureMipFilter::None;
        return scene;
    }
    void TearDown() override { std::filesystem::remove(png_); }

    std::filesystem::path png_ = temporary_file("etendue-integrator-filtering.png");
};

// Measured: 0.032 with filtering near the horizon and 0.49 without; 0.14 and 0.47 over all rows, where one sample in a
// pixel that shows an edge cannot know how much of it each side covers.
TEST_F(TextureAliasing, OneSampleAPixelShowsWhatAThousandShow) {
    const World filtered = compile(plain());
    const World unfiltered = compile(without_mip_levels(plain()));
    const auto error_of = [](const World& world, const World& truth, const PixelRect& window, std::uint32_t spp) {
        return rms(render(world, window, spp), render(truth, window, 1024));
    };
    EXPECT_LT(error_of(filtered, unfiltered, kNearHorizon, 1), 0.06);
    EXPECT_GT(error_of(unfiltered, unfiltered, kNearHorizon, 1), 0.3);
    EXPECT_LT(error_of(filtered, unfiltered, kBelowHorizon, 1), 0.2);
    // What the filter blurs beyond the pixel.
    EXPECT_LT(error_of(filtered, unfiltered, kBelowHorizon, 1024), 0.1);
}

// The board behind the camera, seen in a mirror before it: the cone must pass through the mirror and go on growing.
TEST_F(TextureAliasing, MirrorsShowTheSame) {
    const auto in_mirror = [](SceneDesc scene) {
        MaterialDesc mirror;
        mirror.override_model = ConductorDesc{"", 0.0f};
        add_object(scene, quad({0, 0, -1}, {9, 0, 0}, {0, 9, 0}), add_material(scene, mirror));
        scene.instances[0].to_world = scaling({1, 1, -1});
        return scene;
    };
    const World filtered = compile(in_mirror(plain()));
    const World unfiltered = compile(without_mip_levels(in_mirror(plain())));
    const std::vector<Rgb> reference = render(unfiltered, kNearHorizon, 1024);
    EXPECT_LT(rms(render(filtered, kNearHorizon, 1), reference), 0.06);
    EXPECT_GT(rms(render(unfiltered, kNearHorizon, 1), reference), 0.3);
}

TEST_F(TextureAliasing, BothWaysToHoldTexturesGiveOnePicture) {
    SceneDesc scene = plain();
    const World resident = compile(scene);
    scene.settings.texture_memory = 0;
    const World cached = compile(std::move(scene));
    EXPECT_LT(rms(render(cached, kBelowHorizon, 4), render(resident, kBelowHorizon, 4)), 1.0 / 255.0);
}

/// A room of textured walls that reflect half of the light between black and white squares and emit evenly.
class TexturedFurnace : public TextureAliasing {
  protected:
    SceneDesc room() {
        SceneDesc scene = empty_scene();
        add_texture(scene, png_, 8, checkerboard(8));
        MaterialDesc wall;
        wall.metallic = 0.0f;
        wall.base_color = Rgb(0.9f);
        wall.base_color_texture.texture = {0};
        wall.base_color_texture.transform.scale = {7.3f, 5.1f};
        wall.emissive = Rgb(0.5f);
        PrimitiveDesc inside = sphere(Vec3f(0.0f), 2.0f, 12);
        for (auto& triangle : inside.triangles) std::swap(triangle[1], triangle[2]);
        for (Vec3f& n : inside.normals) n = -n;
        add_object(scene, std::move(inside), add_material(scene, wall));
        return scene;
    }
};

// Filtering behind bounces must not change what arrives: 5 standard errors of 8 repetitions, false alarms below 1e-4
// each, and a bias of half a percent.
TEST_F(TexturedFurnace, FilteringDoesNotChangeTheMean) {
    const PathIntegrator path({.lengths = {6, 2, 6}});
    const TileResult filtered = render_tile(compile(room()), path, 512);
    const TileResult unfiltered = render_tile(compile(without_mip_levels(room())), path, 512);
    EXPECT_NEAR(filtered.mean.g, unfiltered.mean.g,
                5.0 * std::hypot(filtered.error, unfiltered.error) + 0.005 * static_cast<double>(unfiltered.mean.g));
}

// Textured light on a textured wall: both ways to find it must see the same textures, whatever the cone. Tolerance and
// false alarms as above, without a bias.
TEST_F(TexturedFurnace, StrategiesAgreeUnderTexturedLight) {
    SceneDesc scene = empty_scene();
    add_texture(scene, png_, 8, checkerboard(8));
    MaterialDesc wall;
    wall.metallic = 0.3f;
    wall.roughness = 0.4f;
    wall.base_color_texture = {.texture = {0}, .transform = {.scale = {9.0f, 9.0f}}};
    add_object(scene, quad({0, 0, -3}, {4, 0, 0}, {0, 4, 0}), add_material(scene, wall));
    MaterialDesc lamp = emissive(Rgb(8.0f));
    lamp.emissive_texture = {.texture = {0}, .transform = {.scale = {3.0f, 3.0f}}};
    add_object(scene, quad({0, 0.5f, -1}, {0, 0, -0.7f}, {0.7f, 0, 0}), add_material(scene, lamp));
    const World world = compile(std::move(scene));
    const auto edges_of_two = [](bool sample_lights) {
        return PathIntegrator({.lengths = {3, 2, 8}, .light_samples = sample_lights ? 1u : 0u});
    };
    const TileResult by_mis = render_tile(world, edges_of_two(true), 1024);
    const TileResult by_chance = render_tile(world, edges_of_two(false), 8192);
    EXPECT_GT(by_mis.mean.g, 0.01f);
    EXPECT_NEAR(by_mis.mean.g, by_chance.mean.g, 5.0 * std::hypot(by_mis.error, by_chance.error));
}

}  // namespace

}  // namespace etendue::test
