#include "sampling/warp.h"

#include "sampling/warp_inverses.h"
#include "support/chi2.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

struct DirectionWarp {
    std::string name;
    std::function<Vec3f(Vec2f)> forward;
    std::function<double(const Vec3f&)> pdf;
    std::function<Vec2f(const Vec3f&)> inverse;
};

DirectionWarp cone_warp(float cos_max) {
    return {"cone " + std::to_string(cos_max), [=](Vec2f u) { return square_to_cone(u, cos_max); },
            [=](const Vec3f& w) { return static_cast<double>(cone_pdf_solid_angle(w, cos_max)); },
            [=](const Vec3f& w) { return cone_to_square(w, cos_max); }};
}

std::vector<DirectionWarp> direction_warps() {
    return {{"cosine hemisphere", square_to_cosine_hemisphere<float>,
             [](const Vec3f& w) { return static_cast<double>(cosine_hemisphere_pdf_solid_angle(w)); },
             cosine_hemisphere_to_square},
            {"sphere", square_to_sphere, [](const Vec3f&) { return static_cast<double>(sphere_pdf_solid_angle()); },
             sphere_to_square},
            {"hemisphere", square_to_hemisphere,
             [](const Vec3f& w) { return static_cast<double>(hemisphere_pdf_solid_angle(w)); }, hemisphere_to_square},
            cone_warp(0.99f),
            cone_warp(0.3f),
            cone_warp(-0.5f)};
}

/// A grid that keeps off the square's border, where an angle of zero may come back as a full turn.
std::vector<Vec2f> inner_grid() {
    std::vector<Vec2f> points;
    for (int i = 0; i < 41; ++i)
        for (int j = 0; j < 41; ++j)
            points.push_back({(static_cast<float>(i) + 0.4f) / 41.0f, (static_cast<float>(j) + 0.6f) / 41.0f});
    return points;
}

TEST(Warp, DirectionsAreUnitVectorsAndInvert) {
    for (const DirectionWarp& warp : direction_warps()) {
        SCOPED_TRACE(warp.name);
        for (const Vec2f& u : inner_grid()) {
            const Vec3f w = warp.forward(u);
            ASSERT_NEAR(length(w), 1.0f, 1e-5f);
            ASSERT_GT(warp.pdf(w), 0.0);
            const Vec2f back = warp.inverse(w);
            // Near the pole of a narrow cone z keeps few digits of u.
            ASSERT_NEAR(back.x, u.x, 1e-4f);
            ASSERT_NEAR(back.y, u.y, 1e-4f);
        }
        for (const Vec2f& corner : {Vec2f(0.0f, 0.0f), Vec2f(0.0f, kOneMinusEpsilon), Vec2f(kOneMinusEpsilon, 0.0f),
                                    Vec2f(kOneMinusEpsilon, kOneMinusEpsilon), Vec2f(0.5f, 0.5f)}) {
            const Vec3f w = warp.forward(corner);
            EXPECT_TRUE(is_finite(w)) << corner.x << " " << corner.y;
            EXPECT_NEAR(length(w), 1.0f, 1e-5f);
        }
    }
}

TEST(Warp, DirectionsFollowTheirDensities) {
    const std::vector<DirectionWarp> warps = direction_warps();
    for (const DirectionWarp& warp : warps) {
        SCOPED_TRACE(warp.name);
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> { return warp.forward(random.next_2d()); };
        const SamplerCheck check = check_sphere_sampler(sampler, warp.pdf);
        EXPECT_GE(check.chi2.p_value, sidak_level(kFamilyLevel, warps.size())) << check.chi2.str();
        EXPECT_NEAR(check.pdf_integral, 1.0, 2e-3);
    }
}

TEST(Warp, DensitiesAreZeroOutsideTheirDomain) {
    const Vec3f below = normalize({0.3f, 0.2f, -0.1f});
    EXPECT_EQ(cosine_hemisphere_pdf_solid_angle(below), 0.0f);
    EXPECT_EQ(hemisphere_pdf_solid_angle(below), 0.0f);
    EXPECT_EQ(cone_pdf_solid_angle(normalize({1.0f, 0.0f, 1.0f}), 0.8f), 0.0f);
    EXPECT_EQ(disk_pdf_area({0.8f, 0.8f}), 0.0f);
}

