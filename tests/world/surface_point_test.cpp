#include "world/surface_point.h"

#include "world/test_scene.h"

#include <array>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

enum class Placement { Baked, Instanced };

/// Places `primitive` by `to_world`; as an instance by placing it a second time, far away.
World world_of(SceneDesc scene, PrimitiveDesc primitive, MaterialDesc material, const Mat4f& to_world,
               Placement placement) {
    primitive.material = add_material(scene, std::move(material));
    const auto mesh = add_mesh(scene, {std::move(primitive)});
    place(scene, mesh, to_world);
    if (placement == Placement::Instanced) place(scene, mesh, translation({500, 500, 500}));
    return compile(std::move(scene));
}

constexpr Placement kPlacements[] = {Placement::Baked, Placement::Instanced};

TEST(SurfacePoint, NormalsPointOutOfMirroredAndUnevenlyScaledSpheres) {
    for (const bool mirrored : {false, true}) {
        Random random(mirrored ? 8 : 7);
        const Mat4f to_world = random_transform(random, mirrored);
        const Mat4f to_local = to_world.inverse();
        const Vec3f center = transform_point(to_world, Vec3f(0.0f));
        for (const Placement placement : kPlacements) {
            const World world =
                world_of(empty_scene(), sphere(Vec3f(0.0f), 1.0f, 32), diffuse(Rgb(0.5f)), to_world, placement);
            for (int i = 0; i < 500; ++i) {
                const Vec3f from = center + random_direction(random) * 5.0f;
                const Ray ray{.origin = from, .direction = normalize(center - from)};
                const Hit hit = intersect(world, ray);
                ASSERT_TRUE(hit.valid());
                const SurfacePoint point = world.geometry().surface_point(hit);
                EXPECT_LT(length(point.position - (ray.origin + ray.direction * hit.t)), 1e-4f);
                EXPECT_NEAR(length(point.geometric_normal), 1.0f, 1e-5f);
                EXPECT_NEAR(length(point.shading.normal), 1.0f, 1e-5f);
                EXPECT_LT(dot(point.geometric_normal, ray.direction), 0.0f);
                // A sphere's normal is its local position, which goes through the transform as normals do.
                const Vec3f local = transform_point(to_local, point.position);
                const Vec3f exact = normalize(transform_normal(to_local, local));
                EXPECT_GT(dot(point.shading.normal, exact), 0.9995f);
                const Frame& f = point.shading;
                EXPECT_NEAR(dot(cross(f.tangent, f.bitangent), f.normal), 1.0f, 1e-4f);
            }
        }
    }
}

TEST(SurfacePoint, NormalsThatPointBackGiveWayToTheTriangles) {
    PrimitiveDesc backwards = quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0});
    for (Vec3f& n : backwards.normals) n = -n;
    const World world = world_of(empty_scene(), backwards, diffuse(Rgb(0.5f)), Mat4f(), Placement::Baked);
    const SurfacePoint point = world.geometry().surface_point(intersect(world, Ray{.direction = {0, 0, -1}}));
    EXPECT_EQ(point.geometric_normal, Vec3f(0, 0, 1));
    EXPECT_EQ(point.shading.normal, Vec3f(0, 0, 1));
}

/// A cube whose eight vertices are shared by its faces.
PrimitiveDesc welded_cube() {
    PrimitiveDesc cube;
    for (std::uint32_t i = 0; i < 8; ++i) {
        cube.positions.emplace_back((i & 1) != 0 ? 1.0f : -1.0f, (i & 2) != 0 ? 1.0f : -1.0f,
                                    (i & 4) != 0 ? 1.0f : -1.0f);
        cube.uv0.emplace_back((i & 1) != 0 ? 1.0f : 0.0f, (i & 2) != 0 ? 1.0f : 0.0f);
    }
    const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& f : faces) {
        cube.triangles.push_back({f[0], f[1], f[2]});
        cube.triangles.push_back({f[0], f[2], f[3]});
    }
    return cube;
}

/// That what lies at the ends of random rays towards the cube is flat and faces the ray.
void expect_flat(const World& world, float time) {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        Ray ray{.origin = random_direction(random) * 8.0f};
        ray.direction = normalize(random_direction(random) * 0.5f - ray.origin);
        ray.time = time;
        const Hit hit = intersect(world, ray);
        ASSERT_TRUE(hit.valid());
        const SurfacePoint point = world.geometry().surface_point(hit);
        EXPECT_GT(dot(point.shading.normal, point.geometric_normal), 1.0f - 1e-5f);
        EXPECT_LT(dot(point.geometric_normal, ray.direction), 0.0f);
    }
}

