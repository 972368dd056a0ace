#include "light/environment_light.h"

#include "light/light_checks.h"
#include "sampling/mis.h"
#include "sampling/warp.h"
#include "support/chi2.h"
#include "support/t_test.h"

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

ImageF image_of(int width, int height, const std::function<float(int, int)>& value) {
    ImageF image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto p = image.pixel(x, y);
            p[0] = value(x, y);
            p[1] = 0.5f * value(x, y);
            p[2] = 1.5f * value(x, y);
        }
    return image;
}

struct NamedEnvironment {
    std::string name;
    Light light;
};

std::vector<NamedEnvironment> environments() {
    std::vector<NamedEnvironment> list;
    list.push_back({"constant", ConstantEnvironment{Rgb(2.0f)}});
    list.push_back({"one texel", ImageEnvironment(image_of(1, 1, [](int, int) { return 2.0f; }), 0.3f)});
    list.push_back({"one colour", ImageEnvironment(image_of(24, 12, [](int, int) { return 0.7f; }), 0.0f)});
    list.push_back({"one column", ImageEnvironment(image_of(1, 5, [](int, int y) { return 1.0f + float(y); }), 0.0f)});
    list.push_back({"one row", ImageEnvironment(image_of(6, 1, [](int x, int) { return 1.0f + float(x); }), 0.0f)});
    list.push_back(
        {"gradient", ImageEnvironment(image_of(16, 8, [](int x, int y) { return float(x + 3 * y); }), 1.0f)});
    list.push_back(
        {"half black, turned", ImageEnvironment(image_of(8, 4, [](int x, int) { return x < 4 ? 0.0f : 1.0f; }), 2.5f)});
    list.push_back(
        {"one bright texel",
         ImageEnvironment(image_of(32, 16, [](int x, int y) { return x == 20 && y == 5 ? 1000.0f : 0.0f; }), -0.7f)});
    list.push_back(
        {"bright on dim",
         ImageEnvironment(image_of(32, 16, [](int x, int y) { return x == 0 && y == 2 ? 500.0f : 0.1f; }), 0.0f)});
    list.push_back(
        {"bright pole", ImageEnvironment(image_of(16, 8, [](int, int y) { return y == 0 ? 50.0f : 0.0f; }), 0.0f)});
    list.push_back({"black", ImageEnvironment(image_of(8, 4, [](int, int) { return 0.0f; }), 0.0f)});
    return list;
}

TEST(Environment, DirectionsHaveTheStatedDensity) {
    const std::vector<NamedEnvironment> list = environments();
    for (const NamedEnvironment& environment : list) {
        const std::string& name = environment.name;
        const Light& light = environment.light;
        SCOPED_TRACE(name);
        // The density jumps at the edges of texels. That of nine texels does so from nothing, of which the quadrature
        // misses two thousandths.
        const bool is_narrow = name == "one bright texel";
        const SamplerOptions options{.tolerance = is_narrow ? 3e-5 : 1e-5, .least_levels = is_narrow ? 3 : 2};
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> {
            const LightSample s = sample_light(light, Vec3f(0.0f), random.next_2d(), random.next_2d());
            if (!(s.pdf_solid_angle > 0.0f)) return std::nullopt;
            return s.wi;
        };
        const SamplerCheck check = check_sphere_sampler(
            sampler, [&](const Vec3f& w) { return static_cast<double>(pdf_solid_angle_from_afar(light, w)); }, options);
        EXPECT_GT(check.chi2.p_value, sidak_level(kFamilyLevel, list.size())) << check.chi2.str();
        EXPECT_NEAR(check.pdf_integral, 1.0, 5e-3);
    }
}

TEST(Environment, SamplesStateTheRadianceAndDensityOfTheirDirection) {
    for (const NamedEnvironment& environment : environments()) {
        const std::string& name = environment.name;
        const Light& light = environment.light;
        SCOPED_TRACE(name);
        Random random(2);
        int differing = 0;
        constexpr int kSamples = 2000;
        for (int i = 0; i < kSamples; ++i) {
            const LightSample s = sample_light(light, {1, 2, 3}, random.next_2d(), random.next_2d());
            if (!(s.pdf_solid_angle > 0.0f)) continue;
            EXPECT_NEAR(length(s.wi), 1.0f, 1e-5f);
            EXPECT_TRUE(std::isinf(s.distance));
            EXPECT_FALSE(s.is_delta);
            const Rgb radiance = radiance_from_afar(light, s.wi);
            const float pdf = pdf_solid_angle_from_afar(light, s.wi);
            EXPECT_NEAR(s.radiance.g, radiance.g, 2e-3f * (s.radiance.g + 1.0f));
            // The density jumps between texels; rounding may take a direction to the next one.
            if (std::abs(pdf / s.pdf_solid_angle - 1.0f) > 1e-2f) ++differing;
        }
        EXPECT_LT(differing, kSamples / 500);
    }
}

