// Which body a point is in, and what its boundary looks like from there.
#include "world/test_scene.h"
#include "world/world.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

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
    EXPECT_TRUE(world.media().interior_at({3, 0, 0}).is_empty());
    EXPECT_TRUE(world.media().interior_at({0, -3, 0}).is_empty()) << "below all, on the ray's way";
    const Interior water = world.media().interior_at({1.5f, 0, 0});
    const Interior glass = world.media().interior_at({0, 0, 0.2f});
    EXPECT_EQ(crossing_from(world, 1.6f, water).outside_ior, 1.33f);
    EXPECT_NE(water.filling(), glass.filling());
    EXPECT_EQ(world.media().camera_interior().filling(), glass.filling()) << "the camera stands at the origin";
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
    const HomogeneousMedium* medium = world.media().within(world.media().interior_at(Vec3f(0.0f)));
    ASSERT_NE(medium, nullptr);
    const Rgb left = medium->transmittance(0.02f);
    EXPECT_NEAR(left.r, std::exp(-0.5f), 1e-5f);
    EXPECT_NEAR(left.g, std::exp(-1.0f), 1e-5f);
    EXPECT_NEAR(left.b, std::exp(-2.0f), 1e-5f);
    EXPECT_GT(medium->single_scatter_albedo.r, medium->single_scatter_albedo.g);
    EXPECT_GT(medium->single_scatter_albedo.g, medium->single_scatter_albedo.b);
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
