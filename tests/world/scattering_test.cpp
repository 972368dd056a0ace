#include "world/scattering.h"

#include "bsdf/ggx.h"
#include "sampling/sobol.h"
#include "sampling/warp.h"
#include "support/chi2.h"
#include "support/z_test.h"
#include "world/test_scene.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

struct NamedLobe {
    std::string name;
    Bsdf bsdf;
};

constexpr MetallicRoughness kPlastic{.base = {0.5f, 0.6f, 0.7f}, .metallic = 0.0f, .alpha_x = 0.3f, .alpha_y = 0.3f};

/// Returns a coat whose normal leans by `degrees`, against what the tests' surfaces lean by.
ClearCoat leaning_coat(float alpha, float degrees) {
    const float angle = degrees * kPi / 180.0f;
    return {1.0f, alpha, {-std::sin(angle), 0.0f, std::cos(angle)}};
}

std::vector<NamedLobe> lobes() {
    return {{"diffuse", Diffuse{Rgb(0.7f)}},
            {"plastic", kPlastic},
            {"coat that leans", LayeredSurface::make(kPlastic, {}, leaning_coat(0.3f, 25.0f))},
            {"coat that leans over sheen",
             LayeredSurface::make(kPlastic, Sheen{Rgb(0.5f), 0.4f}, leaning_coat(0.4f, 15.0f))},
            {"thin transmission",
             MetallicRoughness{
                 .base = Rgb(0.9f), .metallic = 0.2f, .alpha_x = 0.4f, .alpha_y = 0.4f, .transmission = 0.8f}},
            {"rough conductor", RoughConductor{{}, 0.4f}},
            {"rough dielectric", RoughDielectric::make(1.5f, 0.4f)}};
}

/// A surface whose shading normal leans away from its geometric one.
struct Surface {
    Vec3f geometric_normal;
    Frame frame;
};

Surface random_surface(Random& random) {
    const Vec3f n = random_direction(random);
    const Vec3f leaning = normalize(n + random_direction(random) * 0.7f);
    return {n, Frame::from_normal(leaning)};
}

TEST(Scattering, NothingPassesWhatOnlyReflects) {
    for (const auto& [name, bsdf] : lobes()) {
        if (!only_reflects(bsdf)) continue;
        SCOPED_TRACE(name);
        Random random(1);
        int across = 0;
        int scattered = 0;
        for (int i = 0; i < 5000; ++i) {
            const Surface s = random_surface(random);
            const Vec3f a = random_direction(random);
            const Vec3f b = random_direction(random);
            const auto is_reflection = [&](const Vec3f& w) {
                return dot(a, s.geometric_normal) * dot(w, s.geometric_normal) > 0.0f;
            };
            for (const TransportMode mode : {TransportMode::Radiance, TransportMode::Importance}) {
                const Scattering scattering(bsdf, s.frame, s.geometric_normal, a);
                if (!is_reflection(b)) {
                    EXPECT_TRUE(is_black(scattering.evaluate(b, mode).f_cos));
                    ++across;
                }
                const BsdfSample sample = scattering.sample(random.next(), random.next_2d(), mode);
                if (is_black(sample.weight)) continue;
                EXPECT_TRUE(is_reflection(sample.wi));
                ++scattered;
            }
        }
        EXPECT_GT(across, 1000);
        EXPECT_GT(scattered, 1000);
    }
}

