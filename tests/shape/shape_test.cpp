// Exact shapes, held against their equations.

#include "shape/shape.h"

#include "core/position_error.h"
#include "support/random.h"

#include <cmath>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

constexpr ShapeKind kKinds[] = {ShapeKind::Sphere, ShapeKind::Disk, ShapeKind::Cylinder};

Vec3f random_vector(Random& random, float size) {
    const auto number = [&] { return size * (2.0f * random.next() - 1.0f); };
    const float x = number();
    const float y = number();
    return {x, y, number()};
}

Mat4f random_affine(Random& random) {
    Mat4f m;
    for (int row = 0; row < 4; ++row) {
        const Vec3f v = random_vector(random, row < 3 ? 1.0f : 5.0f);
        for (int i = 0; i < 3; ++i) m[row][i] = v[i] + (row == i ? 1.5f : 0.0f);
    }
    return m;
}

double of(float v) {
    return static_cast<double>(v);
}

/// How far a point is from the surface of the unit shape, in its space: negative inside.
double height(ShapeKind kind, const Vec3d& p) {
    if (kind == ShapeKind::Sphere) return p.length() - 1.0;
    if (kind == ShapeKind::Disk) return std::max(std::abs(p.z), std::hypot(p.x, p.y) - 1.0);
    return std::max(std::hypot(p.x, p.z) - 1.0, std::abs(p.y) - 1.0);
}

ShapePlace random_place(const ExactShape& shape, Random& random) {
    const auto face = static_cast<std::uint32_t>(random.next() * static_cast<float>(shape.face_count()));
    return shape.sample(face, random.next_2d());
}

// As far as position_error.h says that rounding moves points: what rays need to start off the surface.
TEST(Shape, HasItsPointsWithinRoundingOfItsSurface) {
    Random random(1);
    for (const ShapeKind kind : kKinds)
        for (int i = 0; i < 3000; ++i) {
            const Mat4f to_world = random_affine(random);
            const ExactShape shape(kind, to_world);
            const ShapePoint point = shape.point(random_place(shape, random));
            const Bounds box = shape.bounds();
            const Vec3f error = position_error(max_components(abs_components(box.min), abs_components(box.max)));
            const float clear = clearance(point.normal, error);
            EXPECT_NEAR(length(point.normal), 1.0f, 1e-6f);
            // Beyond the clearance on both sides, the exact surface is passed.
            const double outside = height(kind, shape.to_unit(point.position + point.normal * clear));
            EXPECT_GT(outside, 0.0) << shape_name(kind);
            if (!is_flat(kind)) {
                const double inside = height(kind, shape.to_unit(point.position - point.normal * clear));
                EXPECT_LT(inside, 0.0) << shape_name(kind);
            }
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_GE(point.position[axis], box.min[axis]);
                EXPECT_LE(point.position[axis], box.max[axis]);
            }
        }
}

TEST(Shape, IsCrossedWhereThePointsAre) {
    Random random(2);
    for (const ShapeKind kind : kKinds)
        for (const float distance : {1.0f, 1000.0f})
            for (int i = 0; i < 2000; ++i) {
                const ExactShape shape(kind, random_affine(random));
                const ShapePoint target = shape.point(random_place(shape, random));
                const Vec3f origin = target.position + random_vector(random, distance);
                const Vec3f direction = normalize(target.position - origin);
                const ShapeCrossings crossings = shape.crossings(origin, direction);
                for (std::size_t c = 0; c < crossings.count; ++c) {
                    const ShapeCrossing& crossing = crossings.all[c];
                    const ShapePoint point = shape.point(crossing.place);
                    const Vec3d on_line = Vec3d(origin) + Vec3d(direction) * crossing.t;
                    // The line's direction is rounded, too, and edges are where they are.
                    EXPECT_LT((on_line - Vec3d(point.position)).length(), 2e-5) << shape_name(kind);
                    EXPECT_NEAR(std::abs(dot(normalize(crossing.normal), point.normal)), 1.0f, 1e-5f);
                    EXPECT_EQ(crossing.is_from_back, dot(direction, crossing.normal) > 0.0f);
                    if (c > 0) {
                        EXPECT_LE(crossings.all[0].t, crossing.t);
                    }
                }
            }
}

