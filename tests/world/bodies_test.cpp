// Which body a point is in, and what its boundary looks like from there.
#include "world/test_scene.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

MaterialDesc body(float ior, int priority = 0, float dispersion = 0.0f) {
    MaterialDesc m;
    m.override_model = DielectricDesc{ior, 0.0f, {.closed = true, .dispersion = dispersion, .priority = priority}};
    return m;
}

void add_ball(SceneDesc& scene, const Vec3f& center, float radius, const MaterialDesc& material) {
    add_object(scene, sphere(center, radius, 12), add_material(scene, material));
}

/// The boundary that a ray along -Z through the origin's axis meets from `z` on, seen from within `interior`.
Crossing crossing_from(const World& world, float z, const Interior& interior) {
    const Ray ray{.origin = {0.01f, 0.02f, z}, .direction = {0, 0, -1}};
    const Hit hit = intersect(world, ray);
    EXPECT_TRUE(hit.valid());
    const SurfacePoint point = world.geometry().surface_point(hit);
    EXPECT_TRUE(world.media().is_boundary(point));
    return world.media().crossing(point, interior);
}

TEST(Bodies, APointKnowsWhatItIsIn) {
    SceneDesc scene = empty_scene();
    add_ball(scene, {0, 0, 0}, 2.0f, body(1.33f));
    add_ball(scene, {0, 0, 0.2f}, 1.0f, body(1.5f));
    const World world = compile(std::move(scene));
    EXPECT_TRUE(world.traits().has_bodies);
    EXPECT_TRUE(world.media().interior_at({3, 0, 0}, 0.5f).is_empty());
    EXPECT_TRUE(world.media().interior_at({0, -3, 0}, 0.5f).is_empty()) << "below all, on the ray's way";
    const Interior water = world.media().interior_at({1.5f, 0, 0}, 0.5f);
    const Interior glass = world.media().interior_at({0, 0, 0.2f}, 0.5f);
    EXPECT_EQ(crossing_from(world, 1.6f, water).outside_ior, 1.33f);
    EXPECT_NE(water.filling(), glass.filling());
    EXPECT_EQ(world.media().camera_interior()->filling(), glass.filling()) << "the camera stands at the origin";
}

/// Changes a camera at the origin that looks along -Z, so that its rays begin in more places than one.
using CameraChange = void (*)(CameraDesc& camera);

std::vector<std::pair<std::string, CameraChange>> wide_cameras() {
    return {
        {"orthographic",
         [](CameraDesc& camera) {
             camera.type = CameraType::Orthographic;
             camera.ymag = 2.0f;
         }},
        {"near plane",
         [](CameraDesc& camera) {
             camera.yfov = 2.0f;
             camera.clip.start = 0.7f;
         }},
        {"near sphere",
         [](CameraDesc& camera) {
             camera.type = CameraType::Equirectangular;
             camera.clip.start = 1.2f;
         }},
        {"lens", [](CameraDesc& camera) { camera.lens_radius = 2.0f; }},
        {"lens behind a near plane",
         [](CameraDesc& camera) {
             camera.lens_radius = 0.9f;
             camera.aperture = {.blades = 6, .rotation = 0.3f, .ratio = 0.4f};
             camera.focus_distance = 0.25f;
             camera.clip.start = 0.5f;
         }},
        {"flight",
         [](CameraDesc& camera) {
             camera.motion = {translation({0, 0, 3}), translation({0, 0.5f, 0})};
         }},
        {"turn",
         [](CameraDesc& camera) {
             camera.clip.start = 0.85f;
             camera.motion = {Mat4f(), Mat4f(0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1)};
         }},
        {"pinhole", [](CameraDesc&) {}},
    };
}

/// A cube of glass under a camera that is changed.
SceneDesc cube_around_camera(CameraChange change, const Mat4f& to_world) {
    SceneDesc scene = empty_scene();
    change(scene.cameras.front());
    add_object(scene, cube(), add_material(scene, body(1.5f)), to_world);
    return scene;
}