// A path through the surface carries the same whichever end it is traced from. With f the BSDF and the geometry terms'
// cosines to n_g, its vertex contributes f(L -> E) |L.n_s| |E.n_g| (Veach 1997, section 5.3.2). The eye walk has
// f |L.n_s| and the next edge |E.n_g|; the light walk has its own weight and the edge before it |L.n_g|.
TEST(Scattering, EyeAndLightWalksCarryTheSameThroughShadingNormals) {
    for (const auto& [name, bsdf] : lobes()) {
        SCOPED_TRACE(name);
        Random random(2);
        int compared = 0;
        for (int i = 0; i < 5000; ++i) {
            const Surface s = random_surface(random);
            const Vec3f eye = random_direction(random);
            const Vec3f light = random_direction(random);
            // Grazing directions amplify rounding.
            if (abs_dot(eye, s.frame.normal) < 0.05f || abs_dot(light, s.frame.normal) < 0.05f) continue;
            const Rgb from_eye =
                Scattering(bsdf, s.frame, s.geometric_normal, eye).evaluate(light, TransportMode::Radiance).f_cos *
                abs_dot(eye, s.geometric_normal);
            const Rgb from_light =
                Scattering(bsdf, s.frame, s.geometric_normal, light).evaluate(eye, TransportMode::Importance).f_cos *
                abs_dot(light, s.geometric_normal);
            if (is_black(from_eye) && is_black(from_light)) continue;
            ++compared;
            const float scale = max_component(from_eye) + max_component(from_light);
            EXPECT_NEAR(from_eye.r, from_light.r, 2e-3f * scale);
            EXPECT_NEAR(from_eye.b, from_light.b, 2e-3f * scale);
        }
        EXPECT_GT(compared, 500);
    }
}

TEST(Scattering, SampledWeightsAreWhatEvaluateSays) {
    for (const auto& [name, bsdf] : lobes()) {
        SCOPED_TRACE(name);
        Random random(3);
        int compared = 0;
        for (int i = 0; i < 5000; ++i) {
            const Surface s = random_surface(random);
            const Scattering scattering(bsdf, s.frame, s.geometric_normal, random_direction(random));
            for (const TransportMode mode : {TransportMode::Radiance, TransportMode::Importance}) {
                const BsdfSample sample = scattering.sample(random.next(), random.next_2d(), mode);
                if (is_black(sample.weight) || sample.is_delta) continue;
                if (abs_dot(sample.wi, s.frame.normal) < 0.02f) continue;
                const BsdfValue value = scattering.evaluate(sample.wi, mode);
                ++compared;
                EXPECT_NEAR(value.pdf_solid_angle / sample.pdf_solid_angle, 1.0f, 2e-2f);
                EXPECT_NEAR(value.f_cos.g / value.pdf_solid_angle / sample.weight.g, 1.0f, 2e-2f);
            }
        }
        EXPECT_GT(compared, 2000);
    }
}

TEST(Scattering, FramesStayRightHandedWhenTheyAreTurned) {
    const Bsdf bsdf = Diffuse{Rgb(0.5f)};
    const Frame frame = Frame::from_normal(normalize(Vec3f(0.3f, -0.5f, 0.8f)));
    for (const float side : {1.0f, -1.0f}) {
        const Scattering scattering(bsdf, frame, frame.normal, frame.normal * side);
        EXPECT_GT(scattering.wo_local().z, 0.99f);
        EXPECT_NEAR(dot(scattering.geometric_normal(), frame.normal), side, 1e-6f);
        // The cosine-weighted lobe maps the same numbers to the same local directions.
        Vec3f world[3];
        Vec3f local[3];
        const Vec2f numbers[3] = {{0.1f, 0.4f}, {0.8f, 0.3f}, {0.5f, 0.9f}};
        for (int i = 0; i < 3; ++i) {
            world[i] = scattering.sample(0.5f, numbers[i], TransportMode::Radiance).wi;
            local[i] = sample_bsdf(bsdf, {0, 0, 1}, 0.5f, numbers[i], TransportMode::Radiance).wi;
            EXPECT_GT(dot(world[i], frame.normal) * side, 0.0f);
        }
        EXPECT_NEAR(dot(cross(world[0], world[1]), world[2]), dot(cross(local[0], local[1]), local[2]), 1e-5f);
    }
}

TEST(Scattering, InterfacesKnowTheirSides) {
    const Bsdf glass = SmoothDielectric{1.5f};
    const Frame frame;
    // Straight through, from outside and from inside: eta is the index on wi's side over that on wo's.
    for (const float side : {1.0f, -1.0f}) {
        const Scattering scattering(glass, frame, frame.normal, {0, 0, side});
        const BsdfSample sample = scattering.sample(0.999f, {0.5f, 0.5f}, TransportMode::Radiance);
        ASSERT_TRUE(sample.is_transmission);
        EXPECT_NEAR(sample.wi.z, -side, 1e-6f);
        EXPECT_NEAR(sample.eta, side > 0.0f ? 1.5f : 1.0f / 1.5f, 1e-6f);
    }
}

