#include "wave/subpath/diffuse_lanes.h"

#include "core/ray.h"
#include "support/random.h"
#include "world/scattering.h"
#include "world/triangle_point.h"

#include <array>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

class DiffuseLanesIn : public testing::TestWithParam<TransportMode> {};

// The reference is what all other surfaces go through.
TEST_P(DiffuseLanesIn, ScatterAsThatOneSurfaceDoes) {
    const TransportMode mode = GetParam();
    Random random(31);
    const auto vec = [&] { return Vec3f(random.next(), random.next(), random.next()) * 2.0f - Vec3f(1.0f); };
    constexpr std::size_t kCount = kBlockLanes - 3;
    DiffuseLanes lanes;
    int scattered = 0;
    for (int block = 0; block < 200; ++block) {
        std::array<HitTriangle, kCount> triangles;
        std::array<Vec2f, kCount> places, numbers;
        for (std::size_t l = 0; l < kCount; ++l) {
            HitTriangle& triangle = triangles[l] = {vec(), vec(), vec(), Vec3f(0.0f)};
            // Every other one is smooth: its normal leans away from that of the triangle.
            if (l % 2 != 0) triangle.shading_normal = normalize(cross(triangle.edge1, triangle.edge2)) + vec() * 0.3f;
            places[l] = {0.5f * random.next(), 0.5f * random.next()};
            numbers[l] = {random.next(), random.next()};
            lanes.set_hit(l, triangle, places[l]);
            lanes.wo.set(l, normalize(vec()));
            lanes.albedo.set(l, Rgb(0.7f, 0.5f, 0.3f));
        }
        lanes.set_up_points(kCount);
        lanes.orient(kCount, mode);
        for (std::size_t l = 0; l < kCount; ++l) lanes.u.set(l, numbers[l]);
        lanes.sample(kCount, mode);
        for (std::size_t l = 0; l < kCount; ++l) {
            const auto& [p0, edge1, edge2, shading_normal] = triangles[l];
            const TrianglePoint<float> point(p0, edge1, edge2, places[l]);
            const Frame frame = Frame::from_normal(usable_normal(shading_normal, point.normal));
            const Bsdf bsdf = Diffuse{Rgb(0.7f, 0.5f, 0.3f)};
            const Scattering expected(bsdf, frame, point.normal, lanes.wo[l]);
            const BsdfSample sample = expected.sample(0.5f, numbers[l], mode);
            // Grazing directions may fall on either side, and the factor of importance knows no bound there.
            const float grazing = std::abs(expected.wo_local().z * dot(lanes.wo[l], point.normal) *
                                           dot(lanes.next_direction[l], point.normal));
            if (grazing < 1e-3f) continue;
            const Scattering placed(bsdf, lanes.surface(l));
            ASSERT_NEAR(placed.evaluate(lanes.next_direction[l], mode).f_cos.g,
                        expected.evaluate(lanes.next_direction[l], mode).f_cos.g, 1e-4f);
            ASSERT_NEAR(lanes.next_weight[l].g, sample.weight.g, 1e-3f * (1.0f + sample.weight.g));
            if (is_black(sample.weight)) continue;
            ++scattered;
            ASSERT_LT(length(lanes.next_direction[l] - sample.wi), 1e-4f);
            ASSERT_NEAR(lanes.next_pdf[l], sample.pdf_solid_angle, 1e-5f);
            ASSERT_NEAR(lanes.reverse_pdf[l], expected.reverse_pdf_solid_angle(sample.wi, mode), 1e-5f);
            ASSERT_NEAR(lanes.next_cosine[l], abs_dot(sample.wi, point.normal), 1e-4f);
            const Vec3f origin = offset_origin(lanes.position[l], point.normal, lanes.clearance[l], sample.wi);
            ASSERT_LT(length(lanes.next_origin[l] - origin), 0.5f * lanes.clearance[l]);
        }
    }
    EXPECT_GT(scattered, 5'000);
}

TEST(DiffuseLanes, StoreTheEndsOfThoseThatHaveOne) {
    Random random(59);
    const auto vec = [&] { return Vec3f(random.next(), random.next(), random.next()); };
    constexpr std::size_t kCount = kBlockLanes - 3;
    DiffuseLanes lanes;
    std::array<DiffuseEnd, kBlockLanes> ends;
    std::array<DiffuseEnd*, kCount> places;
    for (std::size_t l = 0; l < kCount; ++l) {
        lanes.position.set(l, vec());
        lanes.end_origin.set(l, vec());
        lanes.normal.set(l, vec());
        lanes.facing_normal.set(l, vec());
        lanes.end_weight.set(l, {random.next(), random.next(), random.next()});
        lanes.end_fewer.set(l, random.next());
        // Backwards, and every fourth has none.
        places[l] = l % 4 == 1 ? nullptr : &ends[kBlockLanes - 1 - l];
    }
    lanes.store_ends(places);
    for (std::size_t l = 0; l < kBlockLanes; ++l) {
        const DiffuseEnd& end = ends[kBlockLanes - 1 - l];
        ASSERT_EQ(end.exists(), l < kCount && l % 4 != 1) << l;
        if (!end.exists()) continue;
        EXPECT_EQ(end.position, lanes.position[l]);
        EXPECT_EQ(end.origin, lanes.end_origin[l]);
        EXPECT_EQ(end.normal, lanes.normal[l]);
        EXPECT_EQ(end.geometric_normal, lanes.facing_normal[l]);
        EXPECT_EQ(end.weight, lanes.end_weight[l]);
        EXPECT_EQ(end.fewer, lanes.end_fewer[l]);
    }
}

INSTANTIATE_TEST_SUITE_P(Modes, DiffuseLanesIn, testing::Values(TransportMode::Radiance, TransportMode::Importance),
                         [](const auto& mode) {
                             return mode.param == TransportMode::Radiance ? "Radiance" : "Importance";
                         });

}  // namespace

}  // namespace etendue::test
