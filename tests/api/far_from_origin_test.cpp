// Scenes that lie anywhere in the world look the same: a room is rendered here and there, and compared with itself.
#include "program/small_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <etendue/etendue.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

using Place = std::array<double, 3>;

constexpr Place kHere{0.0, 0.0, 0.0};

std::string text(const Place& place) {
    return "[" + std::to_string(place[0]) + ", " + std::to_string(place[1]) + ", " + std::to_string(place[2]) + "]";
}

/// Where what moves the room away stands in the file.
struct Moves {
    Place outer = kHere;     ///< of the root node
    Place inner = kHere;     ///< of the nodes below it, the camera's and the light's too
    Place vertices = kHere;  ///< of the vertices, by floats; camera and light have it as `inner`
};

/// Adds the parallelogram center ± x ± y as two triangles.
void add_quad(const Place& at, const Place& x, const Place& y, std::vector<float>& positions) {
    constexpr std::array<std::array<int, 2>, 6> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}};
    for (const auto& [u, v] : kCorners)
        for (std::size_t axis = 0; axis < 3; ++axis)
            positions.push_back(static_cast<float>(at[axis] + u * x[axis] + v * y[axis]));
}

/// Walls of two metres, open to the front, below a lamp of the room's mesh and a point light.
void write_room(const std::filesystem::path& directory, const Moves& moves) {
    std::filesystem::create_directories(directory);
    const auto at = [&](double x, double y, double z) {
        return Place{x + moves.vertices[0], y + moves.vertices[1], z + moves.vertices[2]};
    };
    std::vector<float> positions;
    add_quad(at(0, -1, 0), {1, 0, 0}, {0, 0, -1}, positions);
    add_quad(at(0, 1, 0), {1, 0, 0}, {0, 0, 1}, positions);
    add_quad(at(0, 0, -1), {1, 0, 0}, {0, 1, 0}, positions);
    add_quad(at(-1, 0, 0), {0, 0, -1}, {0, 1, 0}, positions);
    add_quad(at(1, 0, 0), {0, 0, 1}, {0, 1, 0}, positions);
    add_quad(at(-0.5, -0.75, 0.25), {0.25, 0, 0}, {0, 0.25, 0}, positions);
    const std::size_t walls = positions.size() / 3;
    add_quad(at(0, 0.9375, 0), {0.25, 0, 0}, {0, 0, 0.25}, positions);
    const std::size_t vertices = positions.size() / 3;
    write_file(directory / "room.bin",
               std::string(reinterpret_cast<const char*>(positions.data()), positions.size() * sizeof(float)));
    const auto node = [&](const std::string& what, double y, double z) {
        return R"({"translation": )" +
               text({moves.inner[0] + moves.vertices[0], moves.inner[1] + moves.vertices[1] + y,
                     moves.inner[2] + moves.vertices[2] + z}) +
               ", " + what + "}";
    };
    const auto accessor = [](std::size_t first, std::size_t count) {
        return R"({"bufferView": 0, "byteOffset": )" + std::to_string(12 * first) +
               R"(, "componentType": 5126, "type": "VEC3", "count": )" + std::to_string(count) + "}";
    };
    const auto mesh_node = [&](int mesh) {
        return R"({"translation": )" + text(moves.inner) + R"(, "mesh": )" + std::to_string(mesh) + "}";
    };
    write_file(directory / "scene.gltf",
               R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
  "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_emissive_strength"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 500}]}},
  "nodes": [{"children": [1, 2, 3, 4], "translation": )" +
                   text(moves.outer) + "}, " + mesh_node(0) + ", " + mesh_node(1) + ", " +
                   node(R"("camera": 0)", 0.125, 0.875) + ", " +
                   node(R"("extensions": {"KHR_lights_punctual": {"light": 0}})", 0.5, 0.5) + R"(],
  "cameras": [{"name": "main", "type": "perspective", "perspective": {"yfov": 1.2, "znear": 0.1}}],
  "materials": [{"doubleSided": true, "pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.6, 0.5, 1],
                 "metallicFactor": 0}},
                {"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength":
                 {"emissiveStrength": 10}}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]},
             {"primitives": [{"attributes": {"POSITION": 1}, "material": 1}]}],
  "accessors": [)" +
                   accessor(0, walls) + ", " + accessor(walls, vertices - walls) + R"(],
  "bufferViews": [{"buffer": 0, "byteLength": )" +
                   std::to_string(12 * vertices) + R"(}],
  "buffers": [{"uri": "room.bin", "byteLength": )" +
                   std::to_string(12 * vertices) + "}]}");
}