// What a walk from the other end would do at a surface, told from this one.
TEST(Scattering, ReverseDensitiesAreThoseOfTheOtherWalk) {
    Random random(5);
    for (const NamedLobe& lobe : lobes())
        for (int i = 0; i < 1000; ++i) {
            const Surface surface = random_surface(random);
            const Vec3f wo = random_direction(random);
            const Vec3f wi = random_direction(random);
            const Scattering forward(lobe.bsdf, surface.frame, surface.geometric_normal, wo);
            const Scattering backward(lobe.bsdf, surface.frame, surface.geometric_normal, wi);
            for (const auto& [here, other] : {std::pair(TransportMode::Radiance, TransportMode::Importance),
                                              std::pair(TransportMode::Importance, TransportMode::Radiance)}) {
                if (is_black(forward.evaluate(wi, here).f_cos)) continue;
                const float expected = backward.evaluate(wo, other).pdf_solid_angle;
                ASSERT_NEAR(forward.reverse_pdf_solid_angle(wi, here), expected, 1e-5f + 1e-3f * expected) << lobe.name;
            }
        }
}

/// Lobes that lose nothing.
std::vector<NamedLobe> white_lobes() {
    const auto gltf = [](float metallic, float alpha) {
        return MetallicRoughness{.base = Rgb(1.0f), .metallic = metallic, .alpha_x = alpha, .alpha_y = alpha};
    };
    return {
        {"diffuse", Diffuse{Rgb(1.0f)}},
        {"rough diffuse", RoughDiffuse{Rgb(1.0f), 0.8f}},
        {"plastic", gltf(0.0f, 0.2f)},
        {"rough plastic", gltf(0.0f, 1.0f)},
        {"dense plastic",
         MetallicRoughness{.base = Rgb(1.0f), .metallic = 0.0f, .alpha_x = 0.2f, .alpha_y = 0.2f, .f0 = Rgb(0.17f)}},
        {"dense rough plastic", MetallicRoughness{.base = Rgb(1.0f), .metallic = 0.0f, .f0 = Rgb(0.17f)}},
        {"metal", gltf(1.0f, 0.1f)},
        {"rough metal", gltf(1.0f, 0.7f)},
        {"mirror", gltf(1.0f, 0.0f)},
        {"glossy sheet", MetallicRoughness{.base = Rgb(1.0f),
                                           .metallic = 0.0f,
                                           .alpha_x = 0.3f,
                                           .alpha_y = 0.3f,
                                           .transmission = 0.5f,
                                           .diffuse_transmission = 0.5f}},
        {"glass", SmoothDielectric{1.5f}},
        {"rough glass", RoughDielectric::make(1.5f, 0.3f)}};
}

/// Lobes that lose nothing under coats that lean by `coat` degrees on a surface that leans by `lean`.
std::vector<NamedLobe> white_lobes_under_coats(float lean, float coat) {
    const float angle = lean * kPi / 180.0f;
    const auto coated = [&](float metallic, float base_alpha, float coat_alpha) {
        return LayeredSurface::make(
            MetallicRoughness{.base = Rgb(1.0f), .metallic = metallic, .alpha_x = base_alpha, .alpha_y = base_alpha},
            {}, leaning_coat(coat_alpha, lean - coat), {-std::sin(angle), 0.0f, std::cos(angle)});
    };
    return {{"varnish", coated(0.0f, 0.3f, 0.0f)},
            {"coat", coated(0.0f, 0.3f, 0.2f)},
            {"varnish over rough plastic", coated(0.0f, 1.0f, 0.0f)},
            {"varnish over metal", coated(1.0f, 0.4f, 0.0f)}};
}

