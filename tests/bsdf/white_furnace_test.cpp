// A lossless surface in a white furnace sends back exactly what arrives, from every side and at every roughness.
#include "bsdf/bsdf.h"
#include "bsdf_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr double kTolerance = 5e-3;
constexpr std::array kModes{TransportMode::Importance, TransportMode::Radiance};

constexpr XyzToWorking kXyz{{{3.2404542f, -1.5371385f, -0.4985314f},
                             {-0.9692660f, 1.8760108f, 0.0415560f},
                             {0.0556434f, -0.2040259f, 1.0572252f}}};

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

/// Index inside over index outside, of surfaces that light crosses into a body; 1 of all others.
float relative_index(const Bsdf& bsdf) {
    if (const auto* smooth = std::get_if<SmoothDielectric>(&bsdf)) return smooth->ior;
    if (const auto* rough = std::get_if<RoughDielectric>(&bsdf)) return rough->ior;
    if (const auto* body = std::get_if<DielectricBody>(&bsdf))
        return std::visit([](const auto& interface) { return interface.ior; }, body->interface);
    const auto* layered = std::get_if<LayeredSurface>(&bsdf);
    return layered != nullptr && layered->is_two_sided() ? relative_index(std::get<DielectricBody>(layered->base))
                                                         : 1.0f;
}

/// Of the brightest channel: coloured layers let through what that one leaves, and absorb the rest of the others.
/// Refraction scales radiance by the squared indices (Veach 1997, equation 5.2): undone here, by the sides of the two
/// directions alone, so that both modes send back what arrives.
double albedo(const Bsdf& bsdf, const Vec3f& wo, std::span<const HaltonPoint> points, TransportMode mode) {
    const float eta = wo.z > 0.0f ? relative_index(bsdf) : 1.0f / relative_index(bsdf);
    const float unscale = mode == TransportMode::Radiance ? eta * eta : 1.0f;
    std::array<double, 3> sum{};
    for (const HaltonPoint& p : points) {
        const BsdfSample s = sample_bsdf(bsdf, wo, p.u_lobe, p.u, mode);
        const Rgb weight = s.wi.z * wo.z < 0.0f ? s.weight * unscale : s.weight;
        sum[0] += static_cast<double>(weight.r);
        sum[1] += static_cast<double>(weight.g);
        sum[2] += static_cast<double>(weight.b);
    }
    return *std::ranges::max_element(sum) / static_cast<double>(points.size());
}

/// How far the albedo is from one. A coarse estimate that deviates by more than half of `tolerance` is repeated with
/// more samples; the finest are good to 5e-4.
double deviation_from_white(const Bsdf& bsdf, const Vec3f& wo, TransportMode mode, double tolerance) {
    static const std::vector<HaltonPoint> points = halton(32'768);
    double deviation = 0.0;
    for (const std::size_t count : {1024u, 8192u, 32'768u}) {
        deviation = albedo(bsdf, wo, std::span(points).first(count), mode) - 1.0;
        if (std::abs(deviation) <= 0.5 * tolerance) break;
    }
    return deviation;
}

/// True if some of the light goes on beyond the surface.
bool transmits(const Bsdf& bsdf) {
    const auto* layered = std::get_if<LayeredSurface>(&bsdf);
    return layered != nullptr ? std::visit([](const auto& base) { return transmits(base); }, layered->base)
                              : !only_reflects(bsdf);
}

/// The largest deviation of the albedo from one over a third of a grid of alpha in [0.001, 1] and |cos theta| in [0.02,
/// 1], in both modes if it transmits.
template <typename Make>
void expect_white(const std::string& name, const Make& make, float side, double tolerance = kTolerance,
                  float azimuth = 0.0f) {
    constexpr int kAlphas = 16;
    constexpr int kCosines = 16;
    double worst = 0.0;
    std::string where;
    for (int i = 0; i < kAlphas; ++i) {
        const float alpha = std::min(1.0f, 0.001f * std::pow(1000.0f, static_cast<float>(i) / (kAlphas - 1)));
        const Bsdf bsdf = make(alpha);
        // Every third cosine, others for the next alpha, for speed.
        for (int j = i % 3; j < kCosines; j += 3) {
            const float t = static_cast<float>(j) / (kCosines - 1);
            const Vec3f in_plane = direction_at(side * (0.02f + 0.98f * t * t));
            const Vec3f wo{in_plane.x * std::cos(azimuth), in_plane.x * std::sin(azimuth), in_plane.z};
            for (const TransportMode mode : kModes) {
                if (mode == TransportMode::Radiance && !transmits(bsdf)) continue;
                const double deviation = deviation_from_white(bsdf, wo, mode, tolerance);
                if (std::abs(deviation) <= std::abs(worst)) continue;
                worst = deviation;
                where = "alpha " + std::to_string(alpha) + ", cos " + std::to_string(wo.z) +
                        (mode == TransportMode::Radiance ? ", radiance" : ", importance");
            }
        }
    }
    EXPECT_LE(std::abs(worst), tolerance) << name << " off by " << worst << " at " << where;
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
                return MetallicRoughness{
                    .base = Rgb(1.0f), .metallic = metallic, .alpha_x = alpha, .alpha_y = alpha, .f0 = Rgb(f0)};
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
                                         .alpha_x = alpha,
                                         .alpha_y = alpha,
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
                return MetallicRoughness{.base = Rgb(1.0f),
                                         .metallic = 0.0f,
                                         .alpha_x = alpha,
                                         .alpha_y = alpha,
                                         .f0 = Rgb(f0),
                                         .transmission = transmission};
            };
            expect_white("transmission " + std::to_string(transmission) + " f0 " + std::to_string(f0), make, 1.0f);
        }
}

