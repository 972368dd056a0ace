// Where a ball lens brings rays together, and how fast facets come near it.
#include "core/ray_cone.h"
#include "world/contacts.h"
#include "world/test_scene.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Refracts the unit direction `d` at the unit normal `n` on its side by Snell's law; `ratio` is the index before over
/// that behind.
Vec3d refract(const Vec3d& d, const Vec3d& n, double ratio) {
    const double cosine = -d.dot(n);
    const double inside = std::sqrt(1.0 - ratio * ratio * (1.0 - cosine * cosine));
    return d * ratio + n * (ratio * cosine - inside);
}

/// Where on its axis, z, the ball of radius 1 and this index brings a ray parallel to it and `height` metres from it,
/// by the surface that the world has where the ray meets it.
double focus_of(const World& world, double index, float height) {
    Ray ray{.origin = {height, 0.0f, -5.0f}, .direction = {0.0f, 0.0f, 1.0f}};
    Vec3d direction(0.0, 0.0, 1.0);
    for (int surface = 0; surface < 2; ++surface) {
        const Hit hit = intersect(world, ray);
        const SurfacePoint point = world.geometry().surface_point(hit);
        const Vec3d n(point.shading.normal);
        direction = surface == 0 ? refract(direction, n, 1.0 / index) : refract(direction, -n, index);
        ray.direction = Vec3f(direction);
        ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, ray.direction);
    }
    const Vec3d origin(ray.origin);
    return origin.z - origin.x / direction.x * direction.z;
}

World ball_of(const PrimitiveDesc& primitive) {
    SceneDesc scene = empty_scene();
    add_object(scene, primitive, add_material(scene, diffuse(Rgb(0.5f))));
    return compile(std::move(scene));
}

// Paraxial optics: n R / (2 (n - 1)) from the middle. The spherical aberration at height h goes with h².
TEST(ShapeFocus, IsWhereParaxialOpticsHasIt) {
    const World world = ball_of(exact(ShapeKind::Sphere, Vec3f(1.0f)));
    for (const double index : {1.33, 1.5, 1.8}) {
        const double expected = index / (2.0 * (index - 1.0));
        const double near = expected - focus_of(world, index, 0.02f);
        const double twice = expected - focus_of(world, index, 0.04f);
        EXPECT_NEAR(near, 0.0, 1.5e-3) << index;
        EXPECT_NEAR(twice / near, 4.0, 0.1) << index;
    }
}

// Of smooth facets, whose normals are exact at corners: the error of the focus falls with the square of their size.
TEST(ShapeFocus, IsWhatFinerAndFinerFacetsComeTo) {
    constexpr double kIndex = 1.5;
    const World exactly = ball_of(exact(ShapeKind::Sphere, Vec3f(1.0f)));
    double before = 0.0;
    for (const int rings : {16, 32, 64, 128}) {
        const World facets = ball_of(sphere(Vec3f(0.0f), 1.0f, rings));
        double error = 0.0;
        constexpr int kRays = 200;
        for (int i = 0; i < kRays; ++i) {
            const float height = 0.3f + 0.3f * (static_cast<float>(i) + 0.37f) / kRays;
            error += std::abs(focus_of(facets, kIndex, height) - focus_of(exactly, kIndex, height)) / kRays;
        }
        RecordProperty("focus_error_" + std::to_string(rings), std::to_string(error));
        // What docs/shapes.md says.
        if (rings == 16) {
            EXPECT_NEAR(error, 0.0053, 0.2 * 0.0053);
        }
        if (rings == 128) {
            EXPECT_NEAR(error, 0.00008, 0.2 * 0.00008);
        }
        if (before > 0.0) {
            EXPECT_NEAR(std::log2(before / error), 2.0, 0.4) << rings;
        }
        before = error;
    }
}

}  // namespace

}  // namespace etendue::test