TEST(Shape, IsMetByEveryLineToItsInside) {
    Random random(3);
    for (const ShapeKind kind : kKinds)
        for (int i = 0; i < 3000; ++i) {
            const Mat4f to_world = random_affine(random);
            const ExactShape shape(kind, to_world);
            Vec3f inside = random_vector(random, 0.57f);
            if (is_flat(kind)) inside.z = 0.0f;
            const Vec3f target = transform_point(to_world, inside);
            const Vec3f direction = random_vector(random, 1.0f);
            const ShapeCrossings crossings = shape.crossings(target - direction * 20.0f, direction);
            EXPECT_EQ(crossings.count, is_flat(kind) ? 1u : 2u) << shape_name(kind);
        }
}

TEST(Shape, HasDerivativesOfItsTextureCoordinates) {
    Random random(4);
    constexpr float kStep = 1e-2f;
    for (const ShapeKind kind : kKinds)
        for (int i = 0; i < 500; ++i) {
            const ExactShape shape(kind, random_affine(random));
            const ShapePlace place = random_place(shape, random);
            ShapePlace beside = place;
            beside.at += Vec2f(kStep * (random.next() - 0.5f), kStep * (random.next() - 0.5f));
            const ShapePoint a = shape.point(place);
            const ShapePoint b = shape.point(beside);
            const Vec2f by = b.uv - a.uv;
            // Around the poles and over the seam, coordinates change by more than steps are for.
            if (std::abs(by.x) > 0.02f || std::abs(a.uv.y - 0.5f) > 0.4f) continue;
            const Vec3f moved = b.position - a.position;
            EXPECT_LT(length(moved - a.along_u * by.x - a.along_v * by.y), 2e-3f) << shape_name(kind);
            EXPECT_NEAR(dot(normalize(a.along_u), a.normal), 0.0f, 1e-5f);
            EXPECT_NEAR(dot(normalize(a.along_v), a.normal), 0.0f, 1e-5f);
            EXPECT_EQ(a.uv, shape.uv(place));
        }
}

// v is downwards and u to the right as one looks at the front with +y up.
TEST(Shape, ShowsItsTextureUprightOnItsFront) {
    for (const ShapeKind kind : kKinds) {
        const ExactShape shape(kind, Mat4f());
        const ShapePoint point = shape.point(kind == ShapeKind::Sphere     ? ExactShape::sphere_place({0.0, 0.0, 1.0})
                                             : kind == ShapeKind::Cylinder ? ShapePlace{0, {1.0f, 0.0f}}
                                                                           : ShapePlace{});
        EXPECT_NEAR(point.uv.x, 0.5f, 1e-6f) << shape_name(kind);
        EXPECT_NEAR(point.uv.y, 0.5f, 1e-6f) << shape_name(kind);
        const Vec3f right = cross(Vec3f(0.0f, 1.0f, 0.0f), point.normal);
        EXPECT_NEAR(dot(normalize(point.along_u), right), 1.0f, 1e-6f) << shape_name(kind);
        EXPECT_NEAR(normalize(point.along_v).y, -1.0f, 1e-6f) << shape_name(kind);
    }
}

TEST(Shape, KnowsItsCurvatureAreaAndVolume) {
    Mat4f twice;
    twice.setScale(2.0f);
    const ExactShape unit(ShapeKind::Sphere, Mat4f());
    EXPECT_NEAR(unit.mean_curvature({0, {0.3f, -0.4f}}, twice), 0.5f, 1e-6f);
    EXPECT_NEAR(of(static_cast<float>(unit.placed(twice).volume())), 32.0 / 3.0 * of(kPi), 1e-4);
    EXPECT_NEAR(of(static_cast<float>(unit.placed(twice).area(0))), 16.0 * of(kPi), 1e-4);
    const ExactShape tube(ShapeKind::Cylinder, twice);
    EXPECT_NEAR(tube.mean_curvature({0, {0.3f, 0.5f}}, Mat4f()), 0.25f, 1e-6f);
    EXPECT_EQ(tube.mean_curvature({1, {0.3f, 0.5f}}, Mat4f()), 0.0f);
    EXPECT_NEAR(tube.area(0) + tube.area(1) + tube.area(2), 24.0 * of(kPi), 1e-4);
    // At the end of the long axis of an ellipsoid with axes 2, 1 and 1 both curvatures are a / b².
    Mat4f longer;
    longer.setScale(Vec3f(2.0f, 1.0f, 1.0f));
    EXPECT_NEAR(unit.mean_curvature(ExactShape::sphere_place({1.0, 0.0, 0.0}), longer), 2.0f, 1e-6f);
    EXPECT_TRUE(unit.placed(twice).is_round());
    EXPECT_FALSE(unit.placed(longer).is_round());
}

}  // namespace
}  // namespace etendue::test