/// Counts camera rays that begin inside and outside, and compares with where `place` says that the cube's centre is.
template <typename Place>
std::pair<int, int> rays_in_and_out(const World& world, const std::string& name, const Place& place) {
    Random random(3);
    int in = 0;
    int out = 0;
    for (int i = 0; i < 400; ++i) {
        const Ray ray = world.camera().generate_ray(random.next_2d(), random.next_2d(), random.next_2d().x);
        const Vec3f p = abs_components(ray.origin - place(ray.time));
        const float depth = 1.0f - std::max({p.x, p.y, p.z});
        if (std::abs(depth) < 1e-4f) continue;
        EXPECT_EQ(world.media().interior_at_camera(ray).is_empty(), depth < 0.0f) << name << ", " << ray.origin;
        ++(depth < 0.0f ? out : in);
    }
    return {in, out};
}

TEST(Bodies, EachRayOfTheCameraKnowsWhatItStartsIn) {
    const auto expect_both = [](SceneDesc scene, const std::string& name, const auto& place) {
        const World world = compile(std::move(scene));
        const auto [in, out] = rays_in_and_out(world, name, place);
        EXPECT_GT(std::min(in, out), 20) << name;
        EXPECT_FALSE(world.media().camera_interior()) << name;
    };
    const Vec3f aside(0.3f, 0.2f, 0.1f);
    for (const auto& [name, change] : wide_cameras())
        if (name != "pinhole")
            expect_both(cube_around_camera(change, translation(aside)), name, [&](float) { return aside; });
    const Vec3f left(-4.0f, 0.1f, 0.2f);
    const auto way = [&](float time) { return left + Vec3f(8.0f, 0.0f, 0.0f) * time; };
    SceneDesc passing = cube_around_camera(wide_cameras().back().second, Mat4f());
    passing.instances.back().motion = {translation(way(0.0f)), translation(way(1.0f))};
    expect_both(std::move(passing), "passing cube", way);
    SceneDesc growing = cube_around_camera(wide_cameras().back().second, Mat4f());
    PrimitiveDesc& primitive = growing.meshes.back().primitives.back();
    for (const float time : {0.0f, 1.0f}) {
        VertexStep& step = primitive.motion.emplace_back();
        for (const Vec3f& p : primitive.positions) step.positions.push_back(p + way(time));
        step.normals = primitive.normals;
    }
    expect_both(std::move(growing), "passing vertices", way);
}

TEST(Bodies, OneInteriorIsForAllRaysOfTheCameraThatNoBoundaryParts) {
    Random random(5);
    for (const auto& [name, change] : wide_cameras()) {
        const World within = compile(cube_around_camera(change, scaling(Vec3f(30.0f))));
        ASSERT_TRUE(within.media().camera_interior()) << name;
        EXPECT_FALSE(within.media().camera_interior()->is_empty()) << name;
        const World beside = compile(cube_around_camera(change, translation({0.0f, 9.0f, 0.0f})));
        ASSERT_TRUE(beside.media().camera_interior()) << name;
        EXPECT_TRUE(beside.media().camera_interior()->is_empty()) << name;
        SceneDesc moving = cube_around_camera(change, Mat4f());
        moving.instances.back().motion = {translation({9, 0, 0}), translation({9, 3, 0})};
        EXPECT_TRUE(compile(std::move(moving)).media().camera_interior()) << name;
    }
    // Boxes around the triangles of a turned cube contain its middle.
    const World turned = compile(cube_around_camera(wide_cameras().back().second, random_transform(random, false)));
    EXPECT_TRUE(turned.media().camera_interior());
}

