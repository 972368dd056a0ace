#include "world/plain_surface.h"

#include "world/plain_lookups.h"
#include "world/test_scene.h"

#include <array>
#include <filesystem>
#include <functional>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

class PlainSurfaces : public testing::Test {
  protected:
    /// A square before the camera that a ray meets; a texture is there if one is asked for.
    World with(
        const std::function<void(MaterialDesc&)>& change,
        const std::function<void(PrimitiveDesc&)>& reshape = [](PrimitiveDesc&) {}) {
        SceneDesc scene = empty_scene();
        std::vector<std::array<int, 4>> texels;
        texels.reserve(64);
        for (int i = 0; i < 64; ++i) texels.push_back({4 * i, 255 - 2 * i, 128 + i, 255});
        add_texture(scene, png_, 8, texels);
        MaterialDesc material;
        material.roughness = 0.6f;
        change(material);
        PrimitiveDesc primitive = quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0});
        reshape(primitive);
        add_object(scene, std::move(primitive), add_material(scene, std::move(material)));
        return compile(std::move(scene));
    }
    static const PlainSurface* surface(const World& world) {
        return world.materials().plain_surface(intersect(world, {.direction = {0, 0, -1}}));
    }
    void TearDown() override { std::filesystem::remove(png_); }

    std::filesystem::path png_ = temporary_file("etendue-plain-surface.png");
};

TEST_F(PlainSurfaces, AreDiffuseOrPlainMetallicRoughness) {
    const World glossy = with([](MaterialDesc&) {});
    ASSERT_NE(surface(glossy), nullptr);
    EXPECT_EQ(surface(glossy)->diffuse, nullptr);
    EXPECT_EQ(surface(glossy)->textured, nullptr);
    EXPECT_FLOAT_EQ(surface(glossy)->glossy.alpha_x, 0.36f);

    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    const World diffuse = compile(std::move(scene));
    ASSERT_NE(surface(diffuse), nullptr);
    ASSERT_NE(surface(diffuse)->diffuse, nullptr);
    EXPECT_EQ(std::get<Diffuse>(*surface(diffuse)->diffuse).albedo, Rgb(0.5f));
    EXPECT_EQ(diffuse.materials().plain_bsdf(intersect(diffuse, {.direction = {0, 0, -1}})), surface(diffuse)->diffuse);
}

TEST_F(PlainSurfaces, AreNotWhatMirrorsEmitsOrHasMoreLayers) {
    const auto is_plain = [&](const std::function<void(MaterialDesc&)>& change) {
        return surface(with(change)) != nullptr;
    };
    EXPECT_TRUE(is_plain([](MaterialDesc& m) { m.base_color_texture.texture = {0}; }));
    EXPECT_TRUE(is_plain([](MaterialDesc& m) { m.metallic_roughness_texture.texture = {0}; }));
    EXPECT_FALSE(is_plain([](MaterialDesc& m) { m.roughness = 0.0f; }));
    EXPECT_FALSE(is_plain([](MaterialDesc& m) { m.emissive = Rgb(1.0f); }));
    EXPECT_FALSE(is_plain([](MaterialDesc& m) { m.unlit = true; }));
    EXPECT_FALSE(is_plain([](MaterialDesc& m) { m.normal_texture.texture = {0}; }));
    EXPECT_FALSE(is_plain([](MaterialDesc& m) { m.transmission = 0.5f; }));
    EXPECT_FALSE(is_plain([](MaterialDesc& m) {
        m.base_color_texture.texture = {0};
        m.glossiness = 0.5f;
    })) << "the base colour is dimmed at each point";
    EXPECT_FALSE(is_plain([](MaterialDesc& m) { m.clearcoat.factor = 1.0f; }));
    EXPECT_FALSE(is_plain([](MaterialDesc& m) {
        m.base_color_texture.texture = {0};
        m.metallic_roughness_texture = {.texture = {0}, .texcoord = 1, .transform = {}};
    })) << "two sets of coordinates";
}