TEST(Warp, DiskInvertsAndIsUniform) {
    for (const Vec2f& u : inner_grid()) {
        const Vec2f p = square_to_disk(u);
        ASSERT_LE(p.x * p.x + p.y * p.y, 1.0f + 1e-6f);
        const Vec2f back = disk_to_square(p);
        ASSERT_NEAR(back.x, u.x, 1e-5f);
        ASSERT_NEAR(back.y, u.y, 1e-5f);
    }
    EXPECT_EQ(square_to_disk({0.5f, 0.5f}), Vec2f(0.0f, 0.0f));
    const auto sampler = [](Random& random) -> std::optional<Point> {
        const Vec2f p = square_to_disk(random.next_2d());
        return Point{static_cast<double>(p.x), static_cast<double>(p.y)};
    };
    const auto density = [](double x, double y) {
        return static_cast<double>(disk_pdf_area({static_cast<float>(x), static_cast<float>(y)}));
    };
    const SamplerCheck check = check_rect_sampler({-1.0, 1.0, -1.0, 1.0}, sampler, density);
    EXPECT_GE(check.chi2.p_value, kFamilyLevel) << check.chi2.str();
    EXPECT_NEAR(check.pdf_integral, 1.0, 2e-3);
}

TEST(Warp, RegularPolygonsInvertAndAreUniform) {
    const int shapes[] = {3, 8};
    for (const int corners : shapes) {
        SCOPED_TRACE(corners);
        for (const Vec2f& u : inner_grid()) {
            const Vec2f p = square_to_regular_polygon(u, corners);
            ASSERT_GT(regular_polygon_pdf_area(p, corners), 0.0f);
            const Vec2f back = regular_polygon_to_square(p, corners);
            ASSERT_NEAR(back.x, u.x, 1e-5f);
            ASSERT_NEAR(back.y, u.y, 1e-5f);
        }
        const auto sampler = [&](Random& random) -> std::optional<Point> {
            const Vec2f p = square_to_regular_polygon(random.next_2d(), corners);
            return Point{static_cast<double>(p.x), static_cast<double>(p.y)};
        };
        const auto density = [&](double x, double y) {
            return static_cast<double>(
                regular_polygon_pdf_area({static_cast<float>(x), static_cast<float>(y)}, corners));
        };
        const SamplerCheck check = check_rect_sampler({-1.0, 1.0, -1.0, 1.0}, sampler, density);
        EXPECT_GE(check.chi2.p_value, sidak_level(kFamilyLevel, std::size(shapes))) << check.chi2.str();
        EXPECT_NEAR(check.pdf_integral, 1.0, 5e-3);
    }
}

TEST(Warp, TriangleInvertsAndIsUniform) {
    for (const Vec2f& u : inner_grid()) {
        const Vec2f b = square_to_triangle(u);
        ASSERT_GE(b.x, 0.0f);
        ASSERT_GE(b.y, 0.0f);
        ASSERT_LE(b.x + b.y, 1.0f);
        const Vec2f back = triangle_to_square(b);
        ASSERT_NEAR(back.x, u.x, 1e-6f);
        ASSERT_NEAR(back.y, u.y, 1e-6f);
    }
    const auto sampler = [](Random& random) -> std::optional<Point> {
        const Vec2f b = square_to_triangle(random.next_2d());
        return Point{static_cast<double>(b.x), static_cast<double>(b.y)};
    };
    const auto density = [](double x, double y) { return x + y <= 1.0 ? 2.0 : 0.0; };
    const SamplerCheck check = check_rect_sampler({}, sampler, density);
    EXPECT_GE(check.chi2.p_value, kFamilyLevel) << check.chi2.str();
}

}  // namespace

}  // namespace etendue::test
