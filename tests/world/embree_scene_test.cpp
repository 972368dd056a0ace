// Ray queries against a search through all triangles, and stochastic transparency.
#include "world/embree_scene.h"

#include "accelerator/accelerator.h"
#include "world/test_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Holds all triangles of a scene in world space, and what they are.
struct FlatScene {
    struct Identity {
        std::array<Vec2f, 3> uv;
        std::uint32_t instance;
        std::uint32_t geometry;
        std::uint32_t triangle;
    };
    std::vector<Triangle> triangles;
    std::vector<Identity> identities;
};

/// Flattens a scene of which every mesh is placed.
FlatScene flatten(const SceneDesc& scene) {
    std::vector<std::uint32_t> first_geometry;
    std::uint32_t geometries = 0;
    for (const MeshDesc& mesh : scene.meshes) {
        first_geometry.push_back(geometries);
        geometries += static_cast<std::uint32_t>(mesh.primitives.size());
    }
    FlatScene flat;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const InstanceDesc& instance = scene.instances[i];
        const auto mesh = static_cast<std::size_t>(instance.mesh.index);
        for (std::uint32_t g = 0; g < scene.meshes[mesh].primitives.size(); ++g) {
            const PrimitiveDesc& primitive = scene.meshes[mesh].primitives[g];
            const auto corner = [&](std::uint32_t vertex) {
                return transform_point(instance.to_world, primitive.positions[vertex]);
            };
            for (std::uint32_t t = 0; t < primitive.triangles.size(); ++t) {
                const auto& [a, b, c] = primitive.triangles[t];
                flat.triangles.push_back({corner(a), corner(b), corner(c)});
                flat.identities.push_back(
                    {{primitive.uv0[a], primitive.uv0[b], primitive.uv0[c]}, i, first_geometry[mesh] + g, t});
            }
        }
    }
    return flat;
}

/// Baked meshes, plain and mirrored, and a mesh of two primitives with several placements.
SceneDesc mixed_scene() {
    Random random(11);
    SceneDesc scene = empty_scene();
    const auto material = add_material(scene, diffuse(Rgb(0.5f)));
    const auto soup_with_uv = [&](int count) {
        PrimitiveDesc primitive = soup(random, count, 0.4f);
        for (std::size_t i = 0; i < primitive.positions.size(); ++i) primitive.uv0.push_back(random.next_2d());
        primitive.material = material;
        return primitive;
    };
    place(scene, add_mesh(scene, {soup_with_uv(60)}), random_transform(random, false));
    place(scene, add_mesh(scene, {soup_with_uv(40), soup_with_uv(1)}), random_transform(random, true));
    const auto shared = add_mesh(scene, {soup_with_uv(25), soup_with_uv(17)});
    place(scene, shared);
    place(scene, shared, random_transform(random, true));
    place(scene, shared, random_transform(random, false));
    return scene;
}

std::vector<Ray> random_rays(std::uint32_t seed, std::size_t count) {
    Random random(seed);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        ray.origin = random_direction(random) * (3.0f * random.next());
        ray.direction = random_direction(random);
        ray.alpha_key = random.next() < 0.5f ? 1u : 2u;
    }
    return rays;
}

/// Rays as columns, with room for a packet behind the last.
class ColumnsOf {
  public:
    explicit ColumnsOf(std::span<const Ray> rays) {
        for (auto& column : floats_) column.resize(rays.size() + RayColumns::kPacket);
        alpha_keys_.resize(rays.size() + RayColumns::kPacket);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Ray& ray = rays[i];
            const std::array numbers{ray.origin.x,    ray.origin.y,    ray.origin.z, ray.direction.x,
                                     ray.direction.y, ray.direction.z, ray.t_max,    ray.time};
            for (std::size_t column = 0; column < numbers.size(); ++column) floats_[column][i] = numbers[column];
            alpha_keys_[i] = ray.alpha_key;
        }
        // What is read behind the last ray may be anything.
        for (auto& column : floats_)
            for (std::size_t i = rays.size(); i < column.size(); ++i)
                column[i] = std::array{std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity(),
                                       1e30f}[i % 3];
        const bool are_endless = std::ranges::all_of(rays, [](const Ray& ray) { return std::isinf(ray.t_max); });
        columns_ = {floats_[0].data(),
                    floats_[1].data(),
                    floats_[2].data(),
                    floats_[3].data(),
                    floats_[4].data(),
                    floats_[5].data(),
                    are_endless ? nullptr : floats_[6].data(),
                    floats_[7].data(),
                    alpha_keys_.data(),
                    rays.size()};
    }
    [[nodiscard]] const RayColumns& columns() const { return columns_; }

  private:
    std::array<std::vector<float>, 8> floats_;
    std::vector<std::uint32_t> alpha_keys_;
    RayColumns columns_;
};