TEST(SurfacePoint, WithoutNormalsTrianglesAreFlat) {
    Random random(21);
    for (const Placement placement : kPlacements)
        expect_flat(world_of(empty_scene(), welded_cube(), diffuse(Rgb(0.5f)), Mat4f(), placement), 0.0f);
    PrimitiveDesc deforming = welded_cube();
    deforming.motion.assign(3, VertexStep{deforming.positions, {}});
    for (Vec3f& p : deforming.motion.back().positions) p += random_direction(random) * 0.3f;
    expect_flat(world_of(empty_scene(), deforming, diffuse(Rgb(0.5f)), Mat4f(), Placement::Baked), 0.8f);
}

TEST(SurfacePoint, AttributesAreInterpolated) {
    PrimitiveDesc surface = quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0});
    surface.uv1 = {{10, 0}, {12, 0}, {12, 4}, {10, 4}};
    surface.colors = {{0, 0, 0.5f, 1}, {1, 0, 0.5f, 1}, {1, 1, 0.5f, 1}, {0, 1, 0.5f, 1}};
    const World world = world_of(empty_scene(), surface, diffuse(Rgb(0.5f)), Mat4f(), Placement::Baked);
    const Ray ray{.origin = {-0.5f, 0.2f, 0.0f}, .direction = {0, 0, -1}};
    const SurfacePoint point = world.geometry().surface_point(intersect(world, ray));
    EXPECT_NEAR(point.uv[0].x, 0.25f, 1e-5f);
    EXPECT_NEAR(point.uv[0].y, 0.4f, 1e-5f);
    EXPECT_NEAR(point.uv[1].x, 10.5f, 1e-4f);
    EXPECT_NEAR(point.uv[1].y, 2.4f, 1e-4f);
    EXPECT_NEAR(point.color.x, 0.25f, 1e-5f);
    EXPECT_NEAR(point.color.y, 0.6f, 1e-5f);
    EXPECT_NEAR(point.color.z, 0.5f, 1e-5f);
}

class NormalMap : public testing::Test {
  protected:
    /// The shading normal in the middle of a quad towards +z whose map holds `texel` everywhere.
    Vec3f mapped_normal(const std::array<int, 3>& texel, PrimitiveDesc surface, const Mat4f& to_world,
                        Placement placement, float scale = 1.0f) {
        SceneDesc scene = empty_scene();
        MaterialDesc material = diffuse(Rgb(0.5f));
        material.normal_texture.texture = add_texture(scene, png_, 1, {{texel[0], texel[1], texel[2], 255}});
        material.normal_texture.transform = transform_;
        material.normal_scale = scale;
        const Vec3f target = transform_point(to_world, {0.1f, 0.2f, 0.0f});
        const Vec3f front = normalize(transform_normal(to_world.inverse(), {0, 0, 1}));
        const World world = world_of(std::move(scene), std::move(surface), material, to_world, placement);
        const Hit hit = intersect(world, Ray{.origin = target + front, .direction = -front});
        EXPECT_TRUE(hit.valid());
        const SurfacePoint point = world.geometry().surface_point(hit);
        EXPECT_GT(dot(point.geometric_normal, front), 0.999f);
        EXPECT_NEAR(length(point.shading.normal), 1.0f, 1e-5f);
        return point.shading.normal;
    }
    void TearDown() override { std::filesystem::remove(png_); }

    TextureTransform transform_;
    std::filesystem::path png_ = temporary_file("etendue-world-normal-map.png");
};

TEST_F(NormalMap, TiltsEachTriangleOfAFlatMeshFromItsOwnNormal) {
    PrimitiveDesc roof = quad(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0});
    roof.normals.clear();
    const Vec3f n = mapped_normal({188, 128, 238}, roof, Mat4f(), Placement::Baked);
    EXPECT_NEAR(n.x, 0.47f, 0.02f);
    EXPECT_NEAR(n.y, 0.0f, 0.01f);
}

PrimitiveDesc with_tangents(PrimitiveDesc surface) {
    // What MikkTSpace gives a quad whose u runs along x and whose v runs down.
    surface.tangents.assign(4, {1, 0, 0, 1});
    return surface;
}

