#include "bsdf/ggx.h"

#include "bsdf/ggx_multiple.h"
#include "bsdf_settings.h"
#include "support/chi2.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr float kAlphas[] = {0.01f, 0.1f, 0.3f, 0.6f, 1.0f};
constexpr float kCosines[] = {0.03f, 0.3f, 0.8f, 1.0f};

/// 1 - cos of a normal with slope tan theta: integrals over normals run over theta in a coordinate that spreads the
/// peak.
template <typename Function>
double integrate_normals(float alpha, const Function& f) {
    // tan theta = alpha * s / (1 - s): half of the steps lie within alpha of the axis.
    constexpr int kRings = 600;
    constexpr int kSectors = 64;
    double sum = 0.0;
    double theta_low = 0.0;
    for (int i = 0; i < kRings; ++i) {
        const double s_high = static_cast<double>(i + 1) / kRings;
        const double theta_high =
            i + 1 == kRings ? 0.5 * 3.14159265358979 : std::atan(static_cast<double>(alpha) * s_high / (1.0 - s_high));
        const double theta = 0.5 * (theta_low + theta_high);
        const double area = (std::cos(theta_low) - std::cos(theta_high)) * 2.0 * 3.14159265358979 / kSectors;
        for (int j = 0; j < kSectors; ++j) {
            const double phi = 2.0 * 3.14159265358979 * (j + 0.5) / kSectors;
            sum += area *
                   f(Vec3f(static_cast<float>(std::sin(theta) * std::cos(phi)),
                           static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))));
        }
        theta_low = theta_high;
    }
    return sum;
}

TEST(Ggx, ProjectedAreaOfTheNormalsIsOne) {
    for (const float alpha : kAlphas) {
        const Ggx ggx = Ggx::isotropic(alpha);
        EXPECT_NEAR(integrate_normals(alpha, [&](const Vec3f& h) { return static_cast<double>(ggx.d(h) * h.z); }), 1.0,
                    2e-3)
            << alpha;
    }
}

// Heitz 2014, equation 13: what is visible from a direction is the surface's projection onto it.
TEST(Ggx, SmithMaskingConservesTheProjectedArea) {
    for (const float alpha : kAlphas)
        for (const float cos_theta : kCosines) {
            const Ggx ggx = Ggx::isotropic(alpha);
            const Vec3f wo = direction_at(cos_theta);
            const double visible = integrate_normals(alpha, [&](const Vec3f& h) {
                return static_cast<double>(ggx.g1(wo) * std::max(0.0f, dot(wo, h)) * ggx.d(h));
            });
            EXPECT_NEAR(visible / static_cast<double>(cos_theta), 1.0, 5e-3) << alpha << " " << cos_theta;
        }
}

TEST(Ggx, VisibleNormalsFollowTheirDensity) {
    const double level = sidak_level(kFamilyLevel, std::size(kAlphas) * std::size(kCosines));
    std::uint32_t seed = 100;
    for (const float alpha : kAlphas)
        for (const float cos_theta : kCosines) {
            SCOPED_TRACE(testing::Message() << "alpha " << alpha << ", cos " << cos_theta);
            const Ggx ggx = Ggx::isotropic(alpha);
            const Vec3f wo = direction_at(cos_theta);
            const auto sampler = [&](Random& random) -> std::optional<Vec3f> {
                return ggx.sample_visible_normal(wo, random.next_2d());
            };
            // Heitz 2014, equation 2.
            const auto density = [&](const Vec3f& h) {
                return h.z > 0.0f ? static_cast<double>(ggx.g1(wo) * ggx.d(h) * std::max(0.0f, dot(wo, h)) / wo.z)
                                  : 0.0;
            };
            const SamplerCheck check = check_sphere_sampler(sampler, density, {.seed = ++seed});
            EXPECT_GE(check.chi2.p_value, level) << check.chi2.str();
            EXPECT_NEAR(check.pdf_integral, 1.0, 2e-3);
        }
}

// Heitz 2014, equation 80: reflected by visible normals without shadowing, everything leaves, above or below.
TEST(Ggx, PassesTheWeakWhiteFurnace) {
    for (const float alpha : {0.1f, 0.6f, 1.0f})
        for (const float cos_theta : kCosines) {
            const Ggx ggx = Ggx::isotropic(alpha);
            const Vec3f wo = direction_at(cos_theta);
            const auto guide = [&](Random& random) -> std::optional<Vec3f> {
                const Vec3f h = ggx.sample_visible_normal(wo, random.next_2d());
                return h * (2.0f * dot(wo, h)) - wo;
            };
            const double sum = integrate_sphere(guide, [&](const Vec3f& wi) {
                const Vec3f h = normalize(wo + wi);
                return h.z > 0.0f ? static_cast<double>(ggx.g1(wo) * ggx.d(h) / (4.0f * wo.z)) : 0.0;
            });
            EXPECT_NEAR(sum, 1.0, 5e-3) << alpha << " " << cos_theta;
        }
}

TEST(Ggx, MaskingAndShadowingAreCorrelated) {
    const Ggx ggx = Ggx::isotropic(0.5f);
    const Vec3f a = direction_at(0.3f);
    const Vec3f b = normalize({-0.2f, 0.5f, 0.4f});
    EXPECT_FLOAT_EQ(ggx.g2(a, b), ggx.g2(b, a));
    EXPECT_GT(ggx.g2(a, b), ggx.g1(a) * ggx.g1(b)) << "more is visible than if the two were independent";
    EXPECT_LT(ggx.g2(a, b), std::min(ggx.g1(a), ggx.g1(b)));
    EXPECT_EQ(ggx.g1({0.0f, 0.0f, 1.0f}), 1.0f);
}

TEST(GgxMultiple, SamplesFollowTheStatedDensity) {
    const double level = sidak_level(kFamilyLevel, std::size(kAlphas));
    for (const float alpha : kAlphas) {
        SCOPED_TRACE(alpha);
        const GgxMultiple multiple(alpha);
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> { return multiple.sample(random.next_2d()); };
        const auto density = [&](const Vec3f& w) {
            return w.z > 0.0f ? static_cast<double>(multiple.pdf_solid_angle(w.z)) : 0.0;
        };
        const SamplerCheck check = check_sphere_sampler(sampler, density, {.seed = 200});
        EXPECT_GE(check.chi2.p_value, level) << check.chi2.str();
        EXPECT_NEAR(check.pdf_integral, 1.0, 2e-3);
    }
}

}  // namespace

}  // namespace etendue::test
