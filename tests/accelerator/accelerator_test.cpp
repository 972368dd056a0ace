// All structures against a search through all triangles, bit by bit, on scenes and rays that are hard on purpose.
#include "accelerator/accelerator.h"

#include "support/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::array kStructures{AcceleratorKind::Bvh, AcceleratorKind::BvhMiddle, AcceleratorKind::BvhCounts,
                                 AcceleratorKind::KdTree, AcceleratorKind::Grid};

using Triangles = std::vector<Triangle>;

Vec3f in_cube(Random& random, float half) {
    const float x = random.next();
    const float y = random.next();
    return (Vec3f(x, y, random.next()) * 2.0f - Vec3f(1.0f)) * half;
}

Vec3f unit_vector(Random& random) {
    for (;;) {
        const Vec3f v = in_cube(random, 1.0f);
        if (length(v) > 0.1f && length(v) < 1.0f) return normalize(v);
    }
}

Triangles soup(int count, float size) {
    Random random(1);
    Triangles triangles;
    for (int i = 0; i < count; ++i) {
        const Vec3f a = in_cube(random, 1.0f);
        triangles.push_back({a, a + in_cube(random, size), a + in_cube(random, size)});
    }
    return triangles;
}

/// Makes the cubes of a chessboard in three dimensions: faces lie in each other's planes, and in those between cells.
Triangles cubes(int side) {
    Triangles triangles;
    const auto add_face = [&](const Vec3f& corner, const Vec3f& x, const Vec3f& y) {
        triangles.push_back({corner, corner + x, corner + x + y});
        triangles.push_back({corner, corner + x + y, corner + y});
    };
    const Vec3f x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    for (int i = 0; i < side * side * side; ++i) {
        const int a = i % side, b = i / side % side, c = i / side / side;
        if ((a + b + c) % 2 != 0) continue;
        const Vec3f corner(static_cast<float>(a), static_cast<float>(b), static_cast<float>(c));
        for (const auto& [from, to] : {std::pair(x, y), std::pair(y, z), std::pair(z, x)}) add_face(corner, from, to);
        add_face(corner + z, x, y);
        add_face(corner + x, y, z);
        add_face(corner + y, z, x);
    }
    return triangles;
}

/// Makes a closed surface whose triangles share their corners exactly.
Triangles ball(int rings) {
    const auto corner = [&](int ring, int sector) {
        const double theta = 3.14159265358979 * ring / rings;
        const double phi = 3.14159265358979 * (sector % (2 * rings)) / rings;
        return Vec3f(static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::cos(theta)),
                     static_cast<float>(std::sin(theta) * std::sin(phi)));
    };
    Triangles triangles;
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < 2 * rings; ++s) {
            if (r > 0) triangles.push_back({corner(r, s), corner(r, s + 1), corner(r + 1, s + 1)});
            if (r + 1 < rings) triangles.push_back({corner(r, s), corner(r + 1, s + 1), corner(r + 1, s)});
        }
    // At the pole sin(pi) is not quite zero, so that its corners are made one.
    for (Triangle& t : triangles)
        for (Vec3f* p : {&t.a, &t.b, &t.c})
            if (p->y == -1.0f) *p = {0, -1, 0};
    return triangles;
}

Triangles placed(Triangles triangles, float scale, const Vec3f& offset) {
    for (Triangle& t : triangles)
        for (Vec3f* p : {&t.a, &t.b, &t.c}) *p = *p * scale + offset;
    return triangles;
}

Triangles flattened(Triangles triangles) {
    for (Triangle& t : triangles) t.a.z = t.b.z = t.c.z = 0.5f;
    return triangles;
}

Triangles together(Triangles a, const Triangles& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Triangles without_area() {
    Triangles triangles = soup(30, 0.5f);
    const std::size_t count = triangles.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle t = triangles[i];
        triangles.push_back({t.a, t.a, t.a});
        triangles.push_back({t.a, t.b, t.b});
        triangles.push_back({t.a, t.b, (t.a + t.b) * 0.5f});
    }
    return triangles;
}

