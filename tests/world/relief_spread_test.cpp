// Relief as roughness: closed forms, sums over tilted normals, and what a surface point makes of it.
#include "world/relief_spread.h"

#include "support/random.h"
#include "world/test_scene.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(RoughnessAxes, OfIsotropicSurfacesAreThoseOfTheRelief) {
    // Variances 0.08 along 30 degrees and 0.02 across.
    const float c = std::cos(kPi / 6.0f);
    const float s = std::sin(kPi / 6.0f);
    const SlopeCovariance covariance{0.08f * c * c + 0.02f * s * s, 0.06f * c * s, 0.08f * s * s + 0.02f * c * c};
    for (const float alpha : {0.0f, 0.5f}) {
        const RoughnessAxes axes = roughness_axes({alpha, alpha}, covariance);
        EXPECT_NEAR(axes.direction.x, c, 1e-5f);
        EXPECT_NEAR(axes.direction.y, s, 1e-5f);
        EXPECT_NEAR(axes.added_variance.x, 0.08f, 1e-6f);
        EXPECT_NEAR(axes.added_variance.y, 0.02f, 1e-6f);
    }
}

TEST(RoughnessAxes, ReliefAcrossTheGrainTurnsTheAxes) {
    // Own variances of slopes are 0.08 and 0.02; 0.1 along y outdoes what x has.
    const RoughnessAxes axes = roughness_axes({0.4f, 0.2f}, {0.0f, 0.0f, 0.1f});
    EXPECT_NEAR(axes.direction.x, 0.0f, 1e-6f);
    EXPECT_NEAR(std::abs(axes.direction.y), 1.0f, 1e-6f);
    EXPECT_NEAR(0.08f + axes.added_variance.x, 0.12f, 1e-6f);
    EXPECT_NEAR(0.02f + axes.added_variance.y, 0.08f, 1e-6f);
    // Along the grain it turns nothing.
    const RoughnessAxes along = roughness_axes({0.4f, 0.2f}, {0.03f, 0.0f, 0.0f});
    EXPECT_NEAR(along.direction.x, 1.0f, 1e-6f);
    EXPECT_NEAR(along.added_variance.x, 0.03f, 1e-6f);
    EXPECT_NEAR(along.added_variance.y, 0.0f, 1e-6f);
}

// Normals around a mean that is tilted in one frame, measured in another whose z is that mean.
TEST(TiltedSlopes, AreThoseOfTheSameNormalsInTheOtherFrame) {
    Random random(12);
    for (int i = 0; i < 20; ++i) {
        const Frame from = Frame::from_normal(random_direction(random));
        const Vec2f mean(random.next() - 0.5f, 1.2f * random.next() - 0.6f);
        const Frame to =
            Frame::from_normal_and_tangent(normalize(from.to_world({mean.x, mean.y, 1.0f})), random_direction(random));
        // Eight slopes around the mean, so close that first order holds.
        const float radius = 1e-2f;
        SlopeCovariance before;
        SlopeCovariance after;
        for (int k = 0; k < 8; ++k) {
            const float angle = kPi * static_cast<float>(k) / 4.0f;
            const Vec2f d(radius * std::cos(angle), 0.4f * radius * std::sin(angle + 0.5f));
            const Vec3f n = to.to_local(from.to_world({mean.x + d.x, mean.y + d.y, 1.0f}));
            const Vec2f t(n.x / n.z, n.y / n.z);
            before = {before.xx + d.x * d.x / 8, before.xy + d.x * d.y / 8, before.yy + d.y * d.y / 8};
            after = {after.xx + t.x * t.x / 8, after.xy + t.x * t.y / 8, after.yy + t.y * t.y / 8};
        }
        const SlopeCovariance made = tilted(before, from, to);
        EXPECT_NEAR(made.xx, after.xx, 3e-7f);
        EXPECT_NEAR(made.xy, after.xy, 3e-7f);
        EXPECT_NEAR(made.yy, after.yy, 3e-7f);
    }
}

/// A square of 2 m whose normal map has grooves of single texels across u, 64 × 64, with slopes of ±0.5.
class GroovedSurface : public testing::Test {
  protected:
    World world_of(MaterialDesc material, const Vec4f& tangent = {1.0f, 0.0f, 0.0f, 1.0f}) {
        SceneDesc scene = empty_scene();
        std::vector<std::array<int, 4>> texels(std::size_t{64} * 64);
        for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = {i % 2 == 0 ? 185 : 70, 128, 242, 255};
        add_texture(scene, png_, 64, texels);
        PrimitiveDesc square = quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0});
        square.tangents.assign(4, tangent);
        add_object(scene, std::move(square), add_material(scene, std::move(material)));
        return compile(std::move(scene));
    }
    /// `width` is that of the ray, in texels.
    static SurfacePoint point_of(const World& world, float width) {
        const Ray ray{.origin = {0.01f, 0.01f, 0}, .direction = {0, 0, -1}};
        return world.geometry().surface_point(intersect(world, ray), ray, {width / 32.0f, 0.0f});
    }
    static Bsdf lobe_of(const World& world, const SurfacePoint& point) {
        Bsdf storage;
        return world.materials().bsdf(point, {0, 0, 1}, 0.0f, storage);
    }
    void TearDown() override { std::filesystem::remove(png_); }

    std::filesystem::path png_ = temporary_file("etendue-world-grooves.png");
    static constexpr float kVariance = 0.0841f;  ///< (57.5 / 114.5)² / 3, interpolated
};

