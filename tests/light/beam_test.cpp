#include "light/beam.h"

#include "light/light_checks.h"
#include "light/mesh_light.h"
#include "support/chi2.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

struct NamedBeam {
    std::string name;
    Beam beam;
};

std::vector<NamedBeam> beams() {
    return {{"diffuse", Beam()},
            {"wide panel", Beam::panel(3.0f)},
            {"panel", Beam::panel(1.5f)},
            {"narrow panel", Beam::panel(0.1f)},
            {"spot", Beam::spot(0.3f, 0.8f)},
            {"hard spot", Beam::spot(0.5f, 0.5f)},
            {"widest spot", Beam::spot(0.0f, 0.5f * kPi)}};
}

// By a midpoint rule in the angle, over the hemisphere.
TEST(Beam, MeanFactorIsThatOfThePower) {
    constexpr int kSteps = 200'000;
    for (const auto& [name, beam] : beams()) {
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const double theta = (i + 0.5) * 0.5 * std::numbers::pi / kSteps;
            const double cosine = std::cos(theta);
            sum += static_cast<double>(beam.factor(static_cast<float>(cosine))) * cosine * std::sin(theta);
        }
        const double mean = 2.0 * sum * 0.5 * std::numbers::pi / kSteps;
        EXPECT_NEAR(static_cast<double>(beam.mean_factor()) / mean, 1.0, 1e-3) << name;
    }
    EXPECT_EQ(Beam::panel(1.0f).mean_factor(), 1.0f) << "a panel keeps its power whatever its spread";
}

// D10594: slats hide more and more, and the power stays. Half of a right angle has a tangent of 1.
TEST(Beam, PanelFallsOffWithTheTangent) {
    const Beam panel = Beam::panel(0.5f * kPi);
    const double full = 1.0 / (1.0 - 0.25 * std::numbers::pi);
    for (const double angle : {0.0, 0.2, 0.5, 0.78})
        EXPECT_NEAR(static_cast<double>(panel.factor(static_cast<float>(std::cos(angle)))),
                    full * (1.0 - std::tan(angle)), 1e-5 * full)
            << angle;
    EXPECT_EQ(panel.factor(std::cos(0.79f)), 0.0f);
    EXPECT_TRUE(Beam::panel(kPi).is_diffuse());
}

TEST(Beam, SpotHasTheIntensityOfASpot) {
    const Beam beam = Beam::spot(0.3f, 0.8f);
    for (const float angle : {0.0f, 0.29f, 0.5f, 0.79f, 0.81f})
        EXPECT_NEAR(beam.factor(std::cos(angle)) * std::cos(angle),
                    spot_falloff(std::cos(angle), std::cos(0.3f), std::cos(0.8f)), 1e-6f)
            << angle;
}

// What leaves a mesh light with a beam has the density that the light states, and is where there is light.
TEST(Beam, EmissionHasTheStatedDensity) {
    const std::vector<NamedBeam> all = beams();
    for (const auto& [name, beam] : all) {
        const MeshLight light({{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}}, Rgb(1.0f), Rgb(1.0f), false, false, false,
                              Vec3f(0.0f), beam);
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> {
            const EmissionSample s = light.sample_emission({random.next_2d(), random.next_2d(), random.next_2d()}, {});
            EXPECT_NEAR(s.pdf_direction_solid_angle, light.emission_pdf(s.direction, s.cos_theta, {}),
                        1e-3f * s.pdf_direction_solid_angle);
            return s.direction;
        };
        const SamplerCheck check = check_sphere_sampler(
            sampler, [&](const Vec3f& w) { return static_cast<double>(light.emission_pdf(w, w.y, {})); },
            {.tolerance = 1e-5, .least_levels = 3});
        EXPECT_GT(check.chi2.p_value, sidak_level(kFamilyLevel, all.size())) << name << ": " << check.chi2.str();
        EXPECT_NEAR(check.pdf_integral, 1.0, 1e-2) << name;
        EXPECT_NEAR(static_cast<double>(light.power(1.0f)),
                    0.5 * std::numbers::pi * static_cast<double>(beam.mean_factor()), 1e-5);
        EXPECT_NEAR(light.bounds().cone.theta_e, static_cast<double>(beam.half_angle()), 1e-6) << name;
    }
}

}  // namespace

}  // namespace etendue::test
