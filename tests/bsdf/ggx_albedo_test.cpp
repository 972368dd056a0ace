#include "bsdf/ggx_albedo.h"

#include "bsdf/ggx_multiple.h"
#include "support/lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace etendue {

namespace {

constexpr double kPiDouble = std::numbers::pi;

// A second implementation in double precision from the papers: visible normals after Heitz, "Sampling the GGX
// Distribution of Visible Normals" (JCGT 7(4), 2018), over an additive recurrence.
struct Vector {
    double x, y, z;
};
double dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vector visible_normal(const Vector& wo, double alpha, double u1, double u2) {
    const double scale = 1.0 / std::hypot(alpha * wo.x, alpha * wo.y, wo.z);
    const Vector v{alpha * wo.x * scale, alpha * wo.y * scale, wo.z * scale};
    const double planar = std::hypot(v.x, v.y);
    const Vector t1 = planar > 0.0 ? Vector{-v.y / planar, v.x / planar, 0.0} : Vector{1.0, 0.0, 0.0};
    const Vector t2{v.y * t1.z - v.z * t1.y, v.z * t1.x - v.x * t1.z, v.x * t1.y - v.y * t1.x};
    const double r = std::sqrt(u1);
    const double p1 = r * std::cos(2.0 * kPiDouble * u2);
    const double s = 0.5 * (1.0 + v.z);
    const double p2 = (1.0 - s) * std::sqrt(1.0 - p1 * p1) + s * r * std::sin(2.0 * kPiDouble * u2);
    const double p3 = std::sqrt(std::max(0.0, 1.0 - p1 * p1 - p2 * p2));
    const Vector n{alpha * (p1 * t1.x + p2 * t2.x + p3 * v.x), alpha * (p1 * t1.y + p2 * t2.y + p3 * v.y),
                   std::max(0.0, p1 * t1.z + p2 * t2.z + p3 * v.z)};
    const double length = std::hypot(n.x, n.y, n.z);
    return {n.x / length, n.y / length, n.z / length};
}

double lambda(double cos_theta, double alpha) {
    const double tan2 = 1.0 / (cos_theta * cos_theta) - 1.0;
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}

double fresnel(double cos_i, double eta) {
    const double g2 = eta * eta - 1.0 + cos_i * cos_i;
    if (g2 <= 0.0) return 1.0;
    const double g = std::sqrt(g2);  // Walter et al. 2007, equation 22
    const double a = (g - cos_i) / (g + cos_i);
    const double b = (cos_i * (g + cos_i) - 1.0) / (cos_i * (g - cos_i) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

struct Reference {
    double single = 0.0;
    double schlick = 0.0;
    double dielectric = 0.0;
};

constexpr int kFine = 16'384;

Reference integrate(double cos_theta, double alpha, double eta, int samples = kFine) {
    const Vector wo{std::sqrt(1.0 - cos_theta * cos_theta), 0.0, cos_theta};
    const double masking = 1.0 + lambda(cos_theta, alpha);
    Reference sum;
    for (int i = 0; i < samples; ++i) {
        // Roberts's R2 sequence.
        double ignored;
        const Vector h = visible_normal(wo, alpha, std::modf(0.5 + 0.7548776662466927 * i, &ignored),
                                        std::modf(0.5 + 0.5698402909980532 * i, &ignored));
        const double o_h = dot(wo, h);
        const double f = fresnel(o_h, eta);
        const double up = 2.0 * o_h * h.z - wo.z;
        const double reflected = up > 0.0 ? masking / (masking + lambda(up, alpha)) : 0.0;
        sum.single += reflected;
        sum.schlick += reflected * std::pow(1.0 - o_h, 5.0);
        sum.dielectric += f * reflected;
        if (f >= 1.0) continue;
        const double cos_t = std::sqrt(1.0 - (1.0 - o_h * o_h) / (eta * eta));
        const double down = h.z * (o_h / eta - cos_t) - wo.z / eta;
        if (down < 0.0) sum.dielectric += (1.0 - f) * masking / (masking + lambda(down, alpha));
    }
    return {sum.single / samples, sum.schlick / samples, sum.dielectric / samples};
}

// Off the tables' nodes.
constexpr float kAlphas[] = {0.0013f, 0.0047f, 0.0123f, 0.017f, 0.0371f, 0.067f, 0.117f, 0.283f, 0.571f, 0.93f};
constexpr float kCosines[] = {0.02f, 0.023f, 0.041f, 0.061f, 0.137f, 0.31f, 0.57f, 0.83f, 0.99f};

TEST(GgxAlbedo, TablesAgreeWithASecondImplementation) {
    for (const float alpha : kAlphas)
        for (const float cos_theta : kCosines) {
            const Reference reference = integrate(static_cast<double>(cos_theta), static_cast<double>(alpha), 1.5);
            const GgxAlbedo table = ggx_albedo(cos_theta, alpha);
            EXPECT_NEAR(static_cast<double>(table.single), reference.single, 3e-3) << alpha << " " << cos_theta;
            EXPECT_NEAR(static_cast<double>(table.schlick), reference.schlick, 3e-3) << alpha << " " << cos_theta;
        }
}

// A coarse estimate that differs by more than half of the tolerance is repeated with more samples.
TEST(GgxAlbedo, DielectricTablesAgreeWithASecondImplementation) {
    constexpr int kCoarse = 2048;
    constexpr double kTolerance = 5e-3;
    for (const float index : {1.002f, 1.003f, 1.01f, 1.05f, 1.13f, 1.47f, 2.31f, 5.7f, 9.0f})
        for (const float eta : {index, 1.0f / index})
            for (const float alpha : kAlphas) {
                const auto expect_close = [=](float cos_theta) {
                    const auto table = static_cast<double>(ggx_dielectric_albedo(cos_theta, alpha, eta));
                    const auto exact = [&](int samples) {
                        return integrate(static_cast<double>(cos_theta), static_cast<double>(alpha),
                                         static_cast<double>(eta), samples)
                            .dielectric;
                    };
                    const bool is_close = std::abs(table - exact(kCoarse)) <= 0.5 * kTolerance;
                    EXPECT_TRUE(is_close || std::abs(table - exact(kFine)) <= kTolerance)
                        << table << " at " << alpha << " " << cos_theta << " " << eta;
                };
                for (const float cos_theta : kCosines) expect_close(cos_theta);
                // About the critical angle.
                const float critical = std::sqrt(1.0f - 1.0f / (index * index));
                for (const float off : {0.8f, 0.97f, 1.01f, 1.1f})
                    expect_close(std::clamp(critical * off, 0.02f, 1.0f));
            }
}

/// 2 ∫ f(mu) mu dmu, with most steps at grazing angles.
template <typename Function>
double hemisphere_average(const Function& f) {
    constexpr int kSteps = 20'000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double low = std::pow(static_cast<double>(i) / kSteps, 3.0);
        const double high = std::pow(static_cast<double>(i + 1) / kSteps, 3.0);
        sum += f(0.5 * (low + high)) * (high * high - low * low);
    }
    return sum;
}

// The lobes divide what is missing by its average: that must be the average of what they look up, to a per cent or so
// of what is missing.
TEST(GgxAlbedo, AveragesAreThoseOfTheTables) {
    for (const float alpha : kAlphas) {
        const double single = hemisphere_average(
            [&](double mu) { return 1.0 - static_cast<double>(ggx_albedo(static_cast<float>(mu), alpha).single); });
        EXPECT_NEAR(1.0 - static_cast<double>(ggx_albedo_average(alpha).single), single, 0.01 * single + 1e-6) << alpha;
        const double schlick = hemisphere_average(
            [&](double mu) { return static_cast<double>(ggx_albedo(static_cast<float>(mu), alpha).schlick); });
        EXPECT_NEAR(static_cast<double>(ggx_albedo_average(alpha).schlick), schlick, 1e-3 * schlick) << alpha;
        for (const float eta : {1.002f, 1.13f, 2.31f, 6.4f, 1.0f / 1.002f, 1.0f / 1.13f, 1.0f / 2.31f, 1.0f / 6.4f}) {
            const double dielectric = hemisphere_average([&](double mu) {
                return 1.0 - static_cast<double>(ggx_dielectric_albedo(static_cast<float>(mu), alpha, eta));
            });
            EXPECT_NEAR(1.0 - static_cast<double>(ggx_dielectric_albedo_average(alpha, eta)), dielectric,
                        0.01 * dielectric + 1e-6)
                << alpha << " " << eta;
        }
    }
}

TEST(GgxAlbedo, OfManyLanesIsThatOfFloat) {
    EXPECT_LE((test::largest_lane_difference<2>(
                  0.0f, 1.0f,
                  [](const auto& in) {
                      const auto albedo = ggx_albedo(in[0], in[1] * in[1]);
                      const auto average = ggx_albedo_average(in[1] * in[1]);
                      return std::array{albedo.single, albedo.schlick, average.single, average.schlick};
                  })),
              8.0f);
}

TEST(GgxAlbedo, NothingIsMissingFromASmoothSurface) {
    EXPECT_NEAR(ggx_albedo(0.5f, 0.0f).single, 1.0f, 1e-4f);
    EXPECT_NEAR(ggx_albedo(1.0f, 1e-3f).single, 1.0f, 1e-4f);
    EXPECT_NEAR(ggx_albedo(0.5f, 0.0f).schlick, std::pow(0.5f, 5.0f), 1e-3f);
    EXPECT_NEAR(ggx_dielectric_albedo(0.5f, 0.0f, 1.5f), 1.0f, 1e-4f);
    EXPECT_NEAR(ggx_albedo_average(1e-3f).single, 1.0f, 1e-3f);
}

TEST(GgxAlbedo, StaysWithinZeroAndOneToTheEndsOfItsRange) {
    for (const float alpha : {0.0f, 1e-3f, 0.5f, 1.0f})
        for (const float cos_theta : {0.0f, 1e-6f, 0.5f, 1.0f}) {
            for (const float eta : {1.0f / 3.0f, 0.999f, 1.0f, 1.001f, 3.0f}) {
                const float albedo = ggx_dielectric_albedo(cos_theta, alpha, eta);
                EXPECT_TRUE(albedo > 0.0f && albedo <= 1.0f) << cos_theta << " " << alpha << " " << eta;
            }
            const GgxAlbedo albedo = ggx_albedo(cos_theta, alpha);
            EXPECT_TRUE(albedo.single > 0.0f && albedo.single <= 1.0f);
            EXPECT_TRUE(albedo.schlick >= 0.0f && albedo.schlick <= albedo.single);
        }
}

// What makes the density of GgxMultiple a good one: the lobe over it is bounded, where the cosine's reaches 10⁴. From
// inside, nearly smooth surfaces lose what little they do about the critical angle, and the lobe has a peak there.
TEST(GgxMultiple, WeightsAreBounded) {
    for (const float alpha : {0.001f, 0.01f, 0.1f, 0.5f, 1.0f}) {
        const GgxMultiple multiple(alpha);
        for (const float eta : {0.0f, 1.1f, 2.5f, 1.0f / 1.1f, 1.0f / 2.5f}) {
            const float average =
                eta == 0.0f ? ggx_albedo_average(alpha).single : ggx_dielectric_albedo_average(alpha, eta);
            for (float cos_theta = 1e-4f; cos_theta <= 1.0f; cos_theta *= 1.2f) {
                const float albedo =
                    eta == 0.0f ? ggx_albedo(cos_theta, alpha).single : ggx_dielectric_albedo(cos_theta, alpha, eta);
                const float lobe = (1.0f - albedo) / (1.0f - average) * cos_theta * kInvPi;
                const bool at_critical =
                    eta > 0.0f && eta < 1.0f && std::abs(cos_theta - std::sqrt(1.0f - eta * eta)) < 0.15f;
                EXPECT_LT(lobe / multiple.pdf_solid_angle(cos_theta), at_critical ? 20.0f : 3.0f)
                    << alpha << " " << eta << " " << cos_theta;
            }
        }
    }
}

}  // namespace

}  // namespace etendue