TEST(Bodies, ALampKnowsWhatMovesOverIt) {
    const auto world_of = [](float height) {
        SceneDesc scene = empty_scene();
        LightDesc& light = scene.lights.emplace_back();
        light.type = LightType::Point;
        add_object(scene, cube(), add_material(scene, body(1.5f)));
        scene.instances.back().motion = {translation({-4.0f, height, 0.0f}), translation({4.0f, height, 0.0f})};
        return compile(std::move(scene));
    };
    const World world = world_of(0.0f);
    EXPECT_FALSE(world.media().light_interior(0));
    const EmissionNumbers numbers{{0.5f, 0.5f}, {0.5f, 0.5f}, {0.3f, 0.4f}};
    for (const float time : {0.1f, 0.3f, 0.4f, 0.6f, 0.7f, 0.9f}) {
        const Emission emission = world.emitters().sample({0.5f, 0.5f}, numbers, time, false);
        const bool is_inside = std::abs(8.0f * time - 4.0f) < 1.0f;
        EXPECT_EQ(!world.emitters().interior(emission, emission.ray.direction).is_empty(), is_inside) << time;
    }
    EXPECT_TRUE(world_of(3.0f).media().light_interior(0)) << "the cube passes above it";
}

TEST(Bodies, AnInnerBoundaryIsRelativeToWhatSurroundsIt) {
    SceneDesc scene = empty_scene();
    add_ball(scene, {0, 0, 0}, 2.0f, body(1.33f));
    add_ball(scene, {0, 0, 0}, 1.0f, body(1.5f));
    const World world = compile(std::move(scene));
    const Crossing outer = crossing_from(world, 5.0f, Interior());
    EXPECT_FALSE(outer.is_covered);
    EXPECT_FLOAT_EQ(outer.relative_ior(0.0f), 1.33f);
    const Crossing inner = crossing_from(world, 1.5f, outer.inside);
    EXPECT_FALSE(inner.is_covered) << "the smaller one fills the space";
    EXPECT_FLOAT_EQ(inner.relative_ior(0.0f), 1.5f / 1.33f);
    // From within, the same boundary says the same.
    EXPECT_FLOAT_EQ(crossing_from(world, 0.0f, inner.inside).relative_ior(0.0f), 1.5f / 1.33f);
}

TEST(Bodies, PriorityHidesABoundary) {
    SceneDesc scene = empty_scene();
    add_ball(scene, {0, 0, 0}, 2.0f, body(1.33f, 1));
    add_ball(scene, {0, 0, 0}, 1.0f, body(1.5f, 0));
    const World world = compile(std::move(scene));
    const Crossing outer = crossing_from(world, 5.0f, Interior());
    const Crossing inner = crossing_from(world, 1.5f, outer.inside);
    EXPECT_TRUE(inner.is_covered);
    EXPECT_TRUE(crossing_from(world, 0.0f, inner.inside).is_covered);
    EXPECT_FALSE(crossing_from(world, -1.5f, outer.inside).is_covered);
}

TEST(Bodies, PartsOfOneMeshAreOneBoundary) {
    SceneDesc scene = empty_scene();
    PrimitiveDesc front = quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0});
    PrimitiveDesc back = quad({0, 0, -2}, {0, 1, 0}, {1, 0, 0});
    front.material = back.material = add_material(scene, body(1.5f));
    place(scene, add_mesh(scene, {front, back}));
    const World world = compile(std::move(scene));
    const Crossing in = crossing_from(world, 0.0f, Interior());
    EXPECT_FALSE(in.is_covered);
    const Crossing out = crossing_from(world, -1.5f, in.inside);
    EXPECT_FALSE(out.is_covered);
    EXPECT_TRUE(out.outside.is_empty());
    EXPECT_FLOAT_EQ(out.relative_ior(0.0f), 1.5f);
}

TEST(Bodies, ABlendedBodyIsWholeAndAMaskedOneAThinWall) {
    for (const AlphaMode mode : {AlphaMode::Blend, AlphaMode::Mask}) {
        MaterialDesc glass;
        glass.metallic = 0.0f;
        glass.transmission = 1.0f;
        glass.base_alpha = 0.4f;
        glass.volume.closed = true;
        glass.alpha_mode = mode;
        SceneDesc scene = empty_scene();
        add_ball(scene, {0, 0, -3}, 1.0f, glass);
        const World world = compile(std::move(scene));
        EXPECT_EQ(world.traits().has_bodies, mode == AlphaMode::Blend);
        EXPECT_EQ(world.traits().has_transparency, mode == AlphaMode::Mask);
    }
}

