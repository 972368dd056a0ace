#include "sampling/spherical_rectangle.h"

#include "support/chi2.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

/// A rectangle as the origin sees it.
struct View {
    Vec3f corner;
    Vec2f size;

    [[nodiscard]] SphericalRectangle seen() const { return {corner, size}; }
    [[nodiscard]] Vec3f at(Vec2f along) const { return corner + Vec3f(size.x * along.x, size.y * along.y, 0.0f); }
};

/// Where its edges are, and how far away its plane is.
struct Edges {
    double x0, x1, y0, y1, z;

    explicit Edges(const View& view)
        : x0(static_cast<double>(view.corner.x)),
          x1(x0 + static_cast<double>(view.size.x)),
          y0(static_cast<double>(view.corner.y)),
          y1(y0 + static_cast<double>(view.size.y)),
          z(std::abs(static_cast<double>(view.corner.z))) {}
};

/// The solid angle of a rectangle from the foot of the perpendicular to a corner at (x, y).
double corner_solid_angle(double x, double y, double z) {
    return std::atan(x * y / (z * std::sqrt(x * x + y * y + z * z)));
}

double solid_angle_between(const Edges& e, double x0, double x1) {
    return corner_solid_angle(x1, e.y1, e.z) - corner_solid_angle(x0, e.y1, e.z) - corner_solid_angle(x1, e.y0, e.z) +
           corner_solid_angle(x0, e.y0, e.z);
}

/// Before it, beside it on both sides, close to its middle and to its edge, and far away; one is long and narrow.
std::vector<View> views() {
    return {{{-0.3f, -0.2f, -0.5f}, {1.0f, 1.0f}},  {{2.0f, -1.5f, 0.7f}, {3.0f, 1.0f}},
            {{-1.0f, -1.0f, -0.01f}, {2.0f, 2.0f}}, {{0.05f, -0.5f, -0.02f}, {1.0f, 1.0f}},
            {{-7.0f, -4.0f, 2.0f}, {3.0f, 2.0f}},   {{0.0f, 0.0f, -0.3f}, {1e3f, 1e-2f}},
            {{-3.0f, 5.0f, 40.0f}, {2.0f, 1.0f}}};
}

TEST(SphericalRectangle, HasItsSolidAngle) {
    for (const View& view : views()) {
        const Edges e(view);
        const double expected = solid_angle_between(e, e.x0, e.x1);
        EXPECT_NEAR(view.seen().solid_angle() / expected, 1.0, 1e-9);
    }
    // A cube's side from its middle, and the half space that a plane fills.
    const View side{{-1.0f, -1.0f, 1.0f}, {2.0f, 2.0f}};
    EXPECT_NEAR(side.seen().solid_angle(), 2.0 / 3.0 * std::numbers::pi, 1e-12);
    const View plane{{-1e4f, -1e4f, 1e-3f}, {2e4f, 2e4f}};
    EXPECT_NEAR(plane.seen().solid_angle(), 2.0 * std::numbers::pi, 1e-6);
    const View within{{-0.5f, -0.5f, 0.0f}, {1.0f, 1.0f}};
    EXPECT_EQ(within.seen().solid_angle(), 0.0);
}

// Each number alone chooses a part of the solid angle, as large as it says.
TEST(SphericalRectangle, SamplesInvert) {
    for (const View& view : views()) {
        const Edges e(view);
        const SphericalRectangle seen = view.seen();
        for (const float u : {0.01f, 0.3f, 0.77f, 0.995f})
            for (const float v : {0.02f, 0.5f, 0.9f}) {
                const Vec2f at = seen.sample({u, v});
                const double x = e.x0 + static_cast<double>(at.x) * (e.x1 - e.x0);
                const double y = e.y0 + static_cast<double>(at.y) * (e.y1 - e.y0);
                // As exact as a place is that is a float.
                const double step = 1e-7 * (e.x1 - e.x0);
                const double slack = 2e-6 + std::abs(solid_angle_between(e, x - step, x + step) / seen.solid_angle());
                EXPECT_NEAR(solid_angle_between(e, e.x0, x) / seen.solid_angle(), static_cast<double>(u), slack);
                const double r = x * x + e.z * e.z;
                const auto height = [r](double at_y) { return at_y / std::sqrt(r + at_y * at_y); };
                EXPECT_NEAR((height(y) - height(e.y0)) / (height(e.y1) - height(e.y0)), static_cast<double>(v),
                            1e-5 * (1.0 + (e.y1 - e.y0) / std::sqrt(r)));
            }
    }
}

TEST(SphericalRectangle, DirectionsAreUniform) {
    const std::vector<View> all = views();
    constexpr std::size_t kFew = 4;  // which is enough for what the other tests leave open
    for (std::size_t i = 0; i < kFew; ++i) {
        const View& view = all[i];
        const SphericalRectangle seen = view.seen();
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> {
            return normalize(view.at(seen.sample(random.next_2d())));
        };
        const auto density = [&](const Vec3f& w) {
            const float t = view.corner.z / w.z;
            const Vec3f met = w * t - view.corner;
            const bool is_met =
                t > 0.0f && met.x >= 0.0f && met.x <= view.size.x && met.y >= 0.0f && met.y <= view.size.y;
            return is_met ? 1.0 / seen.solid_angle() : 0.0;
        };
        const SamplerCheck check = check_sphere_sampler(sampler, density, {.samples = 20'000, .tolerance = 1e-5});
        EXPECT_GT(check.chi2.p_value, sidak_level(kFamilyLevel, kFew)) << i << ": " << check.chi2.str();
    }
}

// Nothing but places of the rectangle, whatever the numbers, sizes and distances.
TEST(SphericalRectangle, StaysOnTheRectangle) {
    Random random(4);
    const auto any_size = [&] { return std::exp(20.0f * (random.next() - 0.5f)); };
    for (int i = 0; i < 20'000; ++i) {
        const float x = any_size();
        const float y = any_size();
        View view{{-x * 2.0f * random.next(), -y * 2.0f * random.next(), any_size()}, {x, y}};
        if (i % 4 == 0) view.corner.x = -x;
        const SphericalRectangle seen = view.seen();
        EXPECT_GE(seen.solid_angle(), 0.0);
        EXPECT_LE(seen.solid_angle(), 2.0 * std::numbers::pi + 1e-9);
        // So little of it is chosen nowhere.
        if (!(seen.solid_angle() > 1e-3)) continue;
        for (const float u : {0.0f, random.next(), 0x1.fffffep-1f}) {
            const Vec2f at = seen.sample({u, random.next()});
            EXPECT_TRUE(at.x >= 0.0f && at.x <= 1.0f && at.y >= 0.0f && at.y <= 1.0f) << at << view.corner << x << y;
        }
    }
}

}  // namespace
}  // namespace etendue::test