class FarFromOrigin : public testing::TestWithParam<std::string> {
  protected:
    [[nodiscard]] Picture render_room(const Moves& moves) const {
        const std::filesystem::path directory = folder_ / ("room" + std::to_string(++rooms_));
        write_room(directory, moves);
        return render(Scene(directory, R"({"size": [24, 24], "spp": 16, "aovs": ["P"], "integrator": {"type": ")" +
                                           GetParam() + R"(", "max_depth": 6}})"));
    }

    TestFolder folder_;
    mutable int rooms_ = 0;
};

/// Mean over all channels but alpha.
double mean(const Picture& picture) {
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.pixels().size(); ++i)
        if (i % 4 != 3) sum += static_cast<double>(picture.pixels()[i]);
    return sum / (0.75 * static_cast<double>(picture.pixels().size()));
}

/// Positions are rounded where they are: by 2^-24 of themselves, and here they may differ by `here`.
void expect_moved(const Picture& there, const Picture& here, const Place& way, double tolerance) {
    const std::span<const float> near = here.layers()[0].values;
    const std::span<const float> far = there.layers()[0].values;
    ASSERT_EQ(near.size(), far.size());
    for (std::size_t i = 0; i < near.size(); ++i) {
        const double place = static_cast<double>(near[i]) + way[i % 3];
        EXPECT_NEAR(static_cast<double>(far[i]), place, 0x1p-23 * std::abs(place) + tolerance) << i;
    }
}

TEST_P(FarFromOrigin, ARoundWayAwayLeavesNoTrace) {
    const Picture here = render_room({});
    EXPECT_GT(mean(here), 0.1);
    for (const Place& way : {Place{1e5, 0, -2e5}, Place{5e6, 4e5, 100}}) {
        const Picture there = render_room({.outer = way});
        EXPECT_TRUE(std::ranges::equal(there.pixels(), here.pixels())) << text(way) << ": " << mean(there);
        expect_moved(there, here, way, 0.0);
    }
}

// Any other way is rounded to 2^-24 of the room at the most, and each ray to as much.
TEST_P(FarFromOrigin, AnyWayAwayChangesNoMean) {
    const Picture here = render_room({});
    for (const Place& way : {Place{10, -3, 7}, Place{123456.7, 8.9, -654321.3}}) {
        const Picture there = render_room({.outer = way});
        EXPECT_NEAR(mean(there), mean(here), 2e-3 * mean(here)) << text(way);
        expect_moved(there, here, way, 2e-5);
    }
}

TEST_P(FarFromOrigin, WaysThatCancelAreNone) {
    const Picture here = render_room({});
    const Picture there = render_room({.outer = {5e6, 4e5, 1e8}, .inner = {-5e6, -4e5, -1e8}});
    EXPECT_TRUE(std::ranges::equal(there.pixels(), here.pixels())) << mean(there);
    EXPECT_TRUE(std::ranges::equal(there.layers()[0].values, here.layers()[0].values));
}

// All of these vertices are floats there, too.
TEST_P(FarFromOrigin, VerticesMayBeFarAway) {
    const Picture here = render_room({});
    const Place way{1e5, 0, -2e5};
    const Picture there = render_room({.vertices = way});
    EXPECT_TRUE(std::ranges::equal(there.pixels(), here.pixels())) << mean(there);
    expect_moved(there, here, way, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Integrators, FarFromOrigin, testing::Values("path", "bdpt"),
                         [](const auto& test) { return test.param; });

}  // namespace

}  // namespace etendue::test