TEST(Bodies, OpaqueAndThinMaterialsHaveNone) {
    MaterialDesc thin;
    thin.transmission = 1.0f;
    thin.metallic = 0.0f;
    MaterialDesc opaque;
    opaque.volume.closed = true;
    SceneDesc scene = empty_scene();
    add_ball(scene, {0, 0, -3}, 1.0f, thin);
    add_ball(scene, {0, 0, -6}, 1.0f, opaque);
    EXPECT_FALSE(compile(std::move(scene)).traits().has_bodies);
}

TEST(Bodies, EachChannelOfSubsurfaceHasItsOwnMeanFreePath) {
    SceneDesc scene = empty_scene();
    MaterialDesc wax;
    wax.override_model = SubsurfaceDesc{.albedo = {0.8f, 0.5f, 0.2f}, .radius = {0.04f, 0.02f, 0.01f}};
    add_ball(scene, {0, 0, 0}, 2.0f, wax);
    const World world = compile(std::move(scene));
    const HomogeneousMedium* medium = world.media().within(world.media().interior_at(Vec3f(0.0f), 0.5f));
    ASSERT_NE(medium, nullptr);
    const Rgb left = medium->transmittance(0.02f);
    EXPECT_NEAR(left.r, std::exp(-0.5f), 1e-5f);
    EXPECT_NEAR(left.g, std::exp(-1.0f), 1e-5f);
    EXPECT_NEAR(left.b, std::exp(-2.0f), 1e-5f);
    EXPECT_GT(medium->single_scatter_albedo.r, medium->single_scatter_albedo.g);
    EXPECT_GT(medium->single_scatter_albedo.g, medium->single_scatter_albedo.b);
}

/// The mean free path of the channel in which it is longest decides, against the largest body of the material.
TEST(Bodies, AreDenseWhereLightScattersThirtyTimesAcross) {
    const auto is_dense = [](float radius, const Rgb& free_path) {
        SceneDesc scene = empty_scene();
        MaterialDesc wax;
        wax.override_model = SubsurfaceDesc{.radius = free_path};
        add_ball(scene, {0, 0, 0}, radius, wax);
        add_ball(scene, {0, 9, 0}, 0.1f * radius, wax);
        const World world = compile(std::move(scene));
        return world.media().within(world.media().interior_at(Vec3f(0.0f), 0.5f))->is_dense;
    };
    const float across = 2.0f * std::sqrt(3.0f);  // the diagonal of the bounds of a unit ball
    EXPECT_TRUE(is_dense(1.0f, Rgb(across / 31.0f)));
    EXPECT_FALSE(is_dense(1.0f, Rgb(across / 29.0f)));
    EXPECT_TRUE(is_dense(0.5f, Rgb(across / 62.0f)));
    EXPECT_FALSE(is_dense(1.0f, {across / 29.0f, across / 99.0f, across / 99.0f}));
}

TEST(Bodies, ShortWavesAreRefractedMore) {
    SceneDesc scene = empty_scene();
    // 20 over the Abbe number: 1 is V = 20.
    add_ball(scene, {0, 0, -3}, 1.0f, body(1.6f, 0, 1.0f));
    const World world = compile(std::move(scene));
    const Crossing crossing = crossing_from(world, 0.0f, Interior());
    EXPECT_TRUE(crossing.disperses());
    EXPECT_NEAR(crossing.relative_ior(587.6f), 1.6f, 1e-4f);
    // The definition of the Abbe number: V = (n_d - 1) / (n_F - n_C).
    EXPECT_NEAR(0.6f / (crossing.relative_ior(486.1f) - crossing.relative_ior(656.3f)), 20.0f, 0.02f);
}