/// Makes triangles each half as far from zero as the one before, so that the middle cuts one off at a time.
Triangles ever_nearer() {
    Triangles triangles;
    for (int i = 0; i < 120; ++i) {
        const float x = std::ldexp(1.0f, -i);
        triangles.push_back({{x, 0, 0}, {x, 1, 0}, {x, 0, 1}});
    }
    return triangles;
}

struct Scene {
    std::string name;
    Triangles triangles;
    friend void PrintTo(const Scene& scene, std::ostream* out) { *out << scene.name; }
};

std::vector<Scene> scenes() {
    return {{"Nothing", {}},
            {"OneTriangle", soup(1, 1.0f)},
            {"Soup", soup(400, 0.3f)},
            {"LargeTriangles", soup(150, 3.0f)},
            {"Cubes", cubes(4)},
            {"Ball", ball(10)},
            {"OnePlane", flattened(soup(200, 0.3f))},
            {"SmallInLarge", together(placed(ball(8), 1e-3f, {0.7f, 0.2f, 0.1f}), soup(20, 2.0f))},
            {"FarFromZero", placed(soup(200, 0.3f), 1.0f, {1e5f, -3e4f, 7e4f})},
            {"Huge", placed(cubes(3), 1e15f, Vec3f(-1e15f))},
            {"Tiny", placed(cubes(3), 1e-12f, Vec3f(-1e-12f))},
            {"WithoutArea", without_area()},
            {"ManyAtOnePlace", Triangles(100, soup(1, 1.0f)[0])},
            {"EverNearer", ever_nearer()}};
}

Bounds bounds_of_all(const Triangles& triangles) {
    Bounds bounds;
    for (const Triangle& triangle : triangles) bounds.extend(bounds_of(triangle));
    return bounds;
}

/// Makes rays of every kind around `triangles`.
std::vector<Ray> hard_rays(const Triangles& triangles, std::size_t count) {
    Random random(7);
    Bounds bounds = bounds_of_all(triangles);
    if (bounds.empty()) bounds = {Vec3f(-1.0f), Vec3f(1.0f)};
    const Vec3f center = bounds.center();
    const float size = std::max(max_abs(bounds.size()), std::numeric_limits<float>::min());
    const auto a_corner = [&] {
        if (triangles.empty()) return center;
        const Triangle& t = triangles[static_cast<std::size_t>(random.next() * static_cast<float>(triangles.size()))];
        return random.next() < 0.5f ? t.a : t.c;
    };
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        Ray ray;
        ray.origin = center + in_cube(random, size);
        ray.direction = unit_vector(random);
        Vec3f axis(0.0f);
        axis[static_cast<int>(random.next() * 3.0f)] = random.next() < 0.5f ? 1.0f : -1.0f;
        switch (i % 8) {
            case 0:  // anywhere
                break;
            case 1:  // along an axis, from anywhere
                ray.direction = axis;
                break;
            case 2:  // along an axis, through a corner, so in the planes of faces and cells
                ray.origin = a_corner() - axis * size;
                ray.direction = axis;
                break;
            case 3:  // along a diagonal through a corner
                ray.direction = normalize(Vec3f(1, random.next() < 0.5f ? 1 : -1, 0));
                ray.origin = a_corner() - ray.direction * size;
                break;
            case 4:  // at a corner
                ray.direction = normalize(a_corner() - ray.origin);
                break;
            case 5:  // at an edge
                ray.direction = normalize(a_corner() * 0.5f + a_corner() * 0.5f - ray.origin);
                break;
            case 6:  // from far away
                ray.direction = normalize(in_cube(random, 0.5f));
                ray.origin = center - ray.direction * (1000.0f * size);
                break;
            case 7:  // from a corner, not far
                ray.origin = a_corner();
                ray.t_max = size * random.next();
                break;
        }
        rays.push_back(ray);
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    rays.push_back({.origin = center, .direction = {0, 0, 0}});
    rays.push_back({.origin = center, .direction = {nan, 0, 1}});
    rays.push_back({.origin = {nan, 0, 0}, .direction = {0, 0, 1}});
    rays.push_back({.origin = {kInfinity, 0, 0}, .direction = {-1, 0, 0}});
    return rays;
}