TEST(WhiteFurnace, DielectricFromBothSides) {
    for (const float ior : {1.002f, 1.005f, 1.01f, 1.05f, 1.1f, 1.33f, 1.5f, 1.9f, 2.5f, 4.0f, 9.0f, 20.0f})
        for (const float side : {1.0f, -1.0f})
            expect_white(
                "dielectric " + std::to_string(ior) + (side > 0.0f ? " outside" : " inside"),
                [=](float alpha) { return RoughDielectric::make(ior, alpha); }, side);
}

// Facets that reflect less let more through; what is lost between them changes with it.
TEST(WhiteFurnace, DielectricWithAnotherReflectance) {
    struct Interface {
        float ior;
        InterfaceFresnel fresnel;
    };
    for (const auto& [ior, fresnel] : {Interface{1.5f, {.weight = 0.0f}}, Interface{3.0f, {.weight = 0.3f}},
                                       Interface{1.5f, {.tint = Rgb(0.0f)}}, Interface{0.7f, {.tint = Rgb(3.0f)}}})
        for (const float side : {1.0f, -1.0f}) {
            const auto make = [ior = ior, fresnel = fresnel](float alpha) {
                return RoughDielectric::make(ior, alpha, alpha, fresnel);
            };
            expect_white("index " + std::to_string(ior), make, side);
        }
    // Stretched facets are taken for round ones that miss as much.
    for (const float side : {1.0f, -1.0f})
        expect_white(
            "stretched", [](float alpha) { return RoughDielectric::make(1.5f, 1.0f, alpha, {.weight = 0.0f}); }, side,
            0.06, 0.7f);
}

TEST(WhiteFurnace, DielectricBubble) {
    for (const float side : {1.0f, -1.0f})
        expect_white(
            "bubble", [](float alpha) { return RoughDielectric::make(1.0f / 1.5f, alpha); }, side);
}

TEST(WhiteFurnace, RoughDiffuse) {
    expect_white(
        "rough diffuse",
        [](float roughness) {
            return RoughDiffuse{Rgb(1.0f), roughness};
        },
        1.0f);
}

TEST(WhiteFurnace, Leaf) {
    const auto make = [](float alpha) {
        return MetallicRoughness{
            .base = Rgb(1.0f), .metallic = 0.0f, .alpha_x = alpha, .alpha_y = alpha, .diffuse_transmission = 0.7f};
    };
    expect_white("leaf", make, 1.0f);
}

/// Without a specular layer it is EON itself; under one some light is lost that EON would send back at grazing angles.
TEST(WhiteFurnace, RoughDiffuseUnderGloss) {
    for (const float shine : {0.0f, 1.0f}) {
        const auto make = [=](float roughness) {
            return MetallicRoughness{.base = Rgb(1.0f),
                                     .metallic = 0.0f,
                                     .alpha_x = 0.3f,
                                     .alpha_y = 0.3f,
                                     .f0 = Rgb(0.04f * shine),
                                     .f90 = shine,
                                     .diffuse_transmission = 0.5f,
                                     .diffuse_roughness = roughness};
        };
        expect_white("shine " + std::to_string(shine), make, 1.0f, shine > 0.0f ? 0.03 : kTolerance);
    }
}