/// Messages about a ball of glass whose mesh `change` has changed.
template <typename Change>
std::string said_of_a_ball(const Change& change) {
    SceneDesc scene = empty_scene();
    PrimitiveDesc ball = sphere({3.0f, 0.0f, 0.0f}, 1.0f, 12);
    change(ball);
    add_object(scene, ball, add_material(scene, body(1.5f)));
    ProblemList problems;
    EXPECT_TRUE(compile(std::move(scene), kGltfColorSpace, problems).traits().has_bodies);
    std::string said;
    for (const Problem& problem : problems.all()) said += problem.message;
    return said;
}

/// Messages about a ball whose material transmits without a thickness, after `change` to the ball and the material.
template <typename Change>
std::string said_of_a_shell(const Change& change) {
    SceneDesc scene = empty_scene();
    PrimitiveDesc ball = sphere({3.0f, 0.0f, 0.0f}, 1.0f, 12);
    MaterialDesc glass;
    glass.name = "Glass";
    glass.transmission = 1.0f;
    change(ball, glass);
    add_object(scene, ball, add_material(scene, glass));
    ProblemList problems;
    (void)compile(std::move(scene), kGltfColorSpace, problems);
    std::string said;
    for (const Problem& problem : problems.all()) said += problem.message;
    return said;
}

TEST(Bodies, ClosedSheetsAreNoted) {
    EXPECT_NE(said_of_a_shell([](PrimitiveDesc&, MaterialDesc&) {}).find("its material 'Glass' transmits without"),
              std::string::npos);
    EXPECT_EQ(said_of_a_shell([](PrimitiveDesc& ball, MaterialDesc&) { ball.triangles.pop_back(); }), "");
    EXPECT_EQ(said_of_a_shell([](PrimitiveDesc&, MaterialDesc& glass) { glass.volume.closed = true; }), "");
    EXPECT_EQ(said_of_a_shell([](PrimitiveDesc&, MaterialDesc& glass) { glass.transmission = 0.0f; }), "");
    EXPECT_EQ(said_of_a_shell([](PrimitiveDesc& ball, MaterialDesc&) {
                  for (Vec3f& p : ball.positions) p.y = 0.0f;
              }),
              "")
        << "a flat mesh encloses nothing";
    EXPECT_EQ(said_of_a_shell([](PrimitiveDesc&, MaterialDesc& lamp) { lamp.ior = 1.0f; }), "")
        << "filled, it would be as it is";
    EXPECT_NE(said_of_a_shell([](PrimitiveDesc&, MaterialDesc& air) {
                  air.ior = 1.0f;
                  air.volume.attenuation_distance = 1.0f;
              }),
              "");
}

TEST(Bodies, HolesAndTurnedSurfacesAreWarnedOf) {
    EXPECT_EQ(said_of_a_ball([](PrimitiveDesc&) {}), "");
    EXPECT_NE(said_of_a_ball([](PrimitiveDesc& ball) { ball.triangles.pop_back(); }).find("not closed"),
              std::string::npos);
    EXPECT_NE(said_of_a_ball([](PrimitiveDesc& ball) {
                  std::swap(ball.triangles[7][0], ball.triangles[7][1]);
              }).find("not closed"),
              std::string::npos);
    EXPECT_NE(said_of_a_ball([](PrimitiveDesc& ball) {
                  for (auto& triangle : ball.triangles) std::swap(triangle[0], triangle[1]);
              }).find("inside out"),
              std::string::npos);
    // An exporter rounds the two ends of a seam differently.
    EXPECT_EQ(said_of_a_ball([](PrimitiveDesc& ball) {
                  ball.uv0.clear();
                  for (auto& triangle : ball.triangles)
                      for (std::uint32_t& vertex : triangle) {
                          Vec3f p = ball.positions[vertex];
                          p.y += 1e-6f * static_cast<float>(ball.positions.size() % 3);
                          if (!ball.normals.empty()) ball.normals.push_back(ball.normals[vertex]);
                          vertex = static_cast<std::uint32_t>(ball.positions.size());
                          ball.positions.push_back(p);
                      }
              }),
              "");
}

}  // namespace

}  // namespace etendue::test
