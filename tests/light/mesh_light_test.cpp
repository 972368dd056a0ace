#include "light/mesh_light.h"

#include "core/position_error.h"
#include "light/light_checks.h"
#include "support/chi2.h"
#include "support/t_test.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Moeller-Trumbore: distance along `d` from `o`, if it meets the triangle.
std::optional<float> meet(const LightTriangle& t, const Vec3f& o, const Vec3f& d) {
    const Vec3f p = cross(d, t.edge2);
    const float inverse = 1.0f / dot(t.edge1, p);
    const Vec3f s = o - t.p0;
    const float u = dot(s, p) * inverse;
    const Vec3f q = cross(s, t.edge1);
    const float v = dot(d, q) * inverse;
    const float distance = dot(t.edge2, q) * inverse;
    if (!(u >= 0.0f && v >= 0.0f && u + v <= 1.0f && distance > 0.0f)) return std::nullopt;
    return distance;
}

/// Density per solid angle, summed over all triangles that the direction meets: no matter which is nearest. `front` is
/// -1 if the light is mirrored.
double density(const MeshLight& light, const Vec3f& from, const Vec3f& direction, float front = 1.0f) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < light.triangle_count(); ++i) {
        const LightTriangle& t = light.triangle(i);
        if (const auto distance = meet(t, from, direction))
            sum += static_cast<double>(
                light.pdf_solid_angle(i, from, *distance, -front * dot(direction, normalize(cross(t.edge1, t.edge2)))));
    }
    return sum;
}

MeshLight make_light(const std::vector<LightTriangle>& triangles, bool two_sided = false, bool mirrored = false) {
    return {triangles, {2.0f, 4.0f, 6.0f}, {2.0f, 4.0f, 6.0f}, two_sided, mirrored, true, Vec3f(0.0f)};
}

std::vector<LightTriangle> quad_triangles(const Vec3f& center, const Vec3f& x, const Vec3f& y) {
    return {{center - x - y, x * 2.0f, x * 2.0f + y * 2.0f}, {center - x - y, x * 2.0f + y * 2.0f, y * 2.0f}};
}

/// Disk towards -y at height `height`, as a fan of `n` triangles of the disk's area.
std::vector<LightTriangle> disk_triangles(float radius, float height, int n) {
    std::vector<LightTriangle> triangles;
    const float step = 2.0f * kPi / static_cast<float>(n);
    const float r = radius * std::sqrt(step / std::sin(step));
    for (int i = 0; i < n; ++i) {
        const float a = step * static_cast<float>(i);
        const Vec3f p(r * std::cos(a), 0, r * std::sin(a));
        const Vec3f q(r * std::cos(a + step), 0, r * std::sin(a + step));
        triangles.push_back({{0, height, 0}, p, q});
    }
    return triangles;
}

TEST(MeshLight, DirectionsHaveTheStatedDensity) {
    // Triangles of unequal size, one without area, all facing the origin's side.
    std::vector<LightTriangle> triangles = quad_triangles({0, 3, 0}, {1.5f, 0, 0}, {0, 0, 0.5f});
    triangles.push_back({{0, 3, 2}, {1, 0, 0}, {2, 0, 0}});
    triangles.push_back({{-1, 2.5f, 1}, {0.9f, 0, 0}, {0, 0.3f, 0.9f}});
    const MeshLight light = make_light(triangles, true);
    const Vec3f points[] = {{0, 0, 0}, {2, 1, -1}, {0.2f, 2.7f, 0.1f}};
    for (const Vec3f& point : points) {
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> {
            const LightSample s = light.sample(point, random.next_2d(), random.next_2d());
            if (!(s.pdf_solid_angle > 0.0f)) return std::nullopt;
            return s.wi;
        };
        const SamplerCheck check =
            check_sphere_sampler(sampler, [&](const Vec3f& w) { return density(light, point, w); });
        EXPECT_GT(check.chi2.p_value, sidak_level(kFamilyLevel, std::size(points))) << check.chi2.str();
        EXPECT_NEAR(check.pdf_integral, 1.0, 5e-3);
    }
}