TEST(WhiteFurnace, AnisotropicMetal) {
    for (const float strength : {0.3f, 0.6f, 1.0f}) {
        const auto make = [=](float alpha) {
            return MetallicRoughness{
                .base = Rgb(1.0f), .alpha_x = alpha + (1.0f - alpha) * strength * strength, .alpha_y = alpha};
        };
        for (const float azimuth : {0.0f, 0.7f, 1.566f})
            expect_white("strength " + std::to_string(strength) + " azimuth " + std::to_string(azimuth), make, 1.0f,
                         kTolerance, azimuth);
    }
}

TEST(WhiteFurnace, AnisotropicPlastic) {
    const auto make = [](float alpha) {
        return MetallicRoughness{
            .base = Rgb(1.0f), .metallic = 0.0f, .alpha_x = alpha, .alpha_y = alpha + (1.0f - alpha) * 0.49f};
    };
    for (const float azimuth : {0.0f, 0.7f, 0.5f * kPi}) expect_white("plastic", make, 1.0f, 1e-2, azimuth);
}

TEST(WhiteFurnace, AnisotropicDielectric) {
    for (const float ior : {1.002f, 1.01f, 1.1f, 1.5f, 2.4f, 9.0f})
        for (const float wide : {0.4f, 0.85f, 1.0f})
            for (const float narrow : {0.001f, 0.02f, 0.06f, 0.2f}) {
                const RoughDielectric lobe = RoughDielectric::make(ior, wide, narrow);
                for (const float cos_theta : {0.02f, 0.12f, 0.5f, -0.02f, -0.12f, -0.5f}) {
                    const Vec3f in_plane = direction_at(cos_theta);
                    // Along and across the grooves, close to that, where what narrow ones look like changes at once,
                    // and where they begin to reflect totally.
                    const float critical = std::asin(std::min(1.0f, 1.0f / (ior * in_plane.x)));
                    for (const float azimuth : {0.0f, 0.4f, 1.1f, 1.566f, 0.99f * critical, 0.94f * critical})
                        for (const TransportMode mode : kModes) {
                            const Vec3f wo{in_plane.x * std::cos(azimuth), in_plane.x * std::sin(azimuth), in_plane.z};
                            const double deviation = deviation_from_white(lobe, wo, mode, kTolerance);
                            EXPECT_LE(std::abs(deviation), kTolerance)
                                << "index " << ior << " alphas " << wide << " " << narrow << " azimuth " << azimuth
                                << " cos " << cos_theta << " off by " << deviation;
                        }
                }
            }
}

TEST(WhiteFurnace, WhiteUnderFilm) {
    for (const float metallic : {0.0f, 1.0f})
        for (const float thickness : {150.0f, 400.0f}) {
            const auto make = [=](float alpha) {
                return MetallicRoughness{
                    .base = Rgb(1.0f),
                    .metallic = metallic,
                    .alpha_x = alpha,
                    .alpha_y = alpha,
                    .film = {.strength = 1.0f, .ior = 1.4f, .thickness_nm = thickness, .xyz_to_working = &kXyz}};
            };
            expect_white("film " + std::to_string(thickness) + " metallic " + std::to_string(metallic), make, 1.0f,
                         0.02);
        }
}

TEST(WhiteFurnace, SheenOverWhite) {
    for (const float color : {0.3f, 1.0f}) {
        const auto make = [=](float alpha) {
            return LayeredSurface::make(MetallicRoughness{.base = Rgb(1.0f), .metallic = 0.0f},
                                        Sheen{Rgb(color), alpha}, {});
        };
        expect_white("sheen " + std::to_string(color), make, 1.0f, 0.01);
    }
}