/// Mean weight of samples, undone of what refraction does to radiance.
double albedo_for_eye(const Bsdf& bsdf, const Frame& frame, const Vec3f& wo, std::uint32_t count) {
    const Vec3f geometric_normal(0.0f, 0.0f, 1.0f);
    const Scattering scattering(bsdf, frame, geometric_normal, wo);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const BsdfSample s = scattering.sample(owen_sobol_2d(i, 1).x, owen_sobol_2d(i, 2), TransportMode::Radiance);
        const bool is_glass =
            std::holds_alternative<SmoothDielectric>(bsdf) || std::holds_alternative<RoughDielectric>(bsdf);
        const float eta = is_glass && s.is_transmission ? s.eta : 1.0f;
        sum += static_cast<double>(s.weight.g * eta * eta);
    }
    return sum / count;
}

// The eye finds all of what arrives on a white surface, whichever way its normal leans and from wherever it looks.
TEST(Scattering, LeaningNormalsLoseNothing) {
    for (const NamedLobe& lobe : white_lobes())
        for (const float lean : {0.0f, 10.0f, 30.0f, 50.0f, 70.0f, 85.0f})
            for (const float view : {0.0f, 20.0f, 40.0f, 60.0f, 80.0f})
                for (const float azimuth : {0.0f, 60.0f, 120.0f, 180.0f}) {
                    const auto radians = [](float degrees) { return degrees * kPi / 180.0f; };
                    const Vec3f normal(std::sin(radians(lean)), 0.0f, std::cos(radians(lean)));
                    const Vec3f wo(std::sin(radians(view)) * std::cos(radians(azimuth)),
                                   std::sin(radians(view)) * std::sin(radians(azimuth)), std::cos(radians(view)));
                    const double albedo = albedo_for_eye(lobe.bsdf, Frame::from_normal(normal), wo, 4096);
                    EXPECT_GE(albedo, 0.95) << lobe.name << ", lean " << lean << ", view " << view << ", " << azimuth;
                    EXPECT_LE(albedo, 1.005) << lobe.name << ", lean " << lean << ", view " << view << ", " << azimuth;
                }
}

// Light on white surfaces under coats whose normals are others comes back, but for what metals keep: their mirror image
// may have to leave where the coat reflects more.
TEST(Scattering, CoatsThatLeanLoseLittle) {
    const auto radians = [](float degrees) { return degrees * kPi / 180.0f; };
    for (const float lean : {0.0f, 30.0f, 60.0f})
        for (const float coat : {0.0f, 25.0f, -40.0f})
            for (const NamedLobe& lobe : white_lobes_under_coats(lean, coat))
                for (const float view : {0.0f, 40.0f, 70.0f})
                    for (const float azimuth : {0.0f, 90.0f, 180.0f}) {
                        const Vec3f normal(std::sin(radians(lean)), 0.0f, std::cos(radians(lean)));
                        const Vec3f wo(std::sin(radians(view)) * std::cos(radians(azimuth)),
                                       std::sin(radians(view)) * std::sin(radians(azimuth)), std::cos(radians(view)));
                        const double albedo = albedo_for_eye(lobe.bsdf, Frame::from_normal(normal), wo, 1024);
                        const std::string which =
                            fmt::format("{}, lean {}, coat {}, view {}, {}", lobe.name, lean, coat, view, azimuth);
                        const double least = std::abs(lean - coat) < 90.0f ? 0.95 : 0.93;
                        EXPECT_GE(albedo, lobe.name.ends_with("metal") ? 0.8 : least) << which;
                        EXPECT_LE(albedo, 1.01) << which;
                    }
}

