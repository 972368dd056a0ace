// Relief below the size of a pixel: an image at an eighth of the size must be the average of the large one.
#include "integrator/path/path_integrator.h"
#include "integrator/render_tile.h"
#include "support/random.h"
#include "world/test_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kLarge = 256;  ///< pixels and texels a side: one texel a pixel
constexpr int kShrink = 8;
constexpr int kSmall = kLarge / kShrink;
constexpr int kBlocks = 4;  ///< a side, in which images are compared

const PathIntegrator kReliefPath({.lengths = {2, 1, 8}});

/// A pair of slopes at each texel, row by row.
using Slopes = std::vector<Vec2f>;

/// A normal number, near enough: the sum of twelve even ones.
float normal_number(Random& random) {
    float sum = -6.0f;
    for (int i = 0; i < 12; ++i) sum += random.next();
    return sum;
}

/// Grooves across x, each a texel wide. Every eight have the eighths of a normal distribution, in any order, so that
/// all pixels of the small image are alike: what its filter blurs beyond them does not matter.
Slopes grooves(float deviation) {
    std::array<float, kShrink> eighths{-1.534f, -0.887f, -0.489f, -0.157f, 0.157f, 0.489f, 0.887f, 1.534f};
    Random random(3);
    std::vector<float> row;
    while (row.size() < kLarge) {
        for (std::size_t i = eighths.size() - 1; i > 0; --i)
            std::swap(eighths[i], eighths[static_cast<std::size_t>(random.next() * static_cast<float>(i + 1))]);
        for (const float slope : eighths) row.push_back(deviation * slope);
    }
    Slopes slopes;
    for (int i = 0; i < kLarge * kLarge; ++i) slopes.emplace_back(row[static_cast<std::size_t>(i % kLarge)], 0.0f);
    return slopes;
}

/// Bumps that are alike in all directions.
Slopes bumps(float deviation, std::uint32_t seed) {
    Random random(seed);
    Slopes slopes(kLarge * kLarge);
    for (Vec2f& slope : slopes) {
        slope.x = deviation * normal_number(random);
        slope.y = deviation * normal_number(random);
    }
    return slopes;
}

class ReliefBelowPixels : public testing::Test {
  protected:
    Handle<TextureDesc> add_normal_map(SceneDesc& scene, const std::string& name, const Slopes& slopes) {
        std::vector<std::array<int, 4>> texels;
        const auto encoded = [](float v) { return static_cast<int>(std::lround(127.5f + 127.5f * v)); };
        for (const Vec2f& slope : slopes) {
            const Vec3f n = normalize(Vec3f(slope.x, slope.y, 1.0f));
            texels.push_back({encoded(n.x), encoded(n.y), encoded(n.z), 255});
        }
        files_.push_back(temporary_file("etendue-relief-" + name + ".png"));
        return add_texture(scene, files_.back(), kLarge, texels);
    }

    /// A square that fills the image, under a lamp that it shows in its middle, and a second one beside that.
    static SceneDesc lit(SceneDesc scene, MaterialDesc material) {
        scene.cameras[0].yfov = 2.0f * std::atan(1.0f / 3.0f);
        PrimitiveDesc square = quad({0, 0, -3}, {1, 0, 0}, {0, 1, 0});
        square.tangents.assign(4, {1.0f, 0.0f, 0.0f, 1.0f});
        add_object(scene, std::move(square), add_material(scene, std::move(material)));
        const auto lamp = add_material(scene, emissive(Rgb(5.0f)));
        add_object(scene, quad({0.5f, 0.9f, 0.2f}, {0, 1.2f, 0}, {1.2f, 0, 0}), lamp);
        add_object(scene, quad({-2.5f, -0.4f, -1.5f}, {0.3f, 0, -0.6f}, {0, 0.6f, 0}), lamp);
        return scene;
    }

