#include "light/shape_light.h"

#include "light/light_checks.h"
#include "support/chi2.h"
#include "support/t_test.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr double kPiInDouble = std::numbers::pi;

Mat4f scaled_and_moved(const Vec3f& scale, const Vec3f& to) {
    Mat4f m;
    m.setScale(scale);
    for (int i = 0; i < 3; ++i) m[3][i] = to[i];
    return m;
}

ShapeLight shape_light(ShapeKind kind, const Mat4f& to_world, bool two_sided = false) {
    return {ExactShape(kind, to_world), {2.0f, 4.0f, 6.0f}, {2.0f, 4.0f, 6.0f}, two_sided, true, Vec3f(0.0f)};
}

/// Density per solid angle of a direction, over all that it meets of the light.
double density_of_hits(const ShapeLight& light, const Vec3f& from, const Vec3f& direction) {
    const ShapeCrossings crossings = light.shape().crossings(from, direction);
    double sum = 0.0;
    for (std::size_t i = 0; i < crossings.count; ++i)
        if (const ShapeCrossing& c = crossings.all[i]; c.t > 0.0)
            sum += static_cast<double>(light.pdf_solid_angle(from, from + direction * static_cast<float>(c.t),
                                                             -dot(direction, normalize(c.normal))));
    return sum;
}

struct LitPoint {
    ShapeLight light;
    Vec3f point;
};

std::vector<LitPoint> lit_points() {
    const Mat4f ball = scaled_and_moved(Vec3f(0.7f), {0.2f, 1.0f, -0.3f});
    Mat4f stretched = scaled_and_moved({0.9f, 0.3f, 0.6f}, {0.2f, 1.0f, -0.3f});
    stretched[1][0] = 0.4f;  // sheared, too
    const Mat4f plate = scaled_and_moved({1.5f, 0.5f, 1.0f}, {0.0f, 0.2f, 1.0f});
    const Mat4f tube = scaled_and_moved({0.5f, 0.9f, 0.5f}, {0.0f, 1.5f, 0.0f});
    return {{shape_light(ShapeKind::Sphere, ball), {0.0f, 0.0f, 0.0f}},
            {shape_light(ShapeKind::Sphere, ball), {0.2f, 0.29f, -0.3f}},  // a hundredth from its surface
            {shape_light(ShapeKind::Sphere, ball), {0.0f, -4.0f, 9.0f}},
            {shape_light(ShapeKind::Sphere, ball, true), {0.3f, 1.2f, -0.4f}},  // within
            {shape_light(ShapeKind::Disk, plate, true), {0.3f, 0.0f, 0.1f}},
            {shape_light(ShapeKind::Sphere, stretched), {0.4f, -0.6f, 0.2f}},
            {shape_light(ShapeKind::Sphere, stretched, true), {0.2f, 1.1f, -0.2f}},  // within
            {shape_light(ShapeKind::Cylinder, tube), {0.4f, 0.1f, 0.2f}}};
}

TEST(ShapeLight, DirectionsHaveTheStatedDensity) {
    const std::vector<LitPoint> all = lit_points();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto& [light, point] = all[i];
        const auto sampler = [&, &light = light, &point = point](Random& random) -> std::optional<Vec3f> {
            const LightSample s = light.sample(point, random.next_2d(), random.next_2d());
            if (!(s.pdf_solid_angle > 0.0f)) return std::nullopt;
            return s.wi;
        };
        const SamplerCheck check = check_sphere_sampler(
            sampler, [&, &light = light, &point = point](const Vec3f& w) { return density_of_hits(light, point, w); });
        EXPECT_GT(check.chi2.p_value, sidak_level(kFamilyLevel, all.size())) << i << ": " << check.chi2.str();
    }
}