TEST(WhiteFurnace, CoatOverWhite) {
    for (const float metallic : {0.0f, 1.0f})
        for (const float base_alpha : {0.0f, 0.3f, 1.0f}) {
            const auto make = [=](float alpha) {
                return LayeredSurface::make(
                    MetallicRoughness{
                        .base = Rgb(1.0f), .metallic = metallic, .alpha_x = base_alpha, .alpha_y = base_alpha},
                    {}, ClearCoat{1.0f, alpha});
            };
            expect_white("metallic " + std::to_string(metallic) + " base " + std::to_string(base_alpha), make, 1.0f,
                         metallic > 0.0f ? 0.04 : 0.01);
        }
}

// Layers take more from what is neither diffuse nor a mirror than they reflect: these lose light, and none makes any.
TEST(WhiteFurnace, LayersOverWhatIsNotDiffuse) {
    const ClearCoat coat{1.0f, 0.1f};
    const Sheen sheen{Rgb(1.0f), 0.3f};
    const auto metal = [](float alpha) {
        return MetallicRoughness{.base = Rgb(1.0f), .alpha_x = alpha, .alpha_y = alpha};
    };
    const auto pane = [](float alpha) {
        return MetallicRoughness{
            .base = Rgb(1.0f), .metallic = 0.0f, .alpha_x = alpha, .alpha_y = alpha, .transmission = 1.0f};
    };
    const auto leaf = [](float alpha) {
        return MetallicRoughness{
            .base = Rgb(1.0f), .metallic = 0.0f, .alpha_x = alpha, .alpha_y = alpha, .diffuse_transmission = 0.7f};
    };
    const auto glass = [](float alpha) { return DielectricBody{RoughDielectric::make(1.5f, alpha), {}, 1.0f}; };
    const auto over = [](const auto& base, const Sheen& s, const ClearCoat& c) {
        return [=](float alpha) { return LayeredSurface::make(base(alpha), s, c); };
    };
    expect_white("sheen over metal", over(metal, sheen, {}), 1.0f, 0.05);
    expect_white("both over metal", over(metal, sheen, coat), 1.0f, 0.07);
    expect_white("coat over a pane", over(pane, {}, coat), 1.0f, 0.03);
    expect_white("sheen over a pane", over(pane, sheen, {}), 1.0f, 0.05);
    expect_white("both over a leaf", over(leaf, sheen, coat), 1.0f, 0.025);
    expect_white("coat over glass", over(glass, {}, coat), 1.0f, 0.01);
    expect_white("sheen over glass", over(glass, sheen, {}), 1.0f, 0.015);
    const auto smooth_glass = [](float) { return DielectricBody{SmoothDielectric{1.5f}, {}, 1.0f}; };
    expect_white("coat over glass, from inside", over(glass, {}, coat), -1.0f, 0.025);
    expect_white("smooth coat over glass, from inside", over(glass, {}, ClearCoat{1.0f, 0.0f}), -1.0f, 0.04);
    expect_white("sheen over glass, from inside", over(glass, sheen, {}), -1.0f, 0.047);
    expect_white("both over glass, from inside", over(glass, sheen, coat), -1.0f, 0.058);
    expect_white("both over smooth glass, from inside", over(smooth_glass, sheen, coat), -1.0f, 1e-3);
}

TEST(WhiteFurnace, CoatOverSheen) {
    const auto make = [=](float alpha) {
        return LayeredSurface::make(MetallicRoughness{.base = Rgb(1.0f), .metallic = 0.0f}, Sheen{Rgb(1.0f), 0.3f},
                                    ClearCoat{1.0f, alpha});
    };
    expect_white("both", make, 1.0f, 0.025);
}

TEST(WhiteFurnace, SmoothDielectric) {
    for (const float cos_theta : {0.02f, 0.3f, 1.0f, -0.02f, -0.3f, -1.0f})
        for (const TransportMode mode : kModes)
            EXPECT_NEAR(albedo(SmoothDielectric{1.5f}, direction_at(cos_theta), halton(64), mode), 1.0, 1e-6);
}

TEST(WhiteFurnace, SmoothWhiteCoat) {
    for (const float cos_theta : {0.02f, 0.3f, 1.0f})
        EXPECT_NEAR(albedo(MetallicRoughness{.base = Rgb(1.0f), .metallic = 0.0f, .alpha_x = 0.0f, .alpha_y = 0.0f},
                           direction_at(cos_theta), halton(4096), TransportMode::Importance),
                    1.0, 1e-3);
}

}  // namespace

}  // namespace etendue::test
