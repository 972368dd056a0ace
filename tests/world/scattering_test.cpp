#include "world/scattering.h"

#include "bsdf/ggx.h"
#include "sampling/warp.h"
#include "world/test_scene.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

struct NamedLobe {
    std::string name;
    Bsdf bsdf;
};

std::vector<NamedLobe> lobes() {
    return {
        {"diffuse", Diffuse{Rgb(0.7f)}},
        {"plastic", MetallicRoughness{.base = {0.5f, 0.6f, 0.7f}, .metallic = 0.0f, .alpha_x = 0.3f, .alpha_y = 0.3f}},
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

bool same_side(const Surface& s, const Vec3f& w) {
    return dot(w, s.geometric_normal) * dot(w, s.frame.normal) > 0.0f;
}

TEST(Scattering, LeaksAreBlackFromBothEnds) {
    for (const auto& [name, bsdf] : lobes()) {
        SCOPED_TRACE(name);
        Random random(1);
        int leaks = 0;
        int kept = 0;
        for (int i = 0; i < 5000; ++i) {
            const Surface s = random_surface(random);
            const Vec3f a = random_direction(random);
            const Vec3f b = random_direction(random);
            const bool may_scatter = same_side(s, a) && same_side(s, b);
            for (const TransportMode mode : {TransportMode::Radiance, TransportMode::Importance}) {
                const bool forward =
                    !is_black(Scattering(bsdf, s.frame, s.geometric_normal, a).evaluate(b, mode).f_cos);
                const bool backward =
                    !is_black(Scattering(bsdf, s.frame, s.geometric_normal, b).evaluate(a, mode).f_cos);
                EXPECT_EQ(forward, backward);
                if (!may_scatter) {
                    EXPECT_FALSE(forward);
                    ++leaks;
                } else if (forward) {
                    ++kept;
                }
            }
            const BsdfSample sample = Scattering(bsdf, s.frame, s.geometric_normal, a)
                                          .sample(random.next(), random.next_2d(), TransportMode::Radiance);
            EXPECT_TRUE(is_black(sample.weight) || (same_side(s, a) && same_side(s, sample.wi)));
        }
        EXPECT_GT(leaks, 1000);
        EXPECT_GT(kept, 1000);
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
        for (int i = 0; i < 500; ++i) {
            const Surface surface = random_surface(random);
            const Vec3f wo = random_direction(random);
            const Vec3f wi = random_direction(random);
            const Scattering forward(lobe.bsdf, surface.frame, surface.geometric_normal, wo);
            const Scattering backward(lobe.bsdf, surface.frame, surface.geometric_normal, wi);
            const float expected = backward.evaluate(wo, TransportMode::Radiance).pdf_solid_angle;
            ASSERT_NEAR(forward.reverse_pdf_solid_angle(wi), expected, 1e-5f + 1e-3f * expected) << lobe.name;
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
            const float back = limit.reverse_pdf_solid_angle(sample.wi);
            EXPECT_NEAR(delta.reverse_density_ratio(sample) / (back / there), 1.0f, 0.02f) << cos_theta << ", " << u;
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
    EXPECT_NEAR(outside.reverse_density_ratio(in) * inside.reverse_density_ratio(out), 1.0f, 1e-4f);
}

}  // namespace

}  // namespace etendue::test
