// Photons are found by place, each once.
#include "transport/photon_map.h"

#include "sampling/warp.h"
#include "support/random.h"
#include "world/test_scene.h"

#include <cstddef>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Radii from 1 cm to half a metre: five grids and their limits.
constexpr MergeRadius kRadius{.eye{0.5f, 0.0f, 0.0f}, .pixel{0.0f, 0.1f}, .scale = 1.0f, .least = 0.01f, .most = 0.5f};

std::vector<std::vector<Photon>> some_photons(Random& random, std::size_t lists, std::size_t per_list) {
    std::vector<std::vector<Photon>> photons(lists);
    for (std::vector<Photon>& list : photons)
        for (std::size_t i = 0; i < per_list; ++i) {
            // On a plane, as kernels are thin.
            const Vec2f place = random.next_2d();
            list.push_back({.position{8.0f * place.x - 4.0f, 0.0f, 8.0f * place.y - 4.0f},
                            .edges = static_cast<std::int32_t>(i),
                            .normal = CoarseDirection({0, 1, 0})});
        }
    return photons;
}

TEST(PhotonMap, FindsEachPhotonOfAKernelOnce) {
    Random random(1);
    const std::vector<std::vector<Photon>> lists = some_photons(random, 7, 900);
    const PhotonMap map(lists, kRadius, ThreadPool(2));
    EXPECT_EQ(map.size(), 6300u);
    std::size_t found = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec2f place = random.next_2d();
        const Vec3f position(9.0f * place.x - 4.5f, 0.0f, 9.0f * place.y - 4.5f);
        const MergeKernel kernel{position, {0, 1, 0}, kRadius(position)};
        std::map<float, int> expected;
        for (const std::vector<Photon>& list : lists)
            for (const Photon& photon : list)
                if (kernel.contains(photon)) ++expected[photon.position.x];
        std::map<float, int> seen;
        map.for_each_in(kernel, [&](const Photon& photon) { ++seen[photon.position.x]; });
        ASSERT_EQ(seen, expected) << position.x << " " << position.z;
        found += seen.size();
    }
    EXPECT_GT(found, 5000u);
}

TEST(PhotonMap, OfNoPhotonsFindsNone) {
    const PhotonMap map({}, kRadius, ThreadPool(1));
    map.for_each_in({{}, {0, 1, 0}, 1.0f}, [](const Photon&) { FAIL(); });
    EXPECT_EQ(map.size(), 0u);
}

TEST(MergeKernel, TakesWhatLiesOnItsSurface) {
    const MergeKernel kernel{{0, 0, 0}, {0, 1, 0}, 1.0f};
    const CoarseDirection up({0, 1, 0});
    EXPECT_TRUE(kernel.contains({.position{0.9f, 0, 0}, .normal = up}));
    EXPECT_FALSE(kernel.contains({.position{1.1f, 0, 0}, .normal = up})) << "too far";
    EXPECT_FALSE(kernel.contains({.position{0, 0.2f, 0}, .normal = up})) << "another surface above";
    EXPECT_FALSE(kernel.contains({.position{0.1f, 0, 0}, .normal = CoarseDirection({1, 0, 0})})) << "around a corner";
    EXPECT_FALSE(kernel.contains({.position{0.1f, 0, 0}, .normal = CoarseDirection({0, -1, 0})}))
        << "the other side of a thin wall";
    MergeKernel moved = kernel;
    moved.radius = 1e-3f;
    EXPECT_FALSE(moved.contains({.position{0, 2e-4f, 0}, .normal = up}));
    moved.clearance = 1e-4f;
    EXPECT_TRUE(moved.contains({.position{0, 2e-4f, 0}, .normal = up})) << "rounding is no other surface";
}

TEST(MergeKernel, TakesLightOfSheetsHoweverTheyAreWound) {
    const Vec3f up{0, 1, 0};
    MergeKernel kernel{{0, 0, 0}, up, 1.0f};
    Photon photon{.position{0.1f, 0, 0}, .direction = up, .normal = CoarseDirection(-up)};
    EXPECT_TRUE(kernel.contains(photon)) << "the same side";
    photon.bounds_body = true;
    EXPECT_FALSE(kernel.contains(photon)) << "the other side of a thin wall";
    photon.bounds_body = false;
    kernel.surface.bounds_body = true;
    EXPECT_FALSE(kernel.contains(photon));
    kernel.surface.bounds_body = false;
    // The other leaf of a fold, lit between both.
    const Vec3f leaf = normalize(Vec3f{0.3f, -1, 0});
    photon.direction = normalize(Vec3f{1, 0.1f, 0});
    for (const Vec3f& front : {leaf, -leaf}) {
        photon.normal = CoarseDirection(front);
        EXPECT_FALSE(kernel.contains(photon));
    }
}

TEST(MergeKernel, TakesLightOfOneTransparentSheet) {
    MergeKernel kernel{{0, 0, 0}, {0, 1, 0}, 1.0f};
    Photon photon{.position{0.1f, 0, 0}, .direction{0, 1, 0}, .sheet = 7, .normal = CoarseDirection({0, 1, 0})};
    EXPECT_FALSE(kernel.contains(photon)) << "a decal";
    kernel.surface.sheet = 7;
    EXPECT_TRUE(kernel.contains(photon));
    photon.sheet = 0;
    EXPECT_FALSE(kernel.contains(photon)) << "what lies behind it";
}

// Rounding bounds radii, where things are; how large the scene is beside does not.
TEST(MergeRadius, DependsOnThePlaceAlone) {
    constexpr MergeSettings kSmall{.at = MergeAt::Everywhere, .radius = 0.1};
    constexpr int kWidth = 1 << 16;
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    add_object(scene, quad({0, 2, -1}, {1, 0, 0}, {0, 0, 1}), add_material(scene, emissive(Rgb(1.0f))));
    const auto radius_in = [&](const SceneDesc& of) {
        return make_merging(compile(of), kWidth, kWidth, 1000.0, 0, kSmall).radius;
    };
    const MergeRadius near = radius_in(scene);
    add_object(scene, quad({0, 0, -1e4f}, {1, 0, 0}, {0, 1, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    const MergeRadius with_far = radius_in(scene);
    const Vec3f close{0, 0, -0.01f};
    EXPECT_LT(near(close), 1e-6f);
    EXPECT_FLOAT_EQ(with_far(close), near(close));
    const Vec3f far{0, 0, -1e4f};
    EXPECT_GT(with_far(far), 8.0f * std::numeric_limits<float>::epsilon() * 1e4f);
    EXPECT_GT(near({0, 0, 0}), 0.0f) << "at the camera";
}

TEST(CoarseDirection, TellsCosines) {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3f a = square_to_sphere(random.next_2d());
        const Vec3f b = square_to_sphere(random.next_2d());
        ASSERT_NEAR(CoarseDirection(a).cosine(b), dot(a, b), 0.01f);
    }
}

}  // namespace

}  // namespace etendue::test