// The two triangles of a rectangle, in whatever order and from whichever vertex.
TEST(MeshLight, RectanglesAreFoundAmongTriangles) {
    const Vec3f corners[] = {{1, 2, 3}, {3, 2, 3}, {3, 2, 4}, {1, 2, 4}};
    const auto triangle = [&](int a, int b, int c) {
        return LightTriangle{corners[a], corners[b] - corners[a], corners[c] - corners[a]};
    };
    Random random(12);
    for (int turn = 0; turn < 9; ++turn)
        for (const bool other_diagonal : {false, true}) {
            const int shift = other_diagonal ? 1 : 0;
            const auto at = [&](int i) { return (i + shift) % 4; };
            const int first[] = {at(0), at(1), at(2)};
            const int second[] = {at(2), at(3), at(0)};
            const int k = turn % 3;
            const int l = turn / 3;
            const std::vector<LightTriangle> triangles = {
                triangle(first[k], first[(k + 1) % 3], first[(k + 2) % 3]),
                triangle(second[l], second[(l + 1) % 3], second[(l + 2) % 3])};
            const std::optional<LightRectangle> found = LightRectangle::find(triangles);
            ASSERT_TRUE(found);
            // All parts of the rectangle are places of it, and those of its quarters in its quarters.
            double middle[3] = {0.0, 0.0, 0.0};
            for (int i = 0; i < 400; ++i) {
                const RectanglePlace place = found->place(random.next_2d());
                const LightTriangle& t = triangles[place.triangle];
                EXPECT_LE(place.barycentric.x + place.barycentric.y, 1.0f + 1e-6f);
                const Vec3f p = t.p0 + t.edge1 * place.barycentric.x + t.edge2 * place.barycentric.y;
                EXPECT_TRUE(p.x >= 1.0f && p.x <= 3.0f && p.z >= 3.0f && p.z <= 4.0f && p.y == 2.0f) << p;
                for (int axis = 0; axis < 3; ++axis) middle[axis] += static_cast<double>(p[axis]) / 400.0;
            }
            EXPECT_NEAR(middle[0], 2.0, 0.15);
            EXPECT_NEAR(middle[2], 3.5, 0.08);
            EXPECT_TRUE(found->seen_from({2.0f, 1.0f, 3.5f}));
            EXPECT_FALSE(found->seen_from({2.0f, 12.0f, 3.5f}));
        }
}

