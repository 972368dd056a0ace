#include "world/contact_finder.h"

#include "world/compile_parts.h"
#include "world/test_scene.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// A pile of squares of 10 km, 1 km apart, the lowest at `height`.
PrimitiveDesc pile(float x, float height) {
    constexpr float kSize = 1e4f, kApart = 1e3f;
    constexpr std::uint32_t kSquares = 150;
    PrimitiveDesc pile;
    for (std::uint32_t i = 0; i < kSquares; ++i) {
        const float z = height + kApart * static_cast<float>(i);
        for (const Vec3f& p : {Vec3f(x, 0, z), Vec3f(x + kSize, 0, z), Vec3f(x + kSize, kSize, z), Vec3f(x, kSize, z)})
            pile.positions.push_back(p);
        pile.triangles.push_back({4 * i, 4 * i + 1, 4 * i + 2});
        pile.triangles.push_back({4 * i, 4 * i + 2, 4 * i + 3});
    }
    return pile;
}

/// What touches in two piles, one of which shines, whose squares take turns.
Touches touches_of_piles(float x, std::size_t most_work) {
    SceneDesc scene = empty_scene();
    add_object(scene, pile(x, 0.0f), add_material(scene, emissive(Rgb(1.0f))));
    add_object(scene, pile(x, 500.0f), add_material(scene, diffuse(Rgb(0.5f))));
    WorldData data;
    TextureCompiler textures(scene);
    const ThreadPool threads(1);
    compile_materials(scene, textures, data);
    compile_geometry(scene, threads, 0, data);
    return find_touches(data, threads, most_work);
}

TEST(ContactFinder, BoundsThatRoundingMakesOverlapAreWork) {
    constexpr std::size_t kWork = 40'000;  // the piles have 90,000 pairs of triangles
    EXPECT_TRUE(touches_of_piles(0.0f, kWork).is_complete) << "bounds are apart";
    EXPECT_FALSE(touches_of_piles(1e9f, kWork).is_complete) << "each pair is looked at";
    const Touches all = touches_of_piles(1e9f, kMostWorkForTouches);
    EXPECT_TRUE(all.is_complete);
    EXPECT_TRUE(all.pairs.empty());
}

// A sheet that lies on a table moves before it, by what rounding may be there and not by what it may be far away.
TEST(Contacts, SheetsMoveByWhatRoundingMayBeWhereTheyAre) {
    MaterialDesc pane;
    pane.metallic = 0.0f;
    pane.roughness = 0.0f;
    pane.transmission = 1.0f;
    const auto distance_to_sheet = [&](bool has_far_one) {
        SceneDesc scene = empty_scene();
        const Handle<MaterialDesc> table = add_material(scene, diffuse(Rgb(0.5f)));
        const Handle<MaterialDesc> glass = add_material(scene, pane);
        add_object(scene, quad({0, 1, 0}, {2, 0, 0}, {0, 0, -2}), table);
        add_object(scene, quad({0, 1, 0}, {1, 0, 0}, {0, 0, -1}), glass);
        if (has_far_one) {
            add_object(scene, quad({2000, 1, 0}, {0, 2, 0}, {0, 0, 2}), table);
            add_object(scene, quad({2000, 1, 0}, {0, 1, 0}, {0, 0, 1}), glass);
        }
        const World world = compile(std::move(scene));
        return intersect(world, {.origin = {0.1f, 1.5f, 0.1f}, .direction = {0, -1, 0}}).t;
    };
    EXPECT_LT(distance_to_sheet(false), 0.5f);
    EXPECT_NEAR(distance_to_sheet(true), distance_to_sheet(false), 1e-5f);
}

}  // namespace

}  // namespace etendue::test