/// Fails if the rays, as columns, do not meet `hits` and `occluded`.
void expect_the_same_of_columns(const World& world, std::span<const Ray> rays, Coherence coherence, QueryForm form,
                                std::span<const Hit> hits, std::span<const std::uint8_t> occluded) {
    const ColumnsOf columns(rays);
    std::vector<Hit> hits_of_columns(rays.size());
    std::vector<std::uint8_t> occluded_of_columns(rays.size());
    world.geometry().intersect(columns.columns(), hits_of_columns, coherence, form);
    world.geometry().occluded(columns.columns(), occluded_of_columns, form);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(hits_of_columns[i].t, hits[i].t) << "ray " << i;
        EXPECT_EQ(hits_of_columns[i].u, hits[i].u) << "ray " << i;
        EXPECT_EQ(hits_of_columns[i].v, hits[i].v) << "ray " << i;
        EXPECT_EQ(hits_of_columns[i].triangle, hits[i].triangle) << "ray " << i;
        EXPECT_EQ(hits_of_columns[i].geometry, hits[i].geometry) << "ray " << i;
        EXPECT_EQ(hits_of_columns[i].instance, hits[i].instance) << "ray " << i;
        EXPECT_EQ(hits_of_columns[i].time, hits[i].time) << "ray " << i;
        EXPECT_EQ(occluded_of_columns[i], occluded[i]) << "ray " << i;
    }
}

constexpr QueryForm kForms[] = {QueryForm::Best, QueryForm::Single, QueryForm::Packet8, QueryForm::Packet16};
constexpr Coherence kCoherences[] = {Coherence::Coherent, Coherence::Incoherent};

TEST(EmbreeScene, FindsTheNearestTriangleOfASearchThroughAll) {
    SceneDesc scene = mixed_scene();
    const FlatScene flat = flatten(scene);
    const auto search = build_accelerator(AcceleratorKind::BruteForce, flat.triangles);
    const World world = compile(std::move(scene));
    const std::vector<Ray> rays = random_rays(3, 3001);  // no multiple of a packet
    for (const QueryForm form : kForms)
        for (const Coherence coherence : kCoherences) {
            std::vector<Hit> hits(rays.size());
            world.geometry().intersect(rays, hits, coherence, form);
            std::size_t found = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                SCOPED_TRACE(testing::Message() << "ray " << i << ", form " << int(form));
                RayWork work;
                const TriangleHit expected = search->closest_hit(rays[i], nullptr, work);
                ASSERT_EQ(hits[i].valid(), expected.valid());
                if (!expected.valid()) continue;
                ++found;
                const FlatScene::Identity& triangle = flat.identities[expected.triangle];
                ASSERT_EQ(hits[i].instance, triangle.instance);
                ASSERT_EQ(hits[i].geometry, triangle.geometry);
                ASSERT_EQ(hits[i].triangle, triangle.triangle);
                EXPECT_NEAR(hits[i].t, expected.t, 2e-4);

                const SurfacePoint point = world.geometry().surface_point(hits[i]);
                const Vec3f on_ray = rays[i].origin + rays[i].direction * hits[i].t;
                EXPECT_LT(length(point.position - on_ray), 5e-4f);
                const auto [u, v] = std::pair(expected.u, expected.v);
                const Vec2f uv = triangle.uv[0] * (1.0f - u - v) + triangle.uv[1] * u + triangle.uv[2] * v;
                EXPECT_NEAR(point.uv[0].x, uv.x, 2e-3f);
                EXPECT_NEAR(point.uv[0].y, uv.y, 2e-3f);
            }
            EXPECT_GT(found, rays.size() / 5);
        }
}

TEST(EmbreeScene, OccludedAgreesWithTheSearchUpToTMax) {
    SceneDesc scene = mixed_scene();
    const FlatScene flat = flatten(scene);
    const auto search = build_accelerator(AcceleratorKind::BruteForce, flat.triangles);
    const World world = compile(std::move(scene));
    std::vector<Ray> rays = random_rays(4, 3001);
    Random random(5);
    for (Ray& ray : rays) ray.t_max = 3.0f * random.next();
    for (const QueryForm form : kForms)
        for (const Coherence coherence : kCoherences) {
            std::vector<std::uint8_t> results(rays.size());
            world.geometry().occluded(rays, results, form);
            std::vector<Hit> hits(rays.size());
            world.geometry().intersect(rays, hits, coherence, form);
            expect_the_same_of_columns(world, rays, coherence, form, hits, results);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                RayWork work;
                const bool is_met = search->any_hit(rays[i], nullptr, work);
                EXPECT_EQ(results[i] != 0, is_met) << "ray " << i;
                EXPECT_EQ(hits[i].valid(), is_met) << "ray " << i;
            }
        }
}

