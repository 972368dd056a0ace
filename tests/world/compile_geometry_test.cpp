#include "world/compile_parts.h"
#include "world/test_scene.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(CompileGeometry, MeshesPlacedOnceAreBakedAndSharedOnesStored) {
    SceneDesc scene = empty_scene();
    Random random(1);
    PrimitiveDesc once = soup(random, 10, 0.3f);
    PrimitiveDesc often = soup(random, 7, 0.3f);
    once.material = often.material = add_material(scene, diffuse(Rgb(0.5f)));
    PrimitiveDesc never = soup(random, 100, 0.3f);
    never.material = once.material;
    place(scene, add_mesh(scene, {once}), translation({1, 0, 0}));
    (void)add_mesh(scene, {never});
    const auto shared = add_mesh(scene, {often});
    for (int i = 0; i < 4; ++i) place(scene, shared, translation({0, 0, static_cast<float>(i)}));

    const WorldStatistics s = compile(std::move(scene)).statistics();
    EXPECT_EQ(s.triangles, 17u);
    EXPECT_EQ(s.instanced_triangles, 10u + 4u * 7u);
    EXPECT_EQ(s.instances, 5u);
    EXPECT_GT(s.bvh_bytes, 0u);
    EXPECT_GE(s.geometry_bytes, 17u * (3 * 12 + 3 * 12 + 12));
    EXPECT_GE(s.instance_bytes, 5u * sizeof(Instance));
    EXPECT_GE(s.material_bytes, sizeof(Material));
}

TEST(CompileGeometry, BoundsHoldEverythingThatIsPlaced) {
    Random random(2);
    SceneDesc scene = empty_scene();
    PrimitiveDesc ball = sphere(Vec3f(0.0f), 1.0f, 12);
    ball.material = add_material(scene, diffuse(Rgb(0.5f)));
    const auto shared = add_mesh(scene, {ball});
    place(scene, add_mesh(scene, {ball}), translation({4, 0, 0}));
    const Mat4f transforms[] = {random_transform(random, false), random_transform(random, true)};
    for (const Mat4f& m : transforms) place(scene, shared, m);
    const World world = compile(std::move(scene));
    const Bounds& bounds = world.bounds();
    const auto inside = [&](const Vec3f& p) {
        for (int axis = 0; axis < 3; ++axis)
            if (p[axis] < bounds.min[axis] - 1e-4f || p[axis] > bounds.max[axis] + 1e-4f) return false;
        return true;
    };
    for (const Vec3f& p : ball.positions) {
        EXPECT_TRUE(inside(p + Vec3f(4, 0, 0)));
        for (const Mat4f& m : transforms) EXPECT_TRUE(inside(transform_point(m, p)));
    }
    EXPECT_NEAR(world.bounding_radius(), 0.5f * length(bounds.size()), 1e-5f);
}

}  // namespace

}  // namespace etendue::test
