// A lossless surface in a white furnace sends back exactly what arrives, from every side and at every roughness.
#include "bsdf/bsdf.h"
#include "bsdf_settings.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr double kTolerance = 5e-3;

float radical_inverse(std::uint32_t base, std::uint32_t i) {
    double result = 0.0;
    double digit = 1.0;
    for (; i > 0; i /= base) {
        digit /= base;
        result += digit * (i % base);
    }
    return static_cast<float>(std::min(result, 0.9999999));
}

struct HaltonPoint {
    float u_lobe;
    Vec2f u;
};

std::vector<HaltonPoint> halton(std::uint32_t count) {
    std::vector<HaltonPoint> points;
    for (std::uint32_t i = 0; i < count; ++i)
        points.push_back({radical_inverse(2, i), {radical_inverse(3, i), radical_inverse(5, i)}});
    return points;
}

double albedo(const Bsdf& bsdf, const Vec3f& wo, const std::vector<HaltonPoint>& points) {
    double sum = 0.0;
    for (const HaltonPoint& p : points)
        sum += static_cast<double>(sample_bsdf(bsdf, wo, p.u_lobe, p.u, TransportMode::Importance).weight.g);
    return sum / static_cast<double>(points.size());
}

/// The largest deviation of the albedo from one over a grid of alpha in [0.001, 1] and |cos theta| in [0.02, 1]. A
/// coarse estimate that deviates by more than half of what is allowed is repeated with more samples.
template <typename Make>
void expect_white(const std::string& name, const Make& make, float side) {
    static const std::vector<HaltonPoint> coarse = halton(1024);
    static const std::vector<HaltonPoint> fine = halton(32'768);
    constexpr int kAlphas = 16;
    constexpr int kCosines = 16;
    double worst = 0.0;
    std::string where;
    for (int i = 0; i < kAlphas; ++i) {
        const float alpha = std::min(1.0f, 0.001f * std::pow(1000.0f, static_cast<float>(i) / (kAlphas - 1)));
        const Bsdf bsdf = make(alpha);
        for (int j = 0; j < kCosines; ++j) {
            const float t = static_cast<float>(j) / (kCosines - 1);
            const Vec3f wo = direction_at(side * (0.02f + 0.98f * t * t));
            double deviation = albedo(bsdf, wo, coarse) - 1.0;
            if (std::abs(deviation) > 0.5 * kTolerance) deviation = albedo(bsdf, wo, fine) - 1.0;
            if (std::abs(deviation) <= std::abs(worst)) continue;
            worst = deviation;
            where = "alpha " + std::to_string(alpha) + ", cos " + std::to_string(wo.z);
        }
    }
    EXPECT_LE(std::abs(worst), kTolerance) << name << " at " << where;
}

TEST(WhiteFurnace, LosslessConductor) {
    expect_white(
        "conductor",
        [](float alpha) {
            return RoughConductor{lossless_mirror(), alpha};
        },
        1.0f);
}

TEST(WhiteFurnace, WhiteMetallicRoughness) {
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float f0 : {0.0f, 0.04f, 0.3f}) {
            const auto make = [=](float alpha) {
                return MetallicRoughness{.base = Rgb(1.0f), .metallic = metallic, .alpha = alpha, .f0 = Rgb(f0)};
            };
            expect_white("metallic " + std::to_string(metallic) + " f0 " + std::to_string(f0), make, 1.0f);
            if (metallic == 1.0f) break;
        }
}

TEST(WhiteFurnace, WeakReflectionOverWhite) {
    for (const float f90 : {0.0f, 0.5f})
        for (const float transmission : {0.0f, 1.0f}) {
            const auto make = [=](float alpha) {
                return MetallicRoughness{.base = Rgb(1.0f),
                                         .metallic = 0.0f,
                                         .alpha = alpha,
                                         .f0 = Rgb(0.04f * f90),
                                         .f90 = f90,
                                         .transmission = transmission};
            };
            expect_white("f90 " + std::to_string(f90) + " transmission " + std::to_string(transmission), make, 1.0f);
        }
}

TEST(WhiteFurnace, WhiteThinSheet) {
    for (const float transmission : {0.5f, 1.0f})
        for (const float f0 : {0.0f, 0.04f, 0.3f}) {
            const auto make = [=](float alpha) {
                return MetallicRoughness{
                    .base = Rgb(1.0f), .metallic = 0.0f, .alpha = alpha, .f0 = Rgb(f0), .transmission = transmission};
            };
            expect_white("transmission " + std::to_string(transmission) + " f0 " + std::to_string(f0), make, 1.0f);
        }
}

TEST(WhiteFurnace, DielectricFromBothSides) {
    for (const float ior : {1.01f, 1.05f, 1.1f, 1.33f, 1.5f, 1.9f, 2.5f})
        for (const float side : {1.0f, -1.0f})
            expect_white(
                "dielectric " + std::to_string(ior) + (side > 0.0f ? " outside" : " inside"),
                [=](float alpha) { return RoughDielectric::make(ior, alpha); }, side);
}

TEST(WhiteFurnace, SmoothDielectric) {
    for (const float cos_theta : {0.02f, 0.3f, 1.0f, -0.02f, -0.3f, -1.0f})
        EXPECT_NEAR(albedo(SmoothDielectric{1.5f}, direction_at(cos_theta), halton(64)), 1.0, 1e-6);
}

TEST(WhiteFurnace, SmoothWhiteCoat) {
    for (const float cos_theta : {0.02f, 0.3f, 1.0f})
        EXPECT_NEAR(albedo(MetallicRoughness{.base = Rgb(1.0f), .metallic = 0.0f, .alpha = 0.0f},
                           direction_at(cos_theta), halton(4096)),
                    1.0, 1e-3);
}

}  // namespace

}  // namespace etendue::test