MaterialDesc grooved(float roughness, float scale = 1.0f) {
    MaterialDesc material;
    material.roughness = roughness;
    material.normal_texture.texture = {0};
    material.normal_scale = scale;
    return material;
}

TEST_F(GroovedSurface, IsRoughAcrossItsGroovesOnly) {
    const World world = world_of(grooved(0.5f, 0.5f));
    const SurfacePoint point = point_of(world, 6.0f);
    const auto lobe = std::get<MetallicRoughness>(lobe_of(world, point));
    EXPECT_NEAR(lobe.alpha_x, std::sqrt(0.0625f + 2.0f * 0.25f * kVariance), 3e-3f);
    EXPECT_NEAR(lobe.alpha_y, 0.25f, 1e-4f);
    EXPECT_NEAR(std::abs(point.shading.tangent.x), 1.0f, 1e-4f);
    // A point sees one groove.
    const auto narrow = std::get<MetallicRoughness>(lobe_of(world, point_of(world, 0.5f)));
    EXPECT_EQ(narrow.alpha_x, 0.25f);
    EXPECT_FALSE(point_of(world, 0.5f).has_spread_slopes());
}

// The map's x lies along the tangent, wherever that points, mirrored or not.
TEST_F(GroovedSurface, TurnsWithTheTangent) {
    for (const float sign : {1.0f, -1.0f}) {
        const World world = world_of(grooved(0.5f), {0.6f, 0.8f, 0.0f, sign});
        EXPECT_NEAR(std::abs(dot(point_of(world, 6.0f).shading.tangent, {0.6f, 0.8f, 0.0f})), 1.0f, 1e-4f);
    }
}

TEST_F(GroovedSurface, MirrorsAndGlassBecomeRough) {
    const World mirror = world_of(grooved(0.0f));
    EXPECT_FALSE(has_non_delta(lobe_of(mirror, point_of(mirror, 0.5f))));
    EXPECT_TRUE(has_non_delta(lobe_of(mirror, point_of(mirror, 6.0f))));
    MaterialDesc conductor = grooved(0.0f);
    conductor.override_model = ConductorDesc{"", 0.0f};
    const World metal = world_of(conductor);
    EXPECT_TRUE(std::holds_alternative<RoughConductor>(lobe_of(metal, point_of(metal, 6.0f))));
    EXPECT_TRUE(std::holds_alternative<SmoothConductor>(lobe_of(metal, point_of(metal, 0.5f))));
}

// Light goes through a thin pane without being bent, whatever its normal: shadow rays count on it.
TEST_F(GroovedSurface, ThinPanesStaySmooth) {
    MaterialDesc pane = grooved(0.0f);
    pane.metallic = 0.0f;
    pane.transmission = 1.0f;
    const World world = world_of(pane);
    EXPECT_FALSE(point_of(world, 6.0f).has_spread_slopes());
    EXPECT_FALSE(has_non_delta(lobe_of(world, point_of(world, 6.0f))));
}

TEST_F(GroovedSurface, CoatsHaveReliefOfTheirOwn) {
    MaterialDesc coated = grooved(0.5f);
    coated.clearcoat.factor = 1.0f;
    coated.clearcoat.roughness = 0.3f;
    const World base = world_of(coated);
    EXPECT_EQ(std::get<LayeredSurface>(lobe_of(base, point_of(base, 6.0f))).coat.alpha, 0.3f * 0.3f);
    std::swap(coated.clearcoat.normal_texture, coated.normal_texture);
    const World coat = world_of(coated);
    const auto lobe = std::get<LayeredSurface>(lobe_of(coat, point_of(coat, 6.0f)));
    EXPECT_NEAR(lobe.coat.alpha, std::sqrt(0.0081f + kVariance), 3e-3f);
    EXPECT_FLOAT_EQ(std::get<MetallicRoughness>(lobe.base).alpha_x, 0.25f);
}

// The grain of a brushed metal lies along the tangent, its grooves across: both widen what is rougher already.
TEST_F(GroovedSurface, AddsToAnAnisotropyOfTheMaterial) {
    MaterialDesc brushed = grooved(0.5f);
    brushed.anisotropy.strength = 0.5f;
    const auto axes_of = [&](float rotation) {
        brushed.anisotropy.rotation = rotation;
        const World world = world_of(brushed);
        const SurfacePoint point = point_of(world, 6.0f);
        const auto lobe = std::get<MetallicRoughness>(lobe_of(world, point));
        return std::array{lobe.alpha_x, lobe.alpha_y, std::abs(point.shading.tangent.x)};
    };
    const float own_x = 0.25f + 0.75f * 0.25f;
    const auto along = axes_of(0.0f);
    EXPECT_NEAR(along[0], std::sqrt(own_x * own_x + 2.0f * kVariance), 3e-3f);
    EXPECT_NEAR(along[1], 0.25f, 1e-4f);
    const auto across = axes_of(0.5f * kPi);
    EXPECT_NEAR(across[0], std::sqrt(0.0625f + 2.0f * kVariance), 3e-3f);
    EXPECT_NEAR(across[1], own_x, 1e-4f);
    EXPECT_NEAR(across[2], 1.0f, 1e-4f);
}

}  // namespace

}  // namespace etendue::test