// Seen from inside, no ray leaves a closed sphere, not even one that is aimed at the edges of its triangles.
TEST(EmbreeScene, ClosedSurfacesHaveNoGaps) {
    SceneDesc scene = empty_scene();
    PrimitiveDesc shell = sphere({0.3f, 0.2f, -0.1f}, 1.0f, 48);
    // On a grid, so that the vertices on both sides of the sphere's seam are the same.
    for (Vec3f& p : shell.positions)
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * 0x1p16f) * 0x1p-16f;
    add_object(scene, shell, add_material(scene, diffuse(Rgb(0.5f))));
    const World world = compile(std::move(scene));
    Random random(6);
    std::vector<Ray> rays(std::size_t{1} << 20);
    for (Ray& ray : rays) {
        const auto triangle = static_cast<std::size_t>(random.next() * static_cast<float>(shell.triangles.size()));
        const Vec3f a = shell.positions[shell.triangles[triangle][0]];
        const Vec3f b = shell.positions[shell.triangles[triangle][1]];
        ray.origin = random_direction(random) * 0.3f;
        ray.direction = normalize(a + (b - a) * random.next() - ray.origin);
    }
    std::vector<Hit> hits(rays.size());
    for (const QueryForm form : kForms) {
        world.geometry().intersect(rays, hits, Coherence::Incoherent, form);
        EXPECT_EQ(std::ranges::count_if(hits, [](const Hit& hit) { return !hit.valid(); }), 0);
    }
}

TEST(EmbreeScene, AnEmptyWorldIsMissed) {
    const World world = compile(empty_scene());
    EXPECT_FALSE(intersect(world, Ray{}).valid());
    EXPECT_FALSE(occluded(world, Ray{}));
    EXPECT_TRUE(world.geometry().bounds().empty());
    EXPECT_EQ(world.geometry().bounding_radius(), 1.0f);
}

/// Packets are filled one ahead, and the first needs a ray.
TEST(EmbreeScene, NoRaysAreNoPackets) {
    const World world = compile(empty_scene());
    const std::vector<Ray> none;
    std::vector<Hit> hits;
    std::vector<std::uint8_t> occluded;
    for (const QueryForm form : kForms) {
        world.geometry().intersect(none, hits, Coherence::Incoherent, form);
        world.geometry().occluded(none, occluded, form);
    }
    EXPECT_TRUE(hits.empty());
}

TEST(EmbreeScene, SharedMeshesWithoutPrimitivesDoNotHideOthers) {
    SceneDesc scene = empty_scene();
    const auto material = add_material(scene, diffuse(Rgb(0.5f)));
    const auto lines_only = add_mesh(scene, {});
    PrimitiveDesc front = quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0});
    front.material = material;
    const auto shared = add_mesh(scene, {front});
    place(scene, lines_only);
    place(scene, lines_only);
    place(scene, shared);
    place(scene, shared, translation({0, 0, -1}));
    const World world = compile(std::move(scene));
    const Hit hit = intersect(world, Ray{.direction = {0, 0, -1}});
    ASSERT_TRUE(hit.valid());
    EXPECT_EQ(hit.instance, 2u);
    EXPECT_FLOAT_EQ(hit.t, 2.0f);
}

/// Rays with independent keys, straight through the quad at z = -1 of the opacity tests.
std::vector<Ray> keyed_rays(std::size_t count) {
    Random random(21);
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
        rays[i].origin = {1.8f * random.next() - 0.9f, 1.8f * random.next() - 0.9f, 0.0f};
        rays[i].direction = {0, 0, -1};
        rays[i].alpha_key = static_cast<std::uint32_t>(random.next() * 0x1p24f) * 2654435761u + 17u;
    }
    return rays;
}

/// Share of `rays` that is stopped; fails if intersect, occluded and the forms of query do not decide alike.
double stopped_share(const World& world, const std::vector<Ray>& rays) {
    std::vector<Hit> first(rays.size());
    world.geometry().intersect(rays, first, Coherence::Incoherent);
    for (const QueryForm form : kForms) {
        std::vector<Hit> hits(rays.size());
        std::vector<std::uint8_t> results(rays.size());
        world.geometry().intersect(rays, hits, Coherence::Coherent, form);
        world.geometry().occluded(rays, results, form);
        expect_the_same_of_columns(world, rays, Coherence::Coherent, form, hits, results);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            EXPECT_EQ(hits[i].valid(), first[i].valid()) << "ray " << i;
            EXPECT_EQ(results[i] != 0, first[i].valid()) << "ray " << i;
        }
    }
    const auto stopped = std::count_if(first.begin(), first.end(), [](const Hit& hit) { return hit.valid(); });
    return static_cast<double>(stopped) / static_cast<double>(rays.size());
}