TEST_F(NormalMap, AFlatMapChangesNothing) {
    const PrimitiveDesc plain = quad(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0});
    for (const Placement placement : kPlacements)
        for (const PrimitiveDesc& surface : {plain, with_tangents(plain)}) {
            // Eight bits have no exact middle: 128 is half a step above.
            const Vec3f n = mapped_normal({128, 128, 255}, surface, Mat4f(), placement);
            EXPECT_NEAR(n.x, 0.0f, 0.005f);
            EXPECT_NEAR(n.y, 0.0f, 0.005f);
        }
}

TEST_F(NormalMap, RedTiltsAlongUAndGreenUpTheImage) {
    Random random(17);
    const PrimitiveDesc plain = quad(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0});
    PrimitiveDesc u_flipped = plain;
    for (Vec2f& uv : u_flipped.uv0) uv.x = 1.0f - uv.x;
    struct Case {
        const char* name;
        Mat4f to_world;
    };
    const Case cases[] = {{"identity", Mat4f()},
                          {"mirrored in x", scaling({-1, 1, 1})},
                          {"mirrored in z", scaling({1, 1, -1})},
                          {"turned", scaling({-1, -1, 1})}};
    for (const auto& [name, to_world] : cases)
        for (const Placement placement : kPlacements)
            for (const PrimitiveDesc& surface : {plain, with_tangents(plain), u_flipped}) {
                SCOPED_TRACE(testing::Message() << name << (placement == Placement::Baked ? ", baked" : ", instanced")
                                                << (surface.tangents.empty() ? "" : ", with tangents")
                                                << (surface.uv0[0].x > 0.5f ? ", u flipped" : ""));
                const float u_sign = surface.uv0[0].x > 0.5f ? -1.0f : 1.0f;
                const Vec3f along_u = transform_vector(to_world, {u_sign, 0, 0});
                const Vec3f up = transform_vector(to_world, {0, 1, 0});
                const Vec3f front = normalize(transform_normal(to_world.inverse(), {0, 0, 1}));
                // (0.8, 0, 0.6) and (0, 0.8, 0.6).
                const Vec3f red = mapped_normal({230, 128, 204}, surface, to_world, placement);
                EXPECT_NEAR(dot(red, along_u), 0.8f, 0.01f);
                EXPECT_NEAR(dot(red, up), 0.0f, 0.01f);
                EXPECT_NEAR(dot(red, front), 0.6f, 0.01f);
                const Vec3f green = mapped_normal({128, 230, 204}, surface, to_world, placement);
                EXPECT_NEAR(dot(green, along_u), 0.0f, 0.01f);
                EXPECT_NEAR(dot(green, up), 0.8f, 0.01f);
            }
}

// The relief belongs to the image: turned with the texture coordinates, it still rises where the image says.
TEST_F(NormalMap, TangentsFollowTheTexturesTransform) {
    const PrimitiveDesc plain = quad(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0});
    const auto normal = [&](const TextureTransform& transform) {
        transform_ = transform;
        return mapped_normal({230, 128, 204}, plain, Mat4f(), Placement::Baked);
    };
    EXPECT_NEAR(normal({.scale = {-1.0f, 1.0f}}).x, -0.8f, 0.01f);
    EXPECT_NEAR(normal({.scale = {1.0f, -1.0f}}).x, 0.8f, 0.01f);
    // uv' = R uv with u' = v: the image's u runs along v, which is down.
    EXPECT_NEAR(normal({.rotation = 0.5f * kPi}).y, -0.8f, 0.01f);
}

TEST_F(NormalMap, TheScaleFlattens) {
    const PrimitiveDesc plain = quad(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0});
    const Vec3f n = mapped_normal({230, 128, 204}, plain, Mat4f(), Placement::Baked, 0.5f);
    EXPECT_NEAR(n.x / n.z, 0.4f / 0.6f, 0.02f);
}

TEST_F(NormalMap, CoordinatesWithoutAreaLeaveAUsableFrame) {
    PrimitiveDesc surface = quad(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0});
    surface.uv0.assign(4, {0.5f, 0.5f});
    const Vec3f n = mapped_normal({230, 128, 204}, surface, Mat4f(), Placement::Baked);
    EXPECT_NEAR(n.z, 0.6f, 0.01f);
}

TEST_F(NormalMap, ColourIsNotDecodedFromSrgb) {
    // 188 is one half under the sRGB curve, but 0.737 as data: x = 0.47.
    const Vec3f n = mapped_normal({188, 128, 255}, quad(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0}), Mat4f(), Placement::Baked);
    EXPECT_NEAR(n.x / n.z, 2.0f * 188.0f / 255.0f - 1.0f, 0.01f);
}

}  // namespace

}  // namespace etendue::test