// A flat varnish reflects as a flat surface does, however steep the relief below it is.
TEST(Scattering, ReliefBelowAFlatVarnishDoesNotBendItsReflection) {
    const MetallicRoughness black{.base = Rgb(0.0f), .metallic = 0.0f, .f0 = Rgb(0.0f), .f90 = 0.0f};
    for (const float lean : {0.0f, 15.0f, 45.0f, 75.0f})
        for (const float alpha : {0.0f, 0.1f})
            for (const float side : {1.0f, -1.0f}) {
                const float angle = lean * kPi / 180.0f;
                const Frame frame = Frame::from_normal({std::sin(angle), 0.0f, std::cos(angle)});
                const Bsdf bsdf = LayeredSurface::make(black, {}, {1.0f, alpha, frame.to_local({0.0f, 0.0f, 1.0f})},
                                                       frame.to_local({0.0f, 0.0f, 1.0f}));
                const Vec3f wo = normalize(Vec3f(side * 0.9f, 0.1f, 0.3f));
                const Vec3f wi = mirror_direction(wo);
                const Vec3f geometric_normal(0.0f, 0.0f, 1.0f);
                const Scattering scattering(bsdf, frame, geometric_normal, wo);
                const std::string which = fmt::format("lean {}, alpha {}, side {}", lean, alpha, side);
                if (alpha == 0.0f) {
                    const DeltaList deltas = scattering.deltas();
                    ASSERT_EQ(deltas.end() - deltas.begin(), 1) << which;
                    EXPECT_LT(length(deltas.begin()->wi - wi), 1e-5f) << which;
                    EXPECT_NEAR(deltas.begin()->weight.g, 0.04f + 0.96f * std::pow(1.0f - wo.z, 5.0f), 1e-4f) << which;
                } else {
                    const Bsdf flat = ClearCoat{1.0f, alpha};
                    const Scattering expected(flat, Frame::from_normal(geometric_normal), geometric_normal, wo);
                    for (const TransportMode mode : {TransportMode::Radiance, TransportMode::Importance}) {
                        const float value = expected.evaluate(wi, mode).f_cos.g;
                        EXPECT_NEAR(scattering.evaluate(wi, mode).f_cos.g, value, 1e-3f * value) << which;
                    }
                }
            }
}

// What all pairs of an eye and a light exchange is the same, whichever end walks: samples of either, deltas included,
// estimate one integral, with a weight for each end that varies over its directions. A false alarm in 100 runs of all.
TEST(Scattering, WalksFromBothEndsExchangeTheSame) {
    std::vector<NamedLobe> all = white_lobes();
    all.push_back({"coated", LayeredSurface::make(MetallicRoughness{.metallic = 0.0f}, {}, ClearCoat{1.0f, 0.0f})});
    all.push_back({"under a varnish that leans", LayeredSurface::make(kPlastic, {}, leaning_coat(0.0f, 30.0f))});
    const std::array leans{5.0f, 30.0f, 60.0f};
    const double level = sidak_level(kFamilyLevel, all.size() * leans.size());
    const auto of_eye = [](const Vec3f& w) { return 1.0f + 0.8f * w.x + 0.5f * w.y * w.z; };
    const auto of_light = [](const Vec3f& w) { return 1.0f - 0.7f * w.x * w.z + 0.6f * w.y; };
    const Vec3f geometric_normal(0.0f, 0.0f, 1.0f);
    Random random(29);
    for (const NamedLobe& lobe : all)
        for (const float lean : leans) {
            const float angle = lean * kPi / 180.0f;
            const Frame frame = Frame::from_normal({std::sin(angle), 0.0f, std::cos(angle)});
            const auto exchange = [&](TransportMode mode) {
                const bool is_eye = mode == TransportMode::Radiance;
                double sum = 0.0, squares = 0.0;
                constexpr int kCount = 80'000;
                for (int i = 0; i < kCount; ++i) {
                    const Vec3f wo = random_direction(random);
                    const BsdfSample s = Scattering(lobe.bsdf, frame, geometric_normal, wo)
                                             .sample(random.next(), random.next_2d(), mode);
                    const auto value = static_cast<double>(
                        is_black(s.weight) ? 0.0f
                                           : s.weight.g * std::abs(wo.z) *
                                                 (is_eye ? of_eye(wo) * of_light(s.wi) : of_light(wo) * of_eye(s.wi)));
                    sum += value;
                    squares += value * value;
                }
                const double mean = sum / kCount;
                return Estimate{mean, (squares / kCount - mean * mean) / kCount};
            };
            const ZTestResult test = z_test(exchange(TransportMode::Radiance), exchange(TransportMode::Importance));
            EXPECT_GE(test.p_value, level) << lobe.name << ", lean " << lean << ": " << test.str();
        }
}