/// 4.5 standard deviations of a share: false alarms below 1e-5.
double share_tolerance(double share, std::size_t count) {
    return 4.5 * std::sqrt(share * (1.0 - share) / static_cast<double>(count)) + 1e-9;
}

MaterialDesc translucent(float alpha) {
    MaterialDesc material = diffuse(Rgb(0.5f));
    material.alpha_mode = AlphaMode::Blend;
    material.base_alpha = alpha;
    return material;
}

TEST(Opacity, BlendStopsAShareOfRaysEqualToAlpha) {
    const std::vector<Ray> rays = keyed_rays(20'001);
    for (const float alpha : {0.0f, 0.1f, 0.5f, 0.9f, 1.0f}) {
        SceneDesc scene = empty_scene();
        add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, translucent(alpha)));
        const double share = stopped_share(compile(std::move(scene)), rays);
        EXPECT_NEAR(share, alpha, share_tolerance(double(alpha), rays.size()));
    }
}

TEST(Opacity, LayersDecideIndependently) {
    // Two baked layers, and three instances of one mesh: no two may share their decision.
    SceneDesc scene = empty_scene();
    const auto material = add_material(scene, translucent(0.3f));
    for (const float z : {-1.0f, -2.0f}) add_object(scene, quad({0, 0, z}, {1, 0, 0}, {0, 1, 0}), material);
    PrimitiveDesc layer = quad({0, 0, -3}, {1, 0, 0}, {0, 1, 0});
    layer.material = material;
    const auto shared = add_mesh(scene, {layer});
    for (const float z : {0.0f, -1.0f, -2.0f}) place(scene, shared, translation({0, 0, z}));
    const std::vector<Ray> rays = keyed_rays(20'000);
    const double expected = 1.0 - std::pow(0.7, 5);
    EXPECT_NEAR(stopped_share(compile(std::move(scene)), rays), expected, share_tolerance(expected, rays.size()));
}

TEST(Opacity, OpaqueMaterialsIgnoreAlpha) {
    SceneDesc scene = empty_scene();
    MaterialDesc material = translucent(0.2f);
    material.alpha_mode = AlphaMode::Opaque;
    add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, material));
    EXPECT_EQ(stopped_share(compile(std::move(scene)), keyed_rays(500)), 1.0);
}

TEST(Opacity, VertexColoursMultiplyAlpha) {
    SceneDesc scene = empty_scene();
    PrimitiveDesc layer = quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0});
    layer.colors.assign(4, {1, 1, 1, 0.5f});
    add_object(scene, std::move(layer), add_material(scene, translucent(0.8f)));
    const std::vector<Ray> rays = keyed_rays(20'000);
    EXPECT_NEAR(stopped_share(compile(std::move(scene)), rays), 0.4, share_tolerance(0.4, rays.size()));
}

TEST(Opacity, TexturesAreLookedUpWhereTheRayPasses) {
    const std::filesystem::path png = temporary_file("etendue-world-opacity.png");
    for (const AlphaMode mode : {AlphaMode::Mask, AlphaMode::Blend}) {
        SceneDesc scene = empty_scene();
        // Left half alpha 0.2, right half 0.8, as exactly as eight bits can.
        MaterialDesc material = diffuse(Rgb(0.5f));
        material.base_color_texture.texture = add_texture(scene, png, 2, {{255, 255, 255, 51}, {255, 255, 255, 204}});
        scene.textures.back().filter = TextureFilter::Nearest;
        material.alpha_mode = mode;
        const auto handle = add_material(scene, material);
        add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), handle);
        const World world = compile(std::move(scene));
        std::vector<Ray> left;
        std::vector<Ray> right;
        for (const Ray& ray : keyed_rays(20'000)) (ray.origin.x < 0.0f ? left : right).push_back(ray);
        const bool mask = mode == AlphaMode::Mask;
        EXPECT_NEAR(stopped_share(world, left), mask ? 0.0 : 0.2, mask ? 0.0 : share_tolerance(0.2, left.size()));
        EXPECT_NEAR(stopped_share(world, right), mask ? 1.0 : 0.8, mask ? 0.0 : share_tolerance(0.8, right.size()));
    }
    std::filesystem::remove(png);
}

TEST(Opacity, TheMaskKeepsWhatReachesTheCutoff) {
    // What equals it reaches it: glTF 2.0, 3.9.4.
    for (const float cutoff : {0.3f, 0.5f, 0.7f}) {
        SceneDesc scene = empty_scene();
        MaterialDesc material = translucent(0.5f);
        material.alpha_mode = AlphaMode::Mask;
        material.alpha_cutoff = cutoff;
        add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, material));
        EXPECT_EQ(stopped_share(compile(std::move(scene)), keyed_rays(500)), cutoff <= 0.5f ? 1.0 : 0.0);
    }
}

}  // namespace

}  // namespace etendue::test
