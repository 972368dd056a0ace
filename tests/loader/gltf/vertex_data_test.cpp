#include "loader/gltf/vertex_data.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

TEST(AssembleTriangles, FollowsTheModes) {
    const std::vector<std::uint32_t> indices{0, 1, 2, 3, 4};
    EXPECT_EQ(assemble_triangles(indices, TriangleMode::List), (std::vector<Triangle>{{0, 1, 2}}));
    EXPECT_EQ(assemble_triangles(indices, TriangleMode::Strip),
              (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
    EXPECT_EQ(assemble_triangles(indices, TriangleMode::Fan), (std::vector<Triangle>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
    for (const TriangleMode mode : {TriangleMode::List, TriangleMode::Strip, TriangleMode::Fan}) {
        EXPECT_TRUE(assemble_triangles({}, mode).empty());
        EXPECT_TRUE(assemble_triangles(std::span(indices).first(2), mode).empty());
    }
}

TEST(RemoveDegenerate, KeepsThinTrianglesButNotFlatOnes) {
    const std::vector<Vec3f> p{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1e-6f, 0}, {0.1f, 0.2f, 0.3f}, {0.2f, 0.4f, 0.6f}};
    std::vector<Triangle> triangles{{0, 1, 3}, {0, 1, 2}, {0, 0, 3}, {0, 4, 5}};
    EXPECT_EQ(remove_degenerate_triangles(triangles, p), 3u);
    EXPECT_EQ(triangles, (std::vector<Triangle>{{0, 1, 3}}));
}

TEST(CompactVertices, KeepsUsedOnesInOrder) {
    std::vector<Triangle> triangles{{5, 2, 9}, {9, 2, 3}};
    EXPECT_EQ(compact_vertices(triangles, 12), (std::vector<std::uint32_t>{2, 3, 5, 9}));
    EXPECT_EQ(triangles, (std::vector<Triangle>{{2, 0, 3}, {3, 0, 1}}));
}

TEST(AreaWeightedNormals, LargerTrianglesCountMore) {
    // Two triangles share an edge along y: one in the xy plane with area 1/2, one in the yz plane with area 2.
    const std::vector<Vec3f> p{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, -4}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 3, 1}};
    const std::vector<Vec3f> n = area_weighted_normals(triangles, p);
    EXPECT_NEAR(n[2].z, 1.0f, 1e-6f);
    EXPECT_NEAR(n[3].x, 1.0f, 1e-6f);
    EXPECT_NEAR(n[0].x / n[0].z, 4.0f, 1e-5f);
    EXPECT_NEAR(length(n[0]), 1.0f, 1e-6f);
}

TEST(AreaWeightedNormals, CancellingSidesStillGiveAUnitNormal) {
    const std::vector<Vec3f> p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 1}};
    for (const Vec3f& n : area_weighted_normals(triangles, p)) EXPECT_NEAR(std::abs(n.z), 1.0f, 1e-6f);
}

}  // namespace
}  // namespace etendue