TEST_F(PlainSurfaces, AreNotWhatHasVertexColors) {
    const auto colored = [&](const Vec4f& color) {
        return with([](MaterialDesc&) {}, [&](PrimitiveDesc& p) { p.colors.assign(4, color); });
    };
    EXPECT_EQ(surface(colored({1, 1, 1, 0.5f})), nullptr);
    EXPECT_NE(surface(colored({1, 1, 1, 1})), nullptr) << "white changes nothing";
}

TEST_F(PlainSurfaces, AreNotWhatIsAnInstance) {
    SceneDesc scene = empty_scene();
    PrimitiveDesc primitive = quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0});
    primitive.material = add_material(scene, diffuse(Rgb(0.5f)));
    const auto mesh = add_mesh(scene, {std::move(primitive)});
    place(scene, mesh);
    place(scene, mesh, translation({100, 0, 0}));
    EXPECT_EQ(surface(compile(std::move(scene))), nullptr);
}

/// With the base colour's texture in `texcoord`, and that of metalness and roughness if it is there.
class PlainSurfacesWithTextures : public PlainSurfaces, public testing::WithParamInterface<std::tuple<int, bool>> {};

TEST_P(PlainSurfacesWithTextures, HaveTheLobesOfTheirModelAtEveryPoint) {
    const int texcoord = std::get<0>(GetParam());
    const bool has_both = std::get<1>(GetParam());
    const World world = with(
        [&](MaterialDesc& m) {
            m.base_color = {0.9f, 0.7f, 0.5f};
            m.metallic = 0.7f;
            if (has_both) m.base_color_texture = {.texture = {0}, .texcoord = texcoord, .transform = {}};
            m.metallic_roughness_texture = {.texture = {0}, .texcoord = texcoord, .transform = {}};
        },
        [](PrimitiveDesc& p) {
            p.uv1 = {{0.3f, 0.1f}, {2.5f, 0.4f}, {2.0f, 1.9f}, {0.2f, 1.2f}};
        });
    Random random(11);
    PlainLookups lookups;
    int seen = 0;
    for (int i = 0; i < 500; ++i) {
        Ray ray;
        ray.direction = normalize(Vec3f(random.next() - 0.5f, random.next() - 0.5f, -1.2f));
        const Hit hit = intersect(world, ray);
        if (!hit.valid()) continue;
        const RayCone cone{0.0f, 0.3f * random.next()};
        const SurfacePoint point = world.geometry().surface_point(hit, ray, cone);
        const PlainSurface* plain = world.materials().plain_surface(hit);
        ASSERT_NE(plain, nullptr);
        const HitCoordinates coordinates = world.geometry().hit_coordinates(hit, *plain);
        const Vec2f uv = coordinates.uv0 + coordinates.edge1 * hit.u + coordinates.edge2 * hit.v;
        ASSERT_EQ(plain->texcoord, texcoord);
        const auto set = static_cast<std::size_t>(texcoord);
        ASSERT_NEAR(uv.x, point.uv[set].x, 1e-5f);
        ASSERT_NEAR(uv.y, point.uv[set].y, 1e-5f);
        lookups.clear();
        world.materials().add_lookups(*plain, point.uv[set], point.footprint[set], lookups);
        lookups.finish();
        const MetallicRoughness found = world.materials().lobe(*plain, lookups);
        Bsdf storage;
        const auto& expected =
            std::get<MetallicRoughness>(world.materials().bsdf(point, -ray.direction, 0.0f, storage));
        for (const auto& [a, b] : {std::pair(found.base.r, expected.base.r), std::pair(found.base.b, expected.base.b),
                                   std::pair(found.metallic, expected.metallic), std::pair(found.f0.g, expected.f0.g),
                                   std::pair(found.alpha_x, expected.alpha_x), std::pair(found.f90, expected.f90)})
            EXPECT_NEAR(a, b, 1e-5f);
        ++seen;
    }
    EXPECT_GT(seen, 200);
}

INSTANTIATE_TEST_SUITE_P(Sets, PlainSurfacesWithTextures, testing::Combine(testing::Values(0, 1), testing::Bool()));

}  // namespace

}  // namespace etendue::test
