#include "world/compile_parts.h"
#include "world/test_scene.h"

#include <algorithm>
#include <set>

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

/// Two meshes placed several times, one of two primitives, with texture coordinates and mirrored.
SceneDesc repeated_meshes() {
    SceneDesc scene = empty_scene();
    Random random(11);
    PrimitiveDesc ball = sphere(Vec3f(0.0f), 0.5f, 6);
    PrimitiveDesc rest = soup(random, 20, 0.5f);
    ball.material = add_material(scene, diffuse(Rgb(0.5f)));
    rest.material = add_material(scene, emissive(Rgb(2.0f)));
    const auto small = add_mesh(scene, {ball, rest});
    PrimitiveDesc globe = sphere(Vec3f(0.0f), 0.4f, 16);
    globe.material = ball.material;
    const auto large = add_mesh(scene, {globe});
    for (int i = 0; i < 6; ++i) place(scene, i < 4 ? small : large, random_transform(random, i % 2 == 0));
    return scene;
}

TEST(CompileGeometry, CopiesAreWhatInstancesAre) {
    const World instanced = compile(repeated_meshes());
    const World copied = compile(repeated_meshes(), CompileOptions{});
    EXPECT_LT(instanced.statistics().triangles, instanced.statistics().instanced_triangles);
    EXPECT_EQ(copied.statistics().triangles, copied.statistics().instanced_triangles);
    EXPECT_EQ(copied.statistics().instanced_triangles, instanced.statistics().instanced_triangles);
    EXPECT_EQ(copied.statistics().instances, 6u);
    EXPECT_EQ(copied.statistics().lights, instanced.statistics().lights);
    Random random(12);
    std::set<std::uint32_t> places;
    for (int i = 0; i < 4000; ++i) {
        const Ray ray{.origin = random_direction(random) * 6.0f, .direction = random_direction(random)};
        const Hit of_instance = intersect(instanced, ray);
        const Hit of_copy = intersect(copied, ray);
        if (of_instance.valid() != of_copy.valid() || of_instance.triangle != of_copy.triangle) continue;  // an edge
        if (!of_copy.valid()) continue;
        places.insert(of_copy.instance);
        EXPECT_EQ(of_copy.instance, of_instance.instance);
        const SurfacePoint a = instanced.geometry().surface_point(of_instance);
        const SurfacePoint b = copied.geometry().surface_point(of_copy);
        EXPECT_NEAR(of_copy.t, of_instance.t, 1e-4f);
        EXPECT_LT(length(a.position - b.position), 1e-4f);
        EXPECT_GT(dot(a.geometric_normal, b.geometric_normal), 0.9999f);
        // Interpolated after the transform of each vertex or before that of the point: shear tells them apart.
        EXPECT_GT(dot(a.shading.normal, b.shading.normal), 0.99f);
        EXPECT_EQ(is_black(instanced.materials().emission(a, -ray.direction)),
                  is_black(copied.materials().emission(b, -ray.direction)));
        EXPECT_EQ(instanced.lights().at(a) == kNone, copied.lights().at(b) == kNone);
    }
    EXPECT_EQ(places.size(), 6u);
}

TEST(CompileGeometry, SmallMeshesAreCopiedAsLongAsCopiesAreFew) {
    const std::size_t all = compile(repeated_meshes()).statistics().instanced_triangles;
    const std::size_t stored = compile(repeated_meshes()).statistics().triangles;
    const std::size_t large = sphere(Vec3f(0.0f), 0.4f, 16).triangles.size();
    const std::size_t small = sphere(Vec3f(0.0f), 0.5f, 6).triangles.size() + 20;
    const auto copied = [&](std::size_t most) {
        return compile(repeated_meshes(), {.most_copied_triangles = most}).statistics().triangles - stored;
    };
    ASSERT_EQ(all - stored, 3 * small + large);
    const std::size_t fewer = std::min(3 * small, large);
    EXPECT_EQ(copied(fewer - 1), 0u);
    EXPECT_EQ(copied(fewer), fewer);
    EXPECT_EQ(copied(3 * small + large - 1), fewer);
    EXPECT_EQ(copied(3 * small + large), 3 * small + large);
}

TEST(CompileGeometry, MeshesThatDeformAreNotCopied) {
    SceneDesc scene = repeated_meshes();
    PrimitiveDesc& ball = scene.meshes[0].primitives[0];
    ball.motion.assign(2, VertexStep{ball.positions, ball.normals});
    const std::size_t stored = compile(repeated_meshes()).statistics().triangles;
    EXPECT_EQ(compile(std::move(scene), CompileOptions{}).statistics().triangles,
              stored + sphere(Vec3f(0.0f), 0.4f, 16).triangles.size());
}

TEST(CompileGeometry, MeshesThatMoveSomewhereAreNotCopied) {
    SceneDesc scene = repeated_meshes();
    const std::size_t stored = compile(repeated_meshes()).statistics().triangles;
    for (InstanceDesc& instance : scene.instances)
        if (instance.mesh.index == 0) {
            instance.motion = {instance.to_world, translation({0, 1, 0}) * instance.to_world};
            break;
        }
    EXPECT_EQ(compile(std::move(scene), CompileOptions{}).statistics().triangles,
              stored + sphere(Vec3f(0.0f), 0.4f, 16).triangles.size());
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
    const Bounds& bounds = world.geometry().bounds();
    const auto inside = [&](const Vec3f& p) {
        for (int axis = 0; axis < 3; ++axis)
            if (p[axis] < bounds.min[axis] - 1e-4f || p[axis] > bounds.max[axis] + 1e-4f) return false;
        return true;
    };
    for (const Vec3f& p : ball.positions) {
        EXPECT_TRUE(inside(p + Vec3f(4, 0, 0)));
        for (const Mat4f& m : transforms) EXPECT_TRUE(inside(transform_point(m, p)));
    }
    EXPECT_NEAR(world.geometry().bounding_radius(), 0.5f * length(bounds.size()), 1e-5f);
}

}  // namespace

}  // namespace etendue::test
