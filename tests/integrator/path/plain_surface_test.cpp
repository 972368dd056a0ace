// Surfaces that are set up and looked up many at a time look like those that are not.
#include "integrator/path/path_integrator.h"
#include "integrator/render_tile.h"
#include "world/test_scene.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kSize = 48;

std::vector<Rgb> render(const World& world) {
    return render_pixels(world, PathIntegrator({.lengths = {6, 1, 3}}), {0, 0, kSize, kSize}, kSize, kSize, 16);
}

class PlainSurfacesInPath : public testing::Test {
  protected:
    /// A textured floor and wall, a glossy sphere and a lamp under a sky. Some texels of the floor mirror. White vertex
    /// colours change nothing, but that surfaces are no longer plain.
    World room(bool plain) {
        SceneDesc scene = empty_scene();
        scene.environment.enabled = true;
        scene.environment.color = Rgb(0.3f);
        std::vector<std::array<int, 4>> colors;
        std::vector<std::array<int, 4>> roughness;
        for (int i = 0; i < 256; ++i) {
            colors.push_back({i, 255 - i / 2, (i * 37) % 256, 255});
            roughness.push_back({0, i % 5 == 0 ? 0 : 64 + i / 2, (i * 11) % 256, 255});
        }
        add_texture(scene, png_, 16, colors);
        add_texture(scene, data_png_, 16, roughness);
        MaterialDesc floor;
        floor.base_color_texture = {.texture = {0},
                                    .texcoord = 0,
                                    .transform = {.offset = {0.1f, 0.2f}, .rotation = 0.3f, .scale = {1.0f, 1.5f}}};
        floor.metallic_roughness_texture.texture = {1};
        MaterialDesc wall;
        wall.metallic = 0.0f;
        wall.base_color_texture.texture = {0};
        MaterialDesc ball;
        ball.roughness = 0.5f;
        ball.base_color = {0.8f, 0.5f, 0.2f};
        const auto add = [&](PrimitiveDesc primitive, MaterialDesc material) {
            if (!plain) primitive.colors.assign(primitive.positions.size(), {1, 1, 1, 0.5f});
            add_object(scene, std::move(primitive), add_material(scene, std::move(material)));
        };
        PrimitiveDesc ground = quad({0, -1, -3}, {4, 0, 0}, {0, 0, -4});
        for (Vec2f& uv : ground.uv0) uv *= 5.0f;
        add(std::move(ground), floor);
        add(quad({0, 1, -5}, {4, 0, 0}, {0, 3, 0}), wall);
        add(quad({-2, 0, -3}, {0, 0, -2}, {0, 2, 0}), diffuse(Rgb(0.6f)));
        add(sphere({0.5f, -0.3f, -3.5f}, 0.6f, 16), ball);
        add_object(scene, quad({0, 2.5f, -3}, {0.5f, 0, 0}, {0, 0, 0.5f}), add_material(scene, emissive(Rgb(12.0f))));
        return compile(std::move(scene));
    }
    void TearDown() override {
        std::filesystem::remove(png_);
        std::filesystem::remove(data_png_);
    }

    std::filesystem::path png_ = temporary_file("etendue-plain-color.png");
    std::filesystem::path data_png_ = temporary_file("etendue-plain-data.png");
};

TEST_F(PlainSurfacesInPath, LookLikeOthers) {
    const std::vector<Rgb> found = render(room(true));
    const std::vector<Rgb> expected = render(room(false));
    double relative = 0.0;
    double brightness = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (const auto& [a, b] : {std::pair(found[i].r, expected[i].r), std::pair(found[i].g, expected[i].g),
                                   std::pair(found[i].b, expected[i].b)}) {
            const double difference = static_cast<double>(a) - static_cast<double>(b);
            const auto value = static_cast<double>(b);
            relative += difference * difference / (value * value + 0.01) / static_cast<double>(3 * found.size());
            brightness += value / static_cast<double>(3 * found.size());
        }
    }
    // Roundings; where one decides how a path goes on, its sample is another one.
    EXPECT_LT(relative, 1e-5);
    EXPECT_GT(brightness, 0.1);
}

}  // namespace

}  // namespace etendue::test