TEST(MeshLight, OtherPairsOfTrianglesAreNoRectangles) {
    const LightTriangle half{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
    const std::vector<LightTriangle> pairs[] = {
        {half},
        {half, half},
        {half, {{2, 1, 0}, {0, -1, 0}, {-2, 0, 0}}},                                // with the other front
        {half, {{2, 1, 0.1f}, {-2, 0, -0.1f}, {0, -1, -0.1f}}},                     // bent
        {half, {{2, 1.5f, 0}, {-2, -0.5f, 0}, {0, -1.5f, 0}}},                      // a trapezium
        {half, {{2, 1, 0}, {-2, 0, 0}, {-2, -1, 0}}},                               // its diagonal is another
        {{{0, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{3, 1, 0}, {-2, 0, 0}, {-1, -1, 0}}},  // a parallelogram
        {{{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}, {{4, 0, 0}, {-2, 0, 0}, {-4, 0, 0}}}};  // without area
    for (const std::vector<LightTriangle>& triangles : pairs) EXPECT_FALSE(LightRectangle::find(triangles));
    EXPECT_TRUE(LightRectangle::find(std::vector<LightTriangle>{half, {{2, 1, 0}, {-2, 0, 0}, {0, -1, 0}}}));
}

// Before it, almost in its plane, and so far away that samples are by area; of one side and of both.
TEST(MeshLight, DirectionsToRectanglesHaveTheStatedDensity) {
    const std::vector<LightTriangle> triangles = quad_triangles({0, 3, 0}, {1.5f, 0, 0}, {0, 0, 0.5f});
    struct Case {
        Vec3f point;
        bool two_sided;
        bool is_by_solid_angle;
    };
    const Case cases[] = {
        {{0.2f, 2.5f, 0.1f}, false, true}, {{1.51f, 2.98f, 0.3f}, true, true}, {{0.3f, -7, 2}, true, false}};
    for (const auto& [point, two_sided, is_by_solid_angle] : cases) {
        const MeshLight light = make_light(triangles, two_sided);
        const auto sampler = [&, &point = point](Random& random) -> std::optional<Vec3f> {
            const LightSample s = light.sample(point, random.next_2d(), random.next_2d());
            if (!(s.pdf_solid_angle > 0.0f)) return std::nullopt;
            return s.wi;
        };
        const SamplerCheck check =
            check_sphere_sampler(sampler, [&, &point = point](const Vec3f& w) { return density(light, point, w); },
                                 {.samples = 20'000, .tolerance = 1e-5});
        EXPECT_GT(check.chi2.p_value, sidak_level(kFamilyLevel, std::size(cases))) << check.chi2.str();
        Random random(7);
        float least = 1e9f;
        float most = 0.0f;
        for (int i = 0; i < 200; ++i) {
            const LightSample s = light.sample(point, random.next_2d(), random.next_2d());
            const LightTriangle& t = light.triangle(s.triangle);
            const Vec3f on_light = t.p0 + t.edge1 * s.barycentric.x + t.edge2 * s.barycentric.y;
            EXPECT_NEAR(light.pdf_solid_angle(s.triangle, point, s.distance, s.cos_light) / s.pdf_solid_angle, 1.0f,
                        1e-3f);
            const float per_area = s.pdf_solid_angle * std::abs(s.cos_light) / (s.distance * s.distance);
            EXPECT_NEAR(light.gain(s.triangle, on_light, point) / (per_area * light.area()), 1.0f, 1e-3f);
            least = std::min(least, s.pdf_solid_angle);
            most = std::max(most, s.pdf_solid_angle);
        }
        EXPECT_EQ(most / least < 1.001f, is_by_solid_angle) << point;
    }
}

// In an odd plane, points of a lamp lie beside it by rounding, and must not see it as half a sphere.
TEST(MeshLight, RectanglesDoNotLightThemselves) {
    const Vec3f x = normalize(Vec3f(1.0f, 0.3f, 0.2f)) * 1.5f;
    const Vec3f normal = normalize(cross(x, Vec3f(0.2f, 1.0f, 0.4f)));
    const Vec3f y = normalize(cross(normal, x)) * 0.7f;
    const Vec3f center(5.0f, -3.0f, 8.0f);
    const MeshLight light(quad_triangles(center, x, y), Rgb(1.0f), Rgb(1.0f), true, false, true,
                          position_error({8.0f, 6.0f, 10.0f}));
    constexpr int kSamples = 20'000;
    double received = 0.0;
    Random random(9);
    for (int i = 0; i < kSamples; ++i) {
        const Vec3f point = center + x * (1.8f * random.next() - 0.9f) + y * (1.8f * random.next() - 0.9f);
        const LightSample s = light.sample(point, random.next_2d(), random.next_2d());
        if (s.pdf_solid_angle > 0.0f)
            received += static_cast<double>(abs_dot(s.wi, normal) / s.pdf_solid_angle) / kSamples;
    }
    EXPECT_LT(received, 1e-4);
}

TEST(MeshLight, SamplesStateTheDensityOfTheirHit) {
    const MeshLight light = make_light(quad_triangles({0, 3, 0}, {1, 0, 0}, {0, 0, 1}), true);
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3f from(random.next() - 0.5f, random.next(), random.next());
        const LightSample s = light.sample(from, random.next_2d(), random.next_2d());
        const LightTriangle& t = light.triangle(s.triangle);
        const Vec3f on_light = t.p0 + t.edge1 * s.barycentric.x + t.edge2 * s.barycentric.y;
        EXPECT_LT(length(from + s.wi * s.distance - on_light), 1e-5f);
        EXPECT_NEAR(light.pdf_solid_angle(s.triangle, from, s.distance, s.wi.y) / s.pdf_solid_angle, 1.0f, 1e-4f);
    }
}

TEST(MeshLight, TrianglesGetSamplesByArea) {
    std::vector<LightTriangle> triangles;
    std::vector<double> expected;
    double total = 0.0;
    for (const float size : {1.0f, 0.1f, 0.0f, 2.0f, 0.5f}) {
        triangles.push_back({{0, 0, 0}, {size, 0, 0}, {0, 1, 0}});
        expected.push_back(static_cast<double>(size));
        total += static_cast<double>(size);
    }
    const MeshLight light = make_light(triangles);
    EXPECT_FLOAT_EQ(light.area(), 1.8f);
    constexpr int kSamples = 20'000;
    for (double& e : expected) e *= kSamples / total;
    std::vector<double> observed(expected.size());
    Random random(1);
    for (int i = 0; i < kSamples; ++i) ++observed[light.sample({0, 0, 1}, random.next_2d(), random.next_2d()).triangle];
    const Chi2Result result = chi2_counts(observed, expected);
    EXPECT_GT(result.p_value, kFamilyLevel) << result.str();
    EXPECT_EQ(observed[2], 0.0);
}

/// The six sides of a box, facing outwards, cut in unequal triangles; `top` more half sides high on one side, so that
/// the pairs are neither alike nor exactly opposite.
std::vector<LightTriangle> box_triangles(const Vec3f& center, const Vec3f& half, float top) {
    const auto corner = [&](int i) {
        Vec3f p((i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y, (i & 4) != 0 ? half.z : -half.z);
        if (p.x > 0.0f && p.y > 0.0f) p.y += top * half.y;
        return center + p;
    };
    std::vector<LightTriangle> triangles;
    const auto add = [&](int a, int b, int c, int d) {
        const Vec3f cut = corner(a) * 0.7f + corner(b) * 0.3f;  // on one edge, so that there are three
        for (const auto& [p, q, r] : {std::array{cut, corner(b), corner(c)}, std::array{cut, corner(c), corner(d)},
                                      std::array{cut, corner(d), corner(a)}})
            triangles.push_back({p, q - p, r - p});
    };
    add(0, 4, 6, 2);
    add(1, 3, 7, 5);
    add(0, 1, 5, 4);
    add(2, 6, 7, 3);
    add(0, 2, 3, 1);
    add(4, 5, 7, 6);
    return triangles;
}

TEST(MeshLight, DirectionsToClosedLampsHaveTheStatedDensity) {
    // Before three sides, near the slant, and turned inside out from outside and from within, where both sides of a
    // pair face the point.
    struct Case {
        Vec3f point;
        bool mirrored;
    };
    const Case cases[] = {
        {{-2, -1.5f, 2.5f}, false}, {{1.3f, 1.05f, 0}, false}, {{0.1f, 3, 0.2f}, true}, {{0.2f, 0.1f, 0.3f}, true}};
    for (const Case& c : cases) {
        const MeshLight light = make_light(box_triangles(Vec3f(0.0f), {1, 0.7f, 0.5f}, 0.2f), false, c.mirrored);
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> {
            const LightSample s = light.sample(c.point, random.next_2d(), random.next_2d());
            if (!(s.pdf_solid_angle > 0.0f)) return std::nullopt;
            return s.wi;
        };
        const float front = c.mirrored ? -1.0f : 1.0f;
        const SamplerCheck check = check_sphere_sampler(
            sampler, [&](const Vec3f& w) { return density(light, c.point, w, front); }, {.tolerance = 1e-5});
        EXPECT_GT(check.chi2.p_value, sidak_level(kFamilyLevel, std::size(cases))) << check.chi2.str();
    }
}

TEST(MeshLight, NoSampleFallsOnTheFarSideOfABox) {
    const Light light = make_light(box_triangles({0, 3, 0}, {0.5f, 0.25f, 1}, 0.0f));
    const MeshLight& box = std::get<MeshLight>(light);
    Random random(4);
    for (int i = 0; i < 1000; ++i) {
        const Vec3f from(8.0f * random.next() - 4.0f, 0.0f, 8.0f * random.next() - 4.0f);
        const LightSample s = box.sample(from, random.next_2d(), random.next_2d());
        // Only from between two planes do both sides of a pair face away.
        if (std::abs(from.x) > 0.5f && std::abs(from.z) > 1.0f) {
            EXPECT_GT(s.pdf_solid_angle, 0.0f) << from;
        }
    }
}

TEST(MeshLight, ChoosesTrianglesForManyAsForEach) {
    const MeshLight box = make_light(box_triangles({0, 3, 0}, {0.5f, 0.25f, 1}, 0.2f));
    const MeshLight quad = make_light(quad_triangles({0, 3, 0}, {1.5f, 0, 0}, {0, 0, 0.5f}));
    const std::array<const MeshLight*, 4> any = {&box, nullptr, &quad, &box};
    constexpr MeshLight::TriangleChoice kUntouched{1234, 5.0f, {0.5f, 0.25f}};
    constexpr std::size_t kCount = 200;
    std::vector<const MeshLight*> lights;
    std::vector<Vec3f> points;
    std::vector<Vec2f> u;
    std::vector<Vec2f> u_direction;
    Random random(9);
    for (std::size_t i = 0; i < kCount; ++i) {
        lights.push_back(any[i % any.size()]);
        points.emplace_back(8.0f * random.next() - 4.0f, 6.0f * random.next(), 8.0f * random.next() - 4.0f);
        u.push_back(random.next_2d());
        u_direction.push_back(random.next_2d());
    }
    std::vector<MeshLight::TriangleChoice> choices(kCount, kUntouched);
    MeshLight::choose_triangles(lights, points, u, u_direction, choices);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
        const MeshLight::TriangleChoice alone =
            lights[i] != nullptr ? lights[i]->choose_triangle(points[i], u[i], u_direction[i]) : kUntouched;
        EXPECT_EQ(choices[i].triangle, alone.triangle) << i;
        EXPECT_EQ(choices[i].gain, alone.gain) << i;
        EXPECT_EQ(choices[i].u, alone.u) << i;
        moved += lights[i] == &box && alone.gain != 1.0f ? 1 : 0;
    }
    EXPECT_GT(moved, kCount / 10) << "of the box, sides that face away give way to others";
}

// pi L (r / d)² on a surface that faces the middle of a sphere.
TEST(MeshLight, ASphereBringsItsFormFactor) {
    constexpr int kAround = 96;
    const auto on_sphere = [](int ring, int step) {
        const float theta = kPi * static_cast<float>(ring) / (kAround / 2.0f);
        const float phi = 2.0f * kPi * static_cast<float>(step) / kAround;
        return Vec3f(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
    };
    std::vector<LightTriangle> triangles;
    for (int ring = 0; ring < kAround / 2; ++ring)
        for (int step = 0; step < kAround; ++step) {
            const Vec3f a = on_sphere(ring, step);
            const Vec3f b = on_sphere(ring, step + 1);
            const Vec3f c = on_sphere(ring + 1, step + 1);
            const Vec3f d = on_sphere(ring + 1, step);
            triangles.push_back({a, b - a, c - a});
            triangles.push_back({a, c - a, d - a});
        }
    // The mesh lies within the sphere, some 0.07% of the radius on average.
    const Light light = make_light(triangles);
    const Vec3f from(0, -3, 0);
    const double expected = static_cast<double>(kPi) * 4.0 / 9.0;
    const TTestResult result = t_test(irradiance_samples(light, from, {0, 1, 0}, 20'000, 5), expected, 2e-3);
    EXPECT_GT(result.p_value, 0.001) << result.str();
}

TEST(MeshLight, OneSidedLightShinesToItsFrontOnly) {
    const std::vector<LightTriangle> triangles = quad_triangles(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0});  // front: +z
    for (const bool mirrored : {false, true})
        for (const float z : {2.0f, -2.0f}) {
            const bool front = (z > 0.0f) != mirrored;
            const LightSample one =
                make_light(triangles, false, mirrored).sample({0, 0, z}, {0.5f, 0.5f}, {0.2f, 0.7f});
            EXPECT_EQ(one.pdf_solid_angle > 0.0f, front);
            EXPECT_EQ(is_black(one.radiance), !front);
            const LightSample two = make_light(triangles, true, mirrored).sample({0, 0, z}, {0.5f, 0.5f}, {0.2f, 0.7f});
            EXPECT_GT(two.pdf_solid_angle, 0.0f);
            EXPECT_EQ(two.radiance, Rgb(2.0f, 4.0f, 6.0f));
        }
}

// Irradiance on the axis of a disk of radius r at distance h: pi L r² / (r² + h²).
TEST(MeshLight, ADiskBringsItsFormFactor) {
    const float radius = 1.5f;
    const float height = 2.0f;
    const Light light = make_light(disk_triangles(radius, height, 256));
    const double expected = static_cast<double>(kPi) * 4.0 * 2.25 / (2.25 + 4.0);
    const TTestResult result = t_test(irradiance_samples(light, Vec3f(0.0f), {0, 1, 0}, 50'000, 2), expected, 1e-3);
    EXPECT_GT(result.p_value, 0.001) << result.str();
}

// A rectangle a × b parallel to a surface at distance h above one of its corners, form factor of differential area:
// (A atan(B / sqrt(1 + A²)) / sqrt(1 + A²) + B atan(A / sqrt(1 + B²)) / sqrt(1 + B²)) / (2 pi), A = a/h, B = b/h.
TEST(MeshLight, ARectangleBringsItsFormFactor) {
    const Light light = make_light(quad_triangles({1.0f, 2.0f, 0.75f}, {1.0f, 0, 0}, {0, 0, 0.75f}), true);
    const double a = 2.0 / 2.0;
    const double b = 1.5 / 2.0;
    const double ra = std::sqrt(1.0 + a * a);
    const double rb = std::sqrt(1.0 + b * b);
    const double form_factor = (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2.0 * M_PI);
    const TTestResult result =
        t_test(irradiance_samples(light, Vec3f(0.0f), {0, 1, 0}, 50'000, 4), M_PI * 4.0 * form_factor, 1e-4);
    EXPECT_GT(result.p_value, 0.001) << result.str();
}

// From right below, most of the light comes from a part of a large rectangle, which samples by area find by chance
// only.
TEST(MeshLight, ANearRectangleBringsItsFormFactorWithLittleNoise) {
    const Light light = make_light(quad_triangles({0, 0.1f, 0}, {2.0f, 0, 0}, {0, 0, 1.0f}), true);
    const double a = 2.0 / 0.1;
    const double b = 1.0 / 0.1;
    const double ra = std::sqrt(1.0 + a * a);
    const double rb = std::sqrt(1.0 + b * b);
    const double form_factor = 4.0 * (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2.0 * M_PI);
    const double expected = M_PI * 4.0 * form_factor;
    const std::vector<double> samples = irradiance_samples(light, Vec3f(0.0f), {0, 1, 0}, 50'000, 4);
    const TTestResult result = t_test(samples, expected, 1e-4 * expected);
    EXPECT_GT(result.p_value, 0.001) << result.str();
    double squares = 0.0;
    for (const double sample : samples) squares += (sample / expected - 1.0) * (sample / expected - 1.0);
    // A cosine that is uniform in [0, 1] has the variance 1/3 of its mean's square; by area it is 50.
    EXPECT_LT(squares / 50'000, 0.4);
}

TEST(MeshLight, PowerIsRadianceTimesPiTimesAreaPerSide) {
    const std::vector<LightTriangle> triangles = quad_triangles(Vec3f(0.0f), {1, 0, 0}, {0, 0.5f, 0});
    EXPECT_NEAR(make_light(triangles).power(1.0f), kPi * 2.0f * 4.0f, 1e-3f);
    EXPECT_NEAR(make_light(triangles, true).power(1.0f), 2.0f * kPi * 2.0f * 4.0f, 1e-3f);
}

// Where a texture darkens the light, its mean counts and not the factor.
TEST(MeshLight, PowerIsOfTheMeanRadiance) {
    const std::vector<LightTriangle> triangles = quad_triangles(Vec3f(0.0f), {1, 0, 0}, {0, 0.5f, 0});
    const MeshLight light(triangles, Rgb(8.0f), {0.5f, 1.0f, 3.0f}, false, false, true, Vec3f(0.0f));
    EXPECT_NEAR(light.power(1.0f), kPi * 2.0f * 1.5f, 1e-4f);
    EXPECT_NEAR(light.bounds().power, static_cast<double>(light.power(1.0f)), 1e-6);
}

}  // namespace

}  // namespace etendue::test