// The density must not vanish where there is light: what has no density is never found, without any noise to tell.
TEST(Environment, WhereThereIsLightThereIsDensity) {
    for (const NamedEnvironment& environment : environments()) {
        const std::string& name = environment.name;
        const Light& light = environment.light;
        SCOPED_TRACE(name);
        Random random(6);
        for (int i = 0; i < 20'000; ++i) {
            const float z = 2.0f * random.next() - 1.0f;
            const float phi = 2.0f * kPi * random.next();
            const float r = std::sqrt(1.0f - z * z);
            const Vec3f w(r * std::cos(phi), z, r * std::sin(phi));
            const bool lit = average(radiance_from_afar(light, w)) > 1e-5f;
            EXPECT_TRUE(!lit || pdf_solid_angle_from_afar(light, w) > 0.0f);
        }
    }
}

TEST(Environment, ConstantLightBringsPiTimesItsRadiance) {
    for (const Light& light : {Light(ConstantEnvironment{Rgb(2.0f)}),
                               Light(ImageEnvironment(ImageF(image_of(4, 2, [](int, int) { return 2.0f; })), 0.0f))}) {
        const TTestResult result =
            t_test(irradiance_samples(light, Vec3f(0.0f), normalize(Vec3f(1, 2, 3)), 50'000, 5), M_PI * 2.0, 1e-4);
        EXPECT_GT(result.p_value, 0.001) << result.str();
    }
}

TEST(Environment, LightSamplesIntegrateWhatLookUpsDo) {
    const Vec3f normal = normalize(Vec3f(0.3f, 1.0f, -0.2f));
    for (const NamedEnvironment& environment : environments()) {
        const std::string& name = environment.name;
        const Light& light = environment.light;
        SCOPED_TRACE(name);
        const double expected = integrate_directions(500, [&](const Vec3f& w) {
            return average(radiance_from_afar(light, w)) * std::max(0.0f, dot(w, normal));
        });
        const TTestResult result =
            t_test(irradiance_samples(light, Vec3f(0.0f), normal, 50'000, 7), expected, 2e-3 * expected);
        EXPECT_GT(result.p_value, 0.0005) << result.str() << ", expected " << expected;
    }
}

TEST(Environment, ManySamplesAtOnceAreTheSame) {
    for (const auto& [name, light] : environments()) {
        SCOPED_TRACE(name);
        Random random(37);
        std::vector<Vec2f> u(150);
        for (Vec2f& pair : u) pair = random.next_2d();
        std::vector<LightSample> samples(u.size());
        sample_environment_compensated(light, u, samples);
        for (std::size_t i = 0; i < u.size(); ++i) {
            const LightSample expected = sample_light_compensated(light, Vec3f(0.0f), {0.0f, 0.0f}, u[i]);
            // A compiler may contract products and sums here and not there.
            ASSERT_LT(length(samples[i].wi - expected.wi), 2e-6f);
            ASSERT_LE(max_component(samples[i].radiance - expected.radiance), 1e-5f * max_component(expected.radiance));
            ASSERT_LE(max_component(expected.radiance - samples[i].radiance), 1e-5f * max_component(expected.radiance));
            ASSERT_NEAR(samples[i].pdf_solid_angle, expected.pdf_solid_angle, 1e-5f * expected.pdf_solid_angle);
        }
    }
}

TEST(Environment, LookingAlongManyDirectionsAtOnceIsTheSame) {
    Random random(9);
    std::vector<Vec3f> directions{{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    while (directions.size() < 150) directions.push_back(square_to_sphere(random.next_2d()));
    for (const NamedEnvironment& environment : environments()) {
        std::vector<EnvironmentRadiance> seen(directions.size());
        look_at_environment(environment.light, directions, seen);
        for (std::size_t i = 0; i < directions.size(); ++i) {
            EXPECT_EQ(seen[i].radiance, radiance_from_afar(environment.light, directions[i])) << environment.name;
            EXPECT_EQ(seen[i].pdf_solid_angle, compensated_pdf_solid_angle_from_afar(environment.light, directions[i]))
                << environment.name;
        }
    }
}

// False-positive rate of the table: kFamilyLevel.
TEST(Environment, CompensatedDirectionsHaveTheStatedDensity) {
    std::vector<NamedEnvironment> list = environments();
    list.push_back(
        {"window",
         ImageEnvironment(
             image_of(32, 16, [](int x, int y) { return x > 7 && x < 19 && y > 3 && y < 10 ? 9.0f : 1.0f; }), 0.4f)});
    for (const NamedEnvironment& environment : list) {
        const Light& light = environment.light;
        // The quadrature of the check misses thousandths of a density that is not zero in nine texels only.
        if (environment.name == "one bright texel" || environment.name == "bright on dim") continue;
        if (!(compensated_power(light, 1.0f) > 0.0f)) continue;
        SCOPED_TRACE(environment.name);
        const SamplerOptions options{.tolerance = 1e-5, .least_levels = 2};
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> {
            const LightSample s = sample_light_compensated(light, Vec3f(0.0f), random.next_2d(), random.next_2d());
            if (!(s.pdf_solid_angle > 0.0f)) return std::nullopt;
            EXPECT_NEAR(compensated_pdf_solid_angle_from_afar(light, s.wi) / s.pdf_solid_angle, 1.0f, 0.01f);
            EXPECT_NEAR(s.radiance.g, radiance_from_afar(light, s.wi).g, 2e-3f * (s.radiance.g + 1.0f));
            return s.wi;
        };
        const SamplerCheck check = check_sphere_sampler(
            sampler,
            [&](const Vec3f& w) { return static_cast<double>(compensated_pdf_solid_angle_from_afar(light, w)); },
            options);
        EXPECT_GT(check.chi2.p_value, sidak_level(kFamilyLevel, list.size())) << check.chi2.str();
        EXPECT_NEAR(check.pdf_integral, 1.0, 5e-3);
    }
}

TEST(Environment, OnlyWhatIsBrighterThanTheMeanIsLeftByCompensation) {
    for (const NamedEnvironment& environment : environments()) {
        const std::string& name = environment.name;
        const Light& light = environment.light;
        SCOPED_TRACE(name);
        const auto radiance = [&](const Vec3f& w) { return average(radiance_from_afar(light, w)); };
        const double mean = integrate_directions(400, radiance) / (4.0 * M_PI);
        const double above = integrate_directions(
            400, [&](const Vec3f& w) { return std::max(0.0, static_cast<double>(radiance(w)) - mean); });
        // The density is constant over a cell, where the radiance is not.
        EXPECT_NEAR(compensated_power(light, 3.0f), above * M_PI * 9.0, 0.25 * above * M_PI * 9.0 + 1e-4 * mean);
        if (name == "constant" || name == "one texel" || name == "one colour" || name == "black") {
            EXPECT_EQ(compensated_power(light, 1.0f), 0.0f);
        }
        if (name == "bright on dim") {
            // Away from the lamp, whose light is in the mean, the sky needs none.
            EXPECT_EQ(compensated_pdf_solid_angle_from_afar(light, {0, -1, 0}), 0.0f);
            EXPECT_GT(pdf_solid_angle_from_afar(light, {0, -1, 0.01f}), 0.0f);
        }
    }
}

// Light samples with compensation and directions that are uniform over the sphere, by the power heuristic: what the one
// leaves out the other brings. False-positive rate of each: 0.0005.
TEST(Environment, CompensatedSamplesAndOthersBringAllLight) {
    const Vec3f normal = normalize(Vec3f(0.3f, 1.0f, -0.2f));
    for (const NamedEnvironment& environment : environments()) {
        const Light& light = environment.light;
        SCOPED_TRACE(environment.name);
        const double expected = integrate_directions(500, [&](const Vec3f& w) {
            return average(radiance_from_afar(light, w)) * std::max(0.0f, dot(w, normal));
        });
        constexpr float kUniform = 0.25f * kInvPi;
        Random random(11);
        std::vector<double> samples(200'000);
        for (double& value : samples) {
            const LightSample s = sample_light_compensated(light, Vec3f(0.0f), random.next_2d(), random.next_2d());
            if (s.pdf_solid_angle > 0.0f)
                value += static_cast<double>(average(s.radiance) * std::max(0.0f, dot(s.wi, normal)) *
                                             power_heuristic(s.pdf_solid_angle, kUniform) / s.pdf_solid_angle);
            const Vec3f w = square_to_sphere(random.next_2d());
            const float weight = power_heuristic(kUniform, compensated_pdf_solid_angle_from_afar(light, w));
            value += static_cast<double>(average(radiance_from_afar(light, w)) * std::max(0.0f, dot(w, normal)) *
                                         weight / kUniform);
        }
        const TTestResult result = t_test(samples, expected, 2e-3 * expected);
        EXPECT_GT(result.p_value, 0.0005) << result.str() << ", expected " << expected;
    }
}

TEST(Environment, PowerIsRadianceThroughADiskOverAllDirections) {
    for (const NamedEnvironment& environment : environments()) {
        const std::string& name = environment.name;
        const Light& light = environment.light;
        const float radius = 3.0f;
        const double numerical =
            integrate_directions(400, [&](const Vec3f& w) { return average(radiance_from_afar(light, w)); }) * M_PI *
            9.0;
        // The power takes the mean of each row times the sine at its middle. At a pole the sine rises from nothing
        // while the light falls, so the two do not separate; the choice between lights bears that.
        const double tolerance = name == "bright pole" ? 0.2 : 0.02;
        EXPECT_NEAR(light_power(light, radius), numerical, tolerance * numerical + 1e-6) << name;
    }
}

/// Radiance of an image whose texel (x, y) is the only one with light.
float seen(int x, int y, float rotation, const Vec3f& direction) {
    const ImageEnvironment light(image_of(8, 4, [=](int i, int j) { return i == x && j == y ? 1.0f : 0.0f; }),
                                 rotation);
    return light.radiance(normalize(direction)).r;
}

TEST(ImageEnvironment, TheMiddleLiesTowardsMinusZAndTheRightHalfTowardsX) {
    // Columns 3 and 4 meet in the middle of the image; rows 1 and 2 at the horizon.
    EXPECT_NEAR(seen(3, 1, 0.0f, {0, 0, -1}), 0.25f, 1e-3f);
    EXPECT_NEAR(seen(4, 2, 0.0f, {0, 0, -1}), 0.25f, 1e-3f);
    // Centre of column 5: azimuth 3/16 of a turn towards +X.
    const float azimuth = 2.0f * kPi * (5.5f / 8.0f - 0.5f);
    const float polar = kPi * 1.5f / 4.0f;
    const Vec3f center(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth));
    EXPECT_NEAR(seen(5, 1, 0.0f, center), 1.0f, 1e-3f);
    EXPECT_NEAR(seen(2, 1, 0.0f, {-center.x, center.y, center.z}), 1.0f, 1e-3f);
    EXPECT_NEAR(seen(5, 2, 0.0f, {center.x, -center.y, center.z}), 1.0f, 1e-3f);
    // The image closes behind the viewer: half of column 0 and half of column 7.
    EXPECT_NEAR(seen(0, 1, 0.0f, {0, std::cos(polar), std::sin(polar)}), 0.5f, 1e-3f);
    EXPECT_NEAR(seen(7, 1, 0.0f, {0, std::cos(polar), std::sin(polar)}), 0.5f, 1e-3f);
    // The top row is up.
    EXPECT_NEAR(seen(0, 0, 0.0f, {0, 1, 0}) + seen(1, 0, 0.0f, {0, 1, 0}),
                seen(0, 3, 0.0f, {0, -1, 0}) + seen(1, 3, 0.0f, {0, -1, 0}), 1e-3f);
}

TEST(ImageEnvironment, RotationTurnsCounterClockwiseSeenFromAbove) {
    const float polar = kPi * 1.5f / 4.0f;
    const auto direction = [&](float azimuth) {
        return Vec3f(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth));
    };
    const float center = 2.0f * kPi * (5.5f / 8.0f - 0.5f);
    // From -Z towards -X is counter-clockwise seen from +Y; azimuths above count towards +X.
    for (const float rotation : {0.4f, kPi / 2.0f, -2.0f, 7.0f})
        EXPECT_NEAR(seen(5, 1, rotation, direction(center - rotation)), 1.0f, 2e-3f) << rotation;
}

TEST(ImageEnvironment, NegativeAndNonFiniteTexelsCountAsBlack) {
    const float bad[] = {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1.0f};
    const Light light = ImageEnvironment(image_of(4, 2, [&](int x, int) { return bad[x]; }), 0.0f);
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const LightSample s = sample_light(light, Vec3f(0.0f), random.next_2d(), random.next_2d());
        EXPECT_TRUE(is_finite(s.radiance));
        EXPECT_GE(min_component(s.radiance), 0.0f);
        EXPECT_TRUE(std::isfinite(s.pdf_solid_angle));
    }
    EXPECT_TRUE(std::isfinite(light_power(light, 1.0f)));
}

// Near the poles 1 - y² has lost all digits; both ways to the density must still agree.
TEST(Environment, PolesHaveTheDensityOfTheirSamples) {
    const Light light = ImageEnvironment(image_of(4096, 2048, [](int, int y) { return y == 0 ? 1e6f : 1e-3f; }), 0.3f);
    Random random(9);
    for (int i = 0; i < 1000; ++i) {
        const LightSample s = sample_light(light, Vec3f(0.0f), random.next_2d(), random.next_2d());
        ASSERT_GT(s.pdf_solid_angle, 0.0f);
        EXPECT_NEAR(pdf_solid_angle_from_afar(light, s.wi) / s.pdf_solid_angle, 1.0f, 0.01f) << s.wi;
    }
}

}  // namespace

}  // namespace etendue::test
