#include "light/light_aim.h"

#include "core/frame.h"
#include "core/wide.h"
#include "light/punctual_light.h"
#include "sampling/warp.h"
#include "support/chi2.h"
#include "support/random.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

// One far away, one that overlaps it, one near by, and one that is below the horizon of a surface that faces +y.
std::vector<AimSphere> some_spheres() {
    return {{{1.0f, 3.0f, 0.5f}, 0.4f},
            {{1.4f, 3.0f, 0.5f}, 0.5f},
            {{-0.6f, 0.2f, 0.3f}, 0.05f},
            {{0.0f, -2.0f, 0.0f}, 0.3f}};
}

struct NamedCone {
    std::string name;
    LightCone<float> cone;
};

std::vector<NamedCone> cones() {
    return {{"surface", {{0.0f, 1.0f, 0.0f}, 0.0f}},
            {"point", {{0.0f, 1.0f, 0.0f}, -1.0f}},
            {"spot", {normalize({1.0f, 1.0f, 0.0f}), 0.6f}}};
}

/// Returns the density with which lights of such a cone pick directions themselves, evenly.
float even_density(const LightCone<float>& cone, const Vec3f& direction) {
    return emission_in_cone_pdf_solid_angle(direction, cone.axis, cone.cos_half);
}

TEST(LightAim, PicksDirectionsWithTheStatedDensity) {
    const LightAim aim(some_spheres());
    for (const auto& [name, cone] : cones()) {
        const Vec3f point{0.1f, 0.0f, 0.05f};
        const auto sampler = [&, cone = cone](Random& random) -> std::optional<Vec3f> {
            Vec2f u = random.next_2d();
            if (auto aimed = aim.aim(point, cone, u)) return aimed;
            return sample_emission_in_cone(point, cone.axis, cone.cos_half, u).direction;
        };
        const auto density = [&, cone = cone](const Vec3f& w) {
            return static_cast<double>(aim.pdf_solid_angle(point, cone, w, even_density(cone, w)));
        };
        const SamplerCheck check = check_sphere_sampler(sampler, density, {.tolerance = 1e-5, .least_levels = 4});
        EXPECT_GE(check.chi2.p_value, sidak_level(kFamilyLevel, cones().size())) << name << ": " << check.chi2.str();
    }
}

TEST(LightAim, PicksPlacesAcrossADirectionWithTheStatedDensity) {
    constexpr float kRadius = 4.0f;
    const SceneSphere scene{{0.0f, 1.0f, 0.0f}, kRadius};
    const LightAim aim(some_spheres());
    const Vec3f direction = normalize({0.3f, -1.0f, 0.2f});
    const float own = emission_from_afar_pdf_area(scene);
    const Frame frame = Frame::from_normal(direction);
    const auto sampler = [&](Random& random) -> std::optional<Point> {
        Vec2f u = random.next_2d();
        const auto aimed = aim.aim_from_afar(direction, own, u);
        const Vec3f place = aimed ? *aimed : sample_emission_from_afar(direction, scene, u).position;
        const Vec3f local = frame.to_local(place - scene.center);
        return Point{static_cast<double>(local.x), static_cast<double>(local.y)};
    };
    const auto density_at = [&](float x, float y) {
        return aim.pdf_area(scene.center + frame.tangent * x + frame.bitangent * y, direction, own);
    };
    // Beside the light's own disk, none of its samples fall.
    const float of_own = density_at(10.0f * kRadius, 0.0f);
    const auto density = [&](double x, double y) {
        const float found = density_at(static_cast<float>(x), static_cast<float>(y));
        return static_cast<double>(std::hypot(x, y) <= static_cast<double>(kRadius) ? found : found - of_own);
    };
    constexpr double kSide = kRadius;
    const SamplerCheck check =
        check_rect_sampler({-kSide, kSide, -kSide, kSide}, sampler, density, {.tolerance = 1e-5, .least_levels = 4});
    EXPECT_GE(check.chi2.p_value, kFamilyLevel) << check.chi2.str();
}

TEST(LightAim, SeesManySpheresAsFew) {
    Random random(3);
    std::vector<AimSphere> spheres(1000);
    for (AimSphere& sphere : spheres)
        sphere = {{random.next_2d().x * 10.0f, random.next_2d().x, random.next_2d().x * 5.0f}, 0.01f};
    const LightAim aim(spheres);
    EXPECT_EQ(aim.spheres().size(), LightAim::kMostSpheres);
    for (const AimSphere& sphere : spheres) {
        bool is_held = false;
        for (const AimSphere& group : aim.spheres())
            is_held = is_held || length(sphere.center - group.center) + sphere.radius <= group.radius * 1.0001f;
        EXPECT_TRUE(is_held);
    }
    EXPECT_TRUE(LightAim(std::vector<AimSphere>()).empty());
}

// What is all around is found in any case.
TEST(LightAim, LeavesLightsInsideASphereAlone) {
    const LightAim aim({{{0.0f, 0.0f, 0.0f}, 2.0f}});
    for (const auto& [name, cone] : cones()) {
        Vec2f u{0.01f, 0.4f};
        EXPECT_FALSE(aim.aim({0.0f, 1.0f, 0.0f}, cone, u)) << name;
        EXPECT_FLOAT_EQ(u.x, 0.01f);
        EXPECT_FLOAT_EQ(aim.pdf_solid_angle({0.0f, 1.0f, 0.0f}, cone, cone.axis, 0.3f), 0.3f) << name;
    }
}

// However small a sphere and however far away: what is aimed at it leads there.
TEST(LightAim, FindsWhatItAimsAt) {
    Random random(4);
    for (const float distance : {0.5f, 10.0f, 1e3f, 1e5f}) {
        const Vec3f origin(0.0f);
        const LightAim aim({{{distance, 0.3f * distance, -0.2f * distance}, 0.1f}});
        const LightCone<float> cone{{0.0f, 1.0f, 0.0f}, -1.0f};
        int aimed = 0;
        int met = 0;
        for (int i = 0; i < 10'000; ++i) {
            Vec2f u = random.next_2d();
            const auto direction = aim.aim(origin, cone, u);
            if (!direction) continue;
            ++aimed;
            if (aim.pdf_solid_angle(origin, cone, *direction, 0.0f) > 0.0f) ++met;
            ASSERT_GT(aim.pdf_solid_angle(origin, cone, *direction, 0.0f, true), 0.0f) << distance;
        }
        // At nothing that is smaller than rounding.
        EXPECT_EQ(aimed > 0, distance < 1e4f) << distance;
        EXPECT_GE(met, aimed - aimed / 1000 - 1) << distance;
    }
}

}  // namespace

}  // namespace etendue::test