/// Lets rays pass every third triangle.
struct EveryThirdPasses final : TriangleFilter {
    bool stops(const TriangleHit& hit) override { return hit.triangle % 3 != 0; }
};

TriangleHit closest_of(const Accelerator& accelerator, const Ray& ray, TriangleFilter* filter = nullptr) {
    RayWork work;
    return accelerator.closest_hit(ray, filter, work);
}

class Accelerators : public testing::TestWithParam<Scene> {};

TEST_P(Accelerators, FindTheHitsOfASearchThroughAll) {
    const Triangles& triangles = GetParam().triangles;
    const auto brute = build_accelerator(AcceleratorKind::BruteForce, triangles);
    const std::vector<Ray> rays = hard_rays(triangles, 3000);
    EveryThirdPasses filter;
    std::vector<TriangleHit> hits, filtered;
    for (const Ray& ray : rays) {
        hits.push_back(closest_of(*brute, ray));
        filtered.push_back(closest_of(*brute, ray, &filter));
    }
    if (triangles.size() > 1) {
        EXPECT_GT(std::ranges::count_if(hits, &TriangleHit::valid), std::ssize(rays) / 20);
    }
    for (const AcceleratorKind kind : kStructures) {
        const auto structure = build_accelerator(kind, triangles);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            SCOPED_TRACE(testing::Message() << accelerator_name(kind) << ", ray " << i);
            ASSERT_EQ(closest_of(*structure, rays[i]), hits[i]) << "not at " << hits[i].t;
            ASSERT_EQ(closest_of(*structure, rays[i], &filter), filtered[i]);
            RayWork work;
            ASSERT_EQ(structure->any_hit(rays[i], nullptr, work), hits[i].valid());
            ASSERT_EQ(structure->any_hit(rays[i], &filter, work), filtered[i].valid());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Accelerators, testing::ValuesIn(scenes()),
                         [](const auto& scene) { return scene.param.name; });

TEST(TriangleTest, SaysWhereTheRayMeetsTheTriangle) {
    const Triangles triangles{{{0, 0, 2}, {4, 0, 2}, {0, 8, 2}}};
    const auto brute = build_accelerator(AcceleratorKind::BruteForce, triangles);
    const TriangleHit hit = closest_of(*brute, {.origin = {1, 2, 0}, .direction = {0, 0, 1}});
    EXPECT_EQ(hit, (TriangleHit{2.0f, 0.25f, 0.25f, 0}));
    EXPECT_EQ(closest_of(*brute, {.origin = {1, 2, 5}, .direction = {0, 0, -1}}), (TriangleHit{3.0f, 0.25f, 0.25f, 0}))
        << "from behind";
    EXPECT_TRUE(closest_of(*brute, {.origin = {1, 2, 0}, .direction = {0, 0, 1}, .t_max = 2.0f}).valid());
    EXPECT_FALSE(closest_of(*brute, {.origin = {1, 2, 0}, .direction = {0, 0, 1}, .t_max = 1.999f}).valid());
    EXPECT_FALSE(closest_of(*brute, {.origin = {1, 2, 2}, .direction = {0, 0, 1}}).valid()) << "starts there";
    EXPECT_FALSE(closest_of(*brute, {.origin = {3, 3, 0}, .direction = {0, 0, 1}}).valid()) << "beside it";
    EXPECT_FALSE(closest_of(*brute, {.origin = {-1, 1, 2}, .direction = {1, 0, 0}}).valid()) << "in its plane";
}

TEST(TriangleTest, MeetsOneOfTwoTrianglesAtTheEdgeThatTheyShare) {
    Triangles triangles{{{-1, 0, 1}, {0, -1, 1}, {0, 1, 1}}, {{1, 0, 1}, {0, 1, 1}, {0, -1, 1}}};
    // From both sides, and with each corner opposite of the edge.
    for (int order = 0; order < 6; ++order) {
        for (Triangle& t : triangles) t = order == 3 ? Triangle{t.a, t.c, t.b} : Triangle{t.b, t.c, t.a};
        const auto brute = build_accelerator(AcceleratorKind::BruteForce, triangles);
        for (const float y : {-1.0f, -0.3f, 0.0f, 1.0f})
            EXPECT_EQ(closest_of(*brute, {.origin = {0, y, 0}, .direction = {0, 0, 1}}).triangle, 0u)
                << order << " " << y;
    }
}

// In single precision, corners this far away would move the hit by centimetres.
TEST(TriangleTest, IsExactForLargeTriangles) {
    const float far = 1e6f;
    const Triangles triangles{{{-far, -far, -far}, {far, -far, far}, {0, 2 * far, 0}}};
    const auto brute = build_accelerator(AcceleratorKind::BruteForce, triangles);
    const TriangleHit hit = closest_of(*brute, {.origin = {0, 0.3f, 5.3f}, .direction = {0.6f, 0, -0.8f}});
    EXPECT_NEAR(hit.t, 5.3 / 1.4, 1e-6);
}

// Seen from inside, no ray leaves a closed surface, not even one that is aimed at an edge or a corner.
TEST(Accelerator, NoRayPassesBetweenTriangles) {
    const Triangles triangles = ball(40);
    const auto bvh = build_accelerator(AcceleratorKind::Bvh, triangles);
    Random random(3);
    std::size_t missed = 0;
    for (int i = 0; i < 100000; ++i) {
        const Triangle& t = triangles[static_cast<std::size_t>(random.next() * static_cast<float>(triangles.size()))];
        const Vec3f origin = in_cube(random, 0.3f);
        const float along = i % 4 == 0 ? 0.0f : random.next();
        missed +=
            !closest_of(*bvh, {.origin = origin, .direction = normalize(t.a + (t.c - t.a) * along - origin)}).valid();
    }
    EXPECT_EQ(missed, 0u);
}

TEST(Accelerator, CountsWhatARayHasItDo) {
    const Triangles triangles = ball(40);
    std::array<RayWork, 3> work;
    const std::array kinds{AcceleratorKind::BruteForce, AcceleratorKind::Bvh, AcceleratorKind::KdTree};
    constexpr std::uint64_t kRays = 100;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        const auto accelerator = build_accelerator(kinds[k], triangles);
        Random random(5);
        for (std::uint64_t i = 0; i < kRays; ++i)
            (void)accelerator->closest_hit({.direction = unit_vector(random)}, nullptr, work[k]);
    }
    EXPECT_EQ(work[0].triangles, kRays * triangles.size());
    EXPECT_EQ(work[0].nodes, 0u);
    for (const std::size_t k : {1u, 2u}) {
        EXPECT_GE(work[k].triangles, kRays) << "each of them meets one";
        EXPECT_LT(work[k].triangles, 30 * kRays);
        EXPECT_GE(work[k].nodes, kRays * 5);
        EXPECT_LT(work[k].nodes, kRays * 100);
    }
}

// Large triangles reach into very many cells and leaves; the bounds are those of docs/accelerators.md.
TEST(Accelerator, TakesABoundedAmountOfMemory) {
    const Triangles triangles = soup(3000, 3.0f);
    for (const AcceleratorKind kind : kStructures) {
        const AcceleratorStatistics built = build_accelerator(kind, triangles)->statistics();
        EXPECT_LE(built.references, kind == AcceleratorKind::Grid     ? 16 * triangles.size() + 4096
                                    : kind == AcceleratorKind::KdTree ? 8 * triangles.size()
                                                                      : triangles.size())
            << accelerator_name(kind);
        EXPECT_GE(built.references, triangles.size());
        EXPECT_GT(built.bytes, built.references * sizeof(std::uint32_t));
        EXPECT_LT(built.bytes, 500 * triangles.size()) << accelerator_name(kind);
        EXPECT_GT(built.nodes, 1u);
        EXPECT_GE(built.build_seconds, 0.0);
        EXPECT_LE(built.depth, 92);
    }
}

}  // namespace

}  // namespace etendue::test