// Directions follow the density that is stated for them, of both walks: of an eye below the shading horizon, and of a
// light that is so low that its mirror image in the surface lies above that horizon, too.
TEST(Scattering, SamplesOnLeaningNormalsFollowTheirDensity) {
    const std::vector<NamedLobe> all = lobes();
    const std::array walks{std::pair(TransportMode::Radiance, normalize(Vec3f(-0.9f, 0.1f, 0.3f))),
                           std::pair(TransportMode::Importance, normalize(Vec3f(0.9f, 0.1f, 0.2f)))};
    const double level = sidak_level(kFamilyLevel, all.size() * walks.size());
    const Frame frame = Frame::from_normal(normalize(Vec3f(0.6f, 0.1f, 0.8f)));
    for (const NamedLobe& lobe : all)
        for (const auto& [mode, wo] : walks) {
            const Scattering scattering(lobe.bsdf, frame, {0.0f, 0.0f, 1.0f}, wo);
            const SamplerCheck check = check_sphere_sampler(
                [&, walk = mode](Random& random) -> std::optional<Vec3f> {
                    const float u_lobe = random.next();
                    const BsdfSample s = scattering.sample(u_lobe, random.next_2d(), walk);
                    return is_black(s.weight) ? std::nullopt : std::optional(s.wi);
                },
                [&, walk = mode](const Vec3f& w) {
                    const BsdfValue value = scattering.evaluate(w, walk);
                    return is_black(value.f_cos) ? 0.0 : static_cast<double>(value.pdf_solid_angle);
                },
                {.samples = 20'000, .tolerance = 1e-5, .least_levels = 1});
            EXPECT_GE(check.chi2.p_value, level) << lobe.name << ": " << check.chi2.str();
            EXPECT_GT(check.hit_share, 0.3) << lobe.name;
        }
}

// The ratio at a delta is what that of a rough surface's densities tends to, where its facets all but lie flat.
TEST(Scattering, TheWayBackThroughADeltaIsTheLimitOfRoughness) {
    const Frame frame = Frame::from_normal({0.0f, 0.0f, 1.0f});
    const Bsdf smooth = SmoothDielectric{1.5f};
    const Bsdf rough = RoughDielectric::make(1.5f, kSmoothAlpha);
    for (const float cos_theta : {0.95f, 0.5f, 0.2f, -0.95f, -0.8f}) {
        const Vec3f wo{std::sqrt(1.0f - cos_theta * cos_theta), 0.0f, cos_theta};
        const Scattering delta(smooth, frame, frame.normal, wo);
        for (const float u : {0.0f, kOneMinusEpsilon}) {
            const BsdfSample sample = delta.sample(u, {0.5f, 0.5f}, TransportMode::Radiance);
            ASSERT_TRUE(sample.is_delta && sample.is_transmission == (u > 0.0f));
            const Scattering limit(rough, frame, frame.normal, wo);
            const float there = limit.evaluate(sample.wi, TransportMode::Radiance).pdf_solid_angle;
            const float back = limit.reverse_pdf_solid_angle(sample.wi, TransportMode::Radiance);
            EXPECT_NEAR(sample.reverse_ratio / (back / there), 1.0f, 0.02f) << cos_theta << ", " << u;
        }
    }
}

// A coat lets light in with another chance than the one with which it lets it out.
TEST(Scattering, TheWayBackThroughACoatHasTheChancesOfBothEnds) {
    const Frame frame = Frame::from_normal({0.0f, 0.0f, 1.0f});
    const Bsdf coated =
        LayeredSurface::make(DielectricBody{SmoothDielectric{1.5f}, {}, 1.0f}, {}, ClearCoat{1.0f, 0.0f});
    const Vec3f wo{0.8f, 0.0f, 0.6f};
    const Scattering outside(coated, frame, frame.normal, wo);
    const BsdfSample in = outside.sample(kOneMinusEpsilon, {0.5f, 0.5f}, TransportMode::Importance);
    ASSERT_TRUE(in.is_delta && in.is_transmission);
    const Scattering inside(coated, frame, frame.normal, in.wi);
    const BsdfSample out = inside.sample(kOneMinusEpsilon, {0.0f, 0.5f}, TransportMode::Importance);
    ASSERT_TRUE(out.is_delta && out.is_transmission);
    EXPECT_NEAR(in.reverse_ratio * out.reverse_ratio, 1.0f, 1e-4f);
}

}  // namespace

}  // namespace etendue::test