    /// Largest relative difference between the means of blocks, and between those of the whole images.
    struct Difference {
        double whole = 0.0;
        double block = 0.0;
    };
    using Means = std::array<double, kBlocks * kBlocks>;
    static Means means(const World& world, int size, std::uint32_t spp) {
        const std::vector<Rgb> pixels = render_pixels(world, kReliefPath, {0, 0, size, size}, size, size, spp);
        Means sums{};
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const int block = y * kBlocks / size * kBlocks + x * kBlocks / size;
                const int pixel = y * size + x;
                sums[static_cast<std::size_t>(block)] +=
                    static_cast<double>(pixels[static_cast<std::size_t>(pixel)].g) / (size * size);
            }
        return sums;
    }
    static Difference compare(const Means& small, const Means& large) {
        Difference difference;
        double sum_large = 0.0;
        double sum_small = 0.0;
        for (std::size_t i = 0; i < large.size(); ++i) {
            difference.block = std::max(difference.block, std::abs(small[i] / large[i] - 1.0));
            sum_large += large[i];
            sum_small += small[i];
        }
        difference.whole = std::abs(sum_small / sum_large - 1.0);
        RecordProperty("whole", std::to_string(difference.whole));
        RecordProperty("block", std::to_string(difference.block));
        return difference;
    }
    static void expect_average(SceneDesc scene) {
        const World world = compile(std::move(scene));
        const Difference difference =
            compare(means(world, kSmall, kSamples * kShrink * kShrink), means(world, kLarge, kSamples));
        EXPECT_LT(difference.whole, 0.03);
        EXPECT_LT(difference.block, 0.03);
    }
    void TearDown() override {
        for (const std::filesystem::path& file : files_) std::filesystem::remove(file);
    }

    static constexpr std::uint32_t kSamples = 8;  ///< a pixel of the large image
    std::vector<std::filesystem::path> files_;
};

TEST_F(ReliefBelowPixels, GroovesOfMetalAreRoughAcross) {
    SceneDesc scene = empty_scene();
    MaterialDesc material;
    material.roughness = 0.45f;
    material.normal_texture.texture = add_normal_map(scene, "grooves", grooves(0.15f));
    expect_average(lit(std::move(scene), material));
}

TEST_F(ReliefBelowPixels, BumpsOfMetalAreRough) {
    SceneDesc scene = empty_scene();
    MaterialDesc material;
    material.roughness = 0.45f;
    material.normal_texture.texture = add_normal_map(scene, "bumps", bumps(0.1f, 5));
    expect_average(lit(std::move(scene), material));
}

// The samples are the same, so that what differs is the filtering alone.
TEST_F(ReliefBelowPixels, IsTheSameThroughTheCacheOfTiles) {
    SceneDesc scene = empty_scene();
    MaterialDesc material;
    material.roughness = 0.45f;
    material.normal_texture.texture = add_normal_map(scene, "cached", grooves(0.15f));
    scene = lit(std::move(scene), material);
    const World in_memory = compile(scene);
    scene.settings.texture_memory = 1;  // too little for the map
    const World cached = compile(std::move(scene));
    ASSERT_GT(cached.statistics().texture_cache_budget, 0u);
    const Difference difference = compare(means(cached, kSmall, 128), means(in_memory, kSmall, 128));
    EXPECT_LT(difference.whole, 0.003);
    EXPECT_LT(difference.block, 0.005);
}

TEST_F(ReliefBelowPixels, CoatsAreRoughByTheirOwn) {
    SceneDesc scene = empty_scene();
    MaterialDesc material;
    material.base_color = Rgb(0.05f);
    material.metallic = 0.0f;
    material.roughness = 0.5f;
    material.clearcoat.factor = 1.0f;
    material.clearcoat.roughness = 0.35f;
    material.normal_texture.texture = add_normal_map(scene, "base", bumps(0.1f, 7));
    material.clearcoat.normal_texture.texture = add_normal_map(scene, "coat", bumps(0.1f, 8));
    expect_average(lit(std::move(scene), material));
}

}  // namespace

}  // namespace etendue::test
