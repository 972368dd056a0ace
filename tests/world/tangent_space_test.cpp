#include "world/tangent_space.h"

#include "loader/loader.h"
#include "world/test_scene.h"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

Vec3f direction(const Vec4f& tangent) {
    return {tangent.x, tangent.y, tangent.z};
}

TangentVertices generate(const PrimitiveDesc& p) {
    return generate_tangents(p.positions, p.normals, p.uv0, p.triangles);
}

TEST(TangentSpace, FollowsTheTextureOfAQuad) {
    const PrimitiveDesc p = quad({1, 2, 3}, {0, 2, 0}, {0, 0, 1});
    const TangentVertices result = generate(p);
    ASSERT_EQ(result.tangents.size(), 4u);
    EXPECT_EQ(result.triangles, p.triangles);
    for (const Vec4f& t : result.tangents) {
        EXPECT_LT(length(direction(t) - Vec3f(0, 1, 0)), 1e-6f) << "u runs along x";
        EXPECT_EQ(t.w, 1.0f) << "v runs against y, which is up";
    }
}

TEST(TangentSpace, MirroredHalvesAreDivided) {
    // Two quads side by side that share an edge, the texture mirrored in the second.
    PrimitiveDesc p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
    p.normals.assign(6, {0, 0, 1});
    p.uv0 = {{0, 1}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {0, 0}};
    p.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    const TangentVertices result = generate(p);
    ASSERT_EQ(result.tangents.size(), 8u) << "the two vertices in the middle have two frames";
    EXPECT_EQ(result.source[6], 1u);
    EXPECT_EQ(result.source[7], 4u);
    for (std::size_t t = 0; t < 4; ++t)
        for (const std::uint32_t v : result.triangles[t]) {
            const float side = t < 2 ? 1.0f : -1.0f;
            EXPECT_LT(length(direction(result.tangents[v]) - Vec3f(side, 0, 0)), 1e-6f);
            EXPECT_EQ(result.tangents[v].w, side);
        }
}

/// Equal vertices of different numbers share their frame; the mean is weighted by angles.
TEST(TangentSpace, MeansAreWeightedByAngles) {
    // Around the origin, a corner of 90 degrees whose u runs along x and one of 45 degrees whose u runs along y.
    PrimitiveDesc p;
    const float s = std::sqrt(0.5f);
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {-s, s, 0}};
    p.normals.assign(6, {0, 0, 1});
    // The shared edge from (0, 0, 0) to (0, 1, 0) has the same coordinates in both.
    p.uv0 = {{0, 0}, {1, 0}, {0, 1}, {0, 0}, {0, 1}, {-1, 1}};
    p.triangles = {{0, 1, 2}, {3, 4, 5}};
    const TangentVertices result = generate(p);
    // In the second, u is constant along y: dp/du = ((-s, s) - (0, 1)) / -1.
    const Vec3f second = normalize(Vec3f(s, 1.0f - s, 0));
    const Vec3f expected = normalize(Vec3f(1, 0, 0) * 2.0f + second);
    EXPECT_LT(length(direction(result.tangents[0]) - expected), 1e-6f);
    EXPECT_LT(length(direction(result.tangents[3]) - expected), 1e-6f);
    EXPECT_LT(length(direction(result.tangents[1]) - Vec3f(1, 0, 0)), 1e-6f) << "not at the edge";
    EXPECT_EQ(result.tangents[0].w, -1.0f);
}

TEST(TangentSpace, TrianglesWithoutAnImageTakeTheFrameOfANeighbour) {
    PrimitiveDesc p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
    p.normals.assign(5, {0, 0, 1});
    p.uv0 = {{0, 0}, {0, 1}, {-1, 0}, {-1, 0}, {-1, 0}};
    // The second shares an edge with the first, the third only a vertex.
    p.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 4}};
    const TangentVertices result = generate(p);
    ASSERT_EQ(result.tangents.size(), 5u);
    for (const std::uint32_t v : {0u, 1u, 2u})
        EXPECT_LT(length(direction(result.tangents[v]) - Vec3f(0, -1, 0)), 1e-6f);
    // Without any frame at its vertices, some perpendicular direction.
    EXPECT_NEAR(dot(direction(result.tangents[4]), {0, 0, 1}), 0.0f, 1e-6f);
    EXPECT_NEAR(length(direction(result.tangents[4])), 1.0f, 1e-6f);
}

/// Many triangles around one edge and one vertex: time must not grow with the square of their number.
TEST(TangentSpace, FansAndFinsAreFast) {
    PrimitiveDesc p;
    constexpr std::uint32_t kCount = 200'000;
    p.positions = {{0, 0, 0}, {0, 0, 1}};
    p.uv0.emplace_back(0.0f, 0.0f);
    p.uv0.emplace_back(0.0f, 1.0f);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const float angle = 2.0f * kPi * static_cast<float>(i) / kCount;
        p.positions.push_back({std::cos(angle), std::sin(angle), 0});
        p.uv0.push_back({1, 0});
        p.triangles.push_back({0, 1, 2 + i});
    }
    p.normals.assign(p.positions.size(), {0, 0, 1});
    EXPECT_EQ(generate(p).triangles.size(), kCount);
}

/// Which share of the corners of the meshes of `file` that bring tangents have nearly those.
double share_within(const std::filesystem::path& file, float degrees) {
    std::size_t compared = 0;
    std::size_t close = 0;
    for (const MeshDesc& mesh : inspect_scene(file).scene.meshes)
        for (const PrimitiveDesc& p : mesh.primitives) {
            if (p.tangents.empty() || p.uv0.empty()) continue;
            const TangentVertices result = generate(p);
            for (std::size_t t = 0; t < p.triangles.size(); ++t)
                for (std::size_t c = 0; c < 3; ++c) {
                    const Vec4f& stored = p.tangents[p.triangles[t][c]];
                    const Vec4f& ours = result.tangents[result.triangles[t][c]];
                    const float cosine = dot(direction(stored), direction(ours));
                    ++compared;
                    if (cosine > std::cos(degrees * kPi / 180.0f) && stored.w == ours.w) ++close;
                }
        }
    EXPECT_GT(compared, 0u) << file;
    return static_cast<double>(close) / static_cast<double>(compared);
}

TEST(TangentSpace, AgreesWithTheTangentsThatAssetsBring) {
    const std::filesystem::path models = std::filesystem::path(ETENDUE_SHARED_ASSETS) / "models";
    if (!std::filesystem::exists(models / "FlightHelmet")) GTEST_SKIP() << "there is no FlightHelmet in " << models;
    EXPECT_EQ(share_within(models / "ClearCoatTest.glb", 1.0f), 1.0);
    // Made by another program, which weighs the triangles around a vertex differently.
    EXPECT_GT(share_within(models / "FlightHelmet", 1.0f), 0.7);
    EXPECT_GT(share_within(models / "FlightHelmet", 10.0f), 0.95);
}

}  // namespace
}  // namespace etendue::test