// Places where light paths start, as directions in which a point sees them: of closed shapes from within. All four
// tests together fail with probability 0.01 if everything is right.
TEST(ShapeLight, LightPathsStartWithTheStatedDensity) {
    const Mat4f ball = scaled_and_moved(Vec3f(0.7f), {0.2f, 1.0f, -0.3f});
    Mat4f stretched = scaled_and_moved({0.9f, 0.3f, 0.6f}, {0.2f, 1.0f, -0.3f});
    stretched[1][0] = 0.4f;  // sheared, too
    const Mat4f plate = scaled_and_moved({1.5f, 0.5f, 1.0f}, {0.0f, 0.2f, 1.0f});
    const Mat4f tube = scaled_and_moved({0.5f, 0.9f, 0.5f}, {0.0f, 1.5f, 0.0f});
    const std::vector<LitPoint> all{{shape_light(ShapeKind::Sphere, ball), {0.3f, 1.2f, -0.4f}},
                                    {shape_light(ShapeKind::Sphere, stretched), {0.2f, 1.1f, -0.2f}},
                                    {shape_light(ShapeKind::Disk, plate, true), {0.3f, 0.0f, 0.1f}},
                                    {shape_light(ShapeKind::Cylinder, tube), {0.1f, 1.3f, 0.1f}}};
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto& [light, point] = all[i];
        const auto sampler = [&, &light = light, &point = point](Random& random) -> std::optional<Vec3f> {
            const EmissionSample s =
                light.sample_emission({random.next_2d(), random.next_2d(), random.next_2d()}, SceneSphere{});
            EXPECT_EQ(s.pdf_position_area, light.pdf_area(s.position));
            return normalize(s.position - point);
        };
        const auto density = [&, &light = light, &point = point](const Vec3f& w) {
            const ShapeCrossings crossings = light.shape().crossings(point, w);
            double sum = 0.0;
            for (std::size_t c = 0; c < crossings.count; ++c) {
                const double t = crossings.all[c].t;
                if (!(t > 0.0)) continue;
                const auto cosine = static_cast<double>(std::abs(dot(w, normalize(crossings.all[c].normal))));
                const float per_area = light.pdf_area(point + w * static_cast<float>(t));
                sum += static_cast<double>(per_area) * t * t / cosine;
            }
            return sum;
        };
        const SamplerCheck check = check_sphere_sampler(sampler, density, {.samples = 20'000, .tolerance = 2e-5});
        EXPECT_NEAR(check.pdf_integral, 1.0, 2e-3) << i;
        EXPECT_GT(check.chi2.p_value, sidak_level(kFamilyLevel, all.size())) << i << ": " << check.chi2.str();
    }
}

// The place, its distance and its density are those of the ray that goes there, and the gain says how that density
// compares with that of light paths.
TEST(ShapeLight, SamplesStateTheDensityOfTheirHit) {
    Random random(3);
    for (const auto& [light, point] : lit_points())
        for (int i = 0; i < 500; ++i) {
            const LightSample s = light.sample(point, random.next_2d(), random.next_2d());
            if (!(s.pdf_solid_angle > 0.0f)) continue;
            const ShapePoint on_light = light.shape().point(shape_place(s.triangle, s.barycentric));
            EXPECT_LT(length(point + s.wi * s.distance - on_light.position), 2e-6f * (1.0f + s.distance));
            EXPECT_NEAR(s.cos_light, -dot(s.wi, on_light.normal), 1e-6f);
            EXPECT_EQ(light.pdf_solid_angle(point, on_light.position, s.cos_light), s.pdf_solid_angle);
            const float per_area = s.pdf_solid_angle * std::abs(s.cos_light) / (s.distance * s.distance);
            // At grazing angles the cosine is known by its rounding only.
            if (std::abs(s.cos_light) < 0.03f) continue;
            const float by_area = light.pdf_area(on_light.position);
            EXPECT_NEAR(light.gain(on_light.position, point) * by_area / per_area, 1.0f, 1e-3f);
        }
}

TEST(ShapeLight, IsLitFromItsFrontOnlyUnlessTwoSided) {
    Mat4f place = scaled_and_moved(Vec3f(1.0f), {0.0f, 0.0f, 0.0f});
    const ShapeLight disk = shape_light(ShapeKind::Disk, place);
    EXPECT_GT(disk.sample({0.0f, 0.0f, -1.0f}, {0.5f, 0.5f}, {0.3f, 0.6f}).pdf_solid_angle, 0.0f);
    EXPECT_EQ(disk.sample({0.0f, 0.0f, 1.0f}, {0.5f, 0.5f}, {0.3f, 0.6f}).pdf_solid_angle, 0.0f);
    const ShapeLight sphere = shape_light(ShapeKind::Sphere, place);
    EXPECT_EQ(sphere.sample({0.1f, 0.2f, 0.3f}, {0.5f, 0.5f}, {0.3f, 0.6f}).pdf_solid_angle, 0.0f);
    EXPECT_EQ(sphere.pdf_solid_angle({0.0f, 0.0f, 3.0f}, {0.0f, 0.0f, -1.0f}, -0.7f), 0.0f);
}

// pi L (r / d)² on a surface that faces the middle of a sphere, exactly, from near by and from afar.
TEST(ShapeLight, ASphereBringsItsFormFactor) {
    for (const double distance : {1.001, 1.5, 100.0, 1e5}) {
        const Light light = shape_light(ShapeKind::Sphere, Mat4f());
        const double expected = kPiInDouble * 4.0 / (distance * distance);
        const TTestResult result =
            t_test(irradiance_samples(light, {0.0f, static_cast<float>(-distance), 0.0f}, {0, 1, 0}, 20'000, 5),
                   expected, 1e-4 * expected);
        EXPECT_GT(result.p_value, 0.001) << distance << ": " << result.str();
    }
}

// Of a cone of directions that all count in full, each sample brings nearly the same.
TEST(ShapeLight, ASphereFromAfarHasHardlyAnyNoise) {
    const Light light = shape_light(ShapeKind::Sphere, Mat4f());
    const std::vector<double> samples = irradiance_samples(light, {0.0f, -100.0f, 0.0f}, {0, 1, 0}, 1000, 6);
    for (const double sample : samples) EXPECT_NEAR(sample, kPiInDouble * 4.0 * 1e-4, 1e-4 * kPiInDouble * 4.0 * 1e-4);
}

TEST(ShapeLight, ADiskBringsItsFormFactor) {
    // Its front towards -z, where the point is.
    const Light light = shape_light(ShapeKind::Disk, scaled_and_moved({1.5f, 1.5f, 1.0f}, {0.0f, 0.0f, 2.0f}));
    const double expected = kPiInDouble * 4.0 * 2.25 / (2.25 + 4.0);
    const TTestResult result =
        t_test(irradiance_samples(light, Vec3f(0.0f), {0, 0, 1}, 50'000, 2), expected, 1e-4 * expected);
    EXPECT_GT(result.p_value, 0.001) << result.str();
}

// Seen from far away, at right angles to its axis: its section over the squared distance.
TEST(ShapeLight, ACylinderBringsItsFormFactor) {
    const Light light = shape_light(ShapeKind::Cylinder, scaled_and_moved({0.5f, 2.0f, 0.5f}, {0.0f, 0.0f, 200.0f}));
    const double expected = 4.0 * (1.0 * 4.0) / (200.0 * 200.0);
    const TTestResult result =
        t_test(irradiance_samples(light, Vec3f(0.0f), {0, 0, 1}, 50'000, 2), expected, 3e-3 * expected);
    EXPECT_GT(result.p_value, 0.001) << result.str();
}

TEST(ShapeLight, PowerAndBoundsAreThoseOfItsSurface) {
    const ShapeLight sphere = shape_light(ShapeKind::Sphere, scaled_and_moved(Vec3f(0.5f), {1.0f, 2.0f, 3.0f}));
    EXPECT_NEAR(sphere.power(0.0f), kPi * kPi * 4.0f, 1e-4f);
    EXPECT_NEAR(sphere.bounds().box.min.y, 1.5f, 1e-4f);
    EXPECT_EQ(sphere.bounds().cone.theta_o, kPiInDouble);
    const ShapeLight disk = shape_light(ShapeKind::Disk, Mat4f(), true);
    EXPECT_NEAR(disk.power(0.0f), 2.0f * kPi * kPi * 4.0f, 1e-4f);
    EXPECT_EQ(disk.bounds().cone.theta_o, 0.0);
    EXPECT_EQ(disk.bounds().cone.axis, Vec3f(0.0f, 0.0f, -1.0f));
}

}  // namespace

}  // namespace etendue::test
