#include "bsdf/bsdf.h"

#include "bsdf_settings.h"
#include "support/chi2.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

BsdfSample sample_with(const BsdfSetting& setting, const Vec3f& wo, Random& random) {
    const float u_lobe = random.next();
    return sample_bsdf(setting.bsdf, wo, u_lobe, random.next_2d(), setting.mode);
}

Vec3f random_direction(Random& random) {
    const float z = 2.0f * random.next() - 1.0f;
    const float phi = 2.0f * kPi * random.next();
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

std::string describe(const BsdfSetting& setting, const Vec3f& wo) {
    return setting.name + ", wo = (" + std::to_string(wo.x) + ", " + std::to_string(wo.y) + ", " +
           std::to_string(wo.z) + ")";
}

/// Modes differ in their weights only (tested below): for distributions one of them suffices.
std::vector<BsdfSetting> distribution_settings() {
    std::vector<BsdfSetting> settings = non_delta_bsdf_settings();
    std::erase_if(settings, [](const BsdfSetting& s) { return s.mode == TransportMode::Radiance; });
    return settings;
}

TEST(Bsdf, ModesDifferInTheirWeightsOnly) {
    Random random(9);
    for (const BsdfSetting& setting : non_delta_bsdf_settings()) {
        for (const Vec3f& wo : outgoing_directions(setting.bsdf)) {
            for (int i = 0; i < 100; ++i) {
                const float u_lobe = random.next();
                const Vec2f u{random.next(), random.next()};
                const BsdfSample eye = sample_bsdf(setting.bsdf, wo, u_lobe, u, TransportMode::Radiance);
                const BsdfSample light = sample_bsdf(setting.bsdf, wo, u_lobe, u, TransportMode::Importance);
                ASSERT_EQ(eye.wi, light.wi) << describe(setting, wo);
                ASSERT_EQ(eye.pdf_solid_angle, light.pdf_solid_angle) << describe(setting, wo);
                const Vec3f wi = random_direction(random);
                ASSERT_EQ(evaluate_bsdf(setting.bsdf, wo, wi, TransportMode::Radiance).pdf_solid_angle,
                          evaluate_bsdf(setting.bsdf, wo, wi, TransportMode::Importance).pdf_solid_angle)
                    << describe(setting, wo);
            }
        }
    }
}

// Following all deltas is what choosing one of them does on average. Deltas of one direction are told apart by nothing
// but what they go on as.
TEST(Bsdf, TheListOfDeltasIsTheMeanOfTheirSamples) {
    constexpr int kStrata = 128;
    std::size_t lists = 0;
    for (const BsdfSetting& setting : all_bsdf_settings()) {
        if (setting.mode == TransportMode::Importance && is_two_sided_interface(setting.bsdf)) continue;
        for (const Vec3f& wo : outgoing_directions(setting.bsdf)) {
            const DeltaList deltas = deltas_of(setting.bsdf, wo);
            std::vector<Rgb> means(DeltaList::kCapacity);
            for (int i = 0; i < kStrata * kStrata; ++i) {
                // The choice among lobes takes `u_lobe`, that of light that leaves a coated body `u.x`.
                const float u_lobe = (static_cast<float>(i) + 0.5f) / (kStrata * kStrata);
                const Vec2f u{(static_cast<float>(i % kStrata) + 0.5f) / kStrata, 0.5f};
                const BsdfSample s = sample_bsdf(setting.bsdf, wo, u_lobe, u, TransportMode::Radiance);
                if (!s.is_delta || is_black(s.weight)) continue;
                const auto same = std::find_if(deltas.begin(), deltas.end(), [&](const BsdfSample& d) {
                    return length(d.wi - s.wi) < 1e-5f && d.is_transmission == s.is_transmission && d.eta == s.eta;
                });
                ASSERT_NE(same, deltas.end()) << describe(setting, wo);
                means[static_cast<std::size_t>(same - deltas.begin())] += s.weight / (kStrata * kStrata);
            }
            std::size_t i = 0;
            for (const BsdfSample& delta : deltas) {
                EXPECT_TRUE(delta.is_delta);
                const Rgb difference = delta.weight - means[i];
                EXPECT_LT(std::max(max_component(difference), -min_component(difference)), 0.003f)
                    << describe(setting, wo);
                ++i;
            }
            lists += i > 0 ? 1 : 0;
        }
    }
    EXPECT_GT(lists, 100u);
}

TEST(Bsdf, SamplesFollowTheStatedDensity) {
    struct Check {
        const BsdfSetting* setting;
        Vec3f wo;
        std::uint32_t seed;
    };
    const std::vector<BsdfSetting> settings = distribution_settings();
    // Each lobe is checked in every third direction. Its neighbours in the table, which differ in one number, are
    // checked in the others.
    std::vector<Check> checks;
    std::uint32_t seed = 0;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const std::vector<Vec3f> directions = outgoing_directions(settings[i].bsdf);
        for (std::size_t d = 0; d < directions.size(); ++d) {
            ++seed;
            if (d % 3 == i % 3) checks.push_back({&settings[i], directions[d], seed});
        }
    }
    const double level = sidak_level(kFamilyLevel, checks.size());
    for (const Check& c : checks) {
        const BsdfSetting& setting = *c.setting;
        const Vec3f& wo = c.wo;
        SCOPED_TRACE(describe(setting, wo));
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> {
            const BsdfSample s = sample_with(setting, wo, random);
            if (s.is_delta || s.pdf_solid_angle == 0.0f) return std::nullopt;
            return s.wi;
        };
        const auto density = [&](const Vec3f& wi) {
            return static_cast<double>(evaluate_bsdf(setting.bsdf, wo, wi, setting.mode).pdf_solid_angle);
        };
        const SamplerCheck check = check_sphere_sampler(sampler, density, {.samples = 30'000, .seed = c.seed});
        EXPECT_GE(check.chi2.p_value, level) << check.chi2.str();
        // What the density leaves over is exactly what is rejected or a delta.
        EXPECT_NEAR(check.pdf_integral, check.hit_share, 5.0 * check.hit_error + 2e-3);
        EXPECT_LE(check.pdf_integral, 1.0 + 2e-3);
    }
}

TEST(Bsdf, SampledWeightIsValueOverDensity) {
    Random random(3);
    for (const BsdfSetting& setting : all_bsdf_settings())
        for (const Vec3f& wo : outgoing_directions(setting.bsdf))
            for (int i = 0; i < 200; ++i) {
                const BsdfSample s = sample_with(setting, wo, random);
                if (is_black(s.weight)) continue;
                ASSERT_TRUE(is_finite(s.weight)) << describe(setting, wo);
                ASSERT_GE(min_component(s.weight), 0.0f) << describe(setting, wo);
                ASSERT_NEAR(length(s.wi), 1.0f, 1e-5f) << describe(setting, wo);
                ASSERT_EQ(s.is_transmission, s.wi.z * wo.z < 0.0f) << describe(setting, wo);
                if (s.is_delta) continue;
                const BsdfValue value = evaluate_bsdf(setting.bsdf, wo, s.wi, setting.mode);
                ASSERT_GT(s.pdf_solid_angle, 0.0f) << describe(setting, wo);
                ASSERT_NEAR(value.pdf_solid_angle / s.pdf_solid_angle, 1.0f, 1e-3f) << describe(setting, wo);
                const Rgb expected = value.f_cos / value.pdf_solid_angle;
                const float tolerance = 1e-3f * (max_component(expected) + 1e-6f);
                ASSERT_NEAR(s.weight.r, expected.r, tolerance) << describe(setting, wo);
                ASSERT_NEAR(s.weight.g, expected.g, tolerance) << describe(setting, wo);
                ASSERT_NEAR(s.weight.b, expected.b, tolerance) << describe(setting, wo);
            }
}

TEST(Bsdf, ValuesAreFiniteAndNotNegative) {
    Random random(4);
    for (const BsdfSetting& setting : all_bsdf_settings())
        for (int i = 0; i < 2000; ++i) {
            const Vec3f wo = random_direction(random);
            const Vec3f wi = i % 4 == 0 ? mirror_direction(wo) : i % 4 == 1 ? wo * -1.0f : random_direction(random);
            const BsdfValue value = evaluate_bsdf(setting.bsdf, wo, wi, setting.mode);
            ASSERT_TRUE(is_finite(value.f_cos) && std::isfinite(value.pdf_solid_angle)) << describe(setting, wo);
            ASSERT_GE(min_component(value.f_cos), 0.0f) << describe(setting, wo);
            ASSERT_GE(value.pdf_solid_angle, 0.0f) << describe(setting, wo);
            ASSERT_TRUE(value.pdf_solid_angle > 0.0f || is_black(value.f_cos)) << describe(setting, wo);
        }
}

TEST(Bsdf, ExtremeRandomNumbersGiveFiniteSamples) {
    constexpr float kLargest = 0x1.fffffep-1f;
    for (const BsdfSetting& setting : all_bsdf_settings())
        for (const float cos_theta : {1e-6f, 1e-3f, 0.5f, 1.0f})
            for (const float sign : {1.0f, -1.0f})
                for (const float u_lobe : {0.0f, 0.5f, kLargest})
                    for (const float x : {0.0f, 0.5f, kLargest})
                        for (const float y : {0.0f, 0.5f, kLargest}) {
                            const Vec3f wo = direction_at(sign * cos_theta);
                            const BsdfSample s = sample_bsdf(setting.bsdf, wo, u_lobe, {x, y}, setting.mode);
                            ASSERT_TRUE(is_finite(s.weight) && is_finite(s.wi)) << describe(setting, wo);
                            ASSERT_GE(min_component(s.weight), 0.0f) << describe(setting, wo);
                        }
}

TEST(Bsdf, OneSidedLobesAreBlackFromBelow) {
    Random random(5);
    for (const BsdfSetting& setting : all_bsdf_settings()) {
        if (is_two_sided_interface(setting.bsdf)) continue;
        const Vec3f wo = direction_at(-0.5f);
        EXPECT_TRUE(is_black(sample_with(setting, wo, random).weight)) << setting.name;
        EXPECT_TRUE(is_black(evaluate_bsdf(setting.bsdf, wo, random_direction(random), setting.mode).f_cos));
    }
}

// Flux that leaves is at most what arrives: the mean weight in importance mode, or, for lobes with a normal of their
// own, in radiance mode, whose mean is the albedo there too. The tolerance is five standard errors and half a per cent,
// within which the tables of the albedo are exact.
TEST(Bsdf, ScattersNoMoreThanArrives) {
    constexpr int kSamples = 4000;
    Random random(6);
    for (const BsdfSetting& setting : all_bsdf_settings()) {
        if (setting.mode != TransportMode::Importance) continue;
        for (const Vec3f& wo : outgoing_directions(setting.bsdf)) {
            double sum = 0.0;
            double squares = 0.0;
            BsdfSetting counted = setting;
            if (setting.has_tilted_normal) counted.mode = TransportMode::Radiance;
            for (int i = 0; i < kSamples; ++i) {
                const auto weight = static_cast<double>(max_component(sample_with(counted, wo, random).weight));
                sum += weight;
                squares += weight * weight;
            }
            const double mean = sum / kSamples;
            const double error = std::sqrt(std::max(0.0, squares / kSamples - mean * mean) / kSamples);
            EXPECT_LE(mean, 1.0 + 5.0 * error + 5e-3) << describe(setting, wo);
        }
    }
}

/// Index on the side of `w` of an interface; 1 for other lobes.
float index_at(const Bsdf& bsdf, const Vec3f& w) {
    if (w.z > 0.0f) return 1.0f;
    if (const auto* rough = std::get_if<RoughDielectric>(&bsdf)) return rough->ior;
    const auto* body = std::get_if<DielectricBody>(&bsdf);
    if (const auto* layered = std::get_if<LayeredSurface>(&bsdf)) body = std::get_if<DielectricBody>(&layered->base);
    if (body == nullptr) return 1.0f;
    return std::visit([](const auto& lobe) { return lobe.ior; }, body->interface);
}

struct Pair {
    Vec3f wo;
    Vec3f wi;
};

/// A direction and one that is sampled for it, so that narrow lobes are met; half of them any two directions.
std::optional<Pair> random_pair(const BsdfSetting& setting, Random& random) {
    Vec3f wo = random_direction(random);
    if (!is_two_sided_interface(setting.bsdf)) wo.z = std::abs(wo.z);
    Vec3f wi = random_direction(random);
    if (random.next() < 0.5f) {
        const BsdfSample s = sample_with(setting, wo, random);
        if (s.is_delta || is_black(s.weight)) return std::nullopt;
        wi = s.wi;
    }
    // Within a thousandth of the horizon the cosine's own rounding shows.
    if (std::abs(wo.z) < 1e-3f || std::abs(wi.z) < 1e-3f) return std::nullopt;
    return Pair{wo, wi};
}

/// Seen nearly edge-on, a microfacet of an interface refracts next to the critical angle, where the Fresnel term
/// computed from the denser side has lost its digits to rounding.
bool is_edge_on(const BsdfSetting& setting, const Pair& pair) {
    const float n_o = index_at(setting.bsdf, pair.wo);
    const float n_i = index_at(setting.bsdf, pair.wi);
    if (n_o == n_i) return false;
    const Vec3f h = normalize(pair.wo * n_o + pair.wi * n_i);
    return std::min(abs_dot(pair.wo, h), abs_dot(pair.wi, h)) < 0.02f;
}

Rgb value_without_cosine(const BsdfSetting& setting, const Pair& pair, TransportMode mode) {
    return evaluate_bsdf(setting.bsdf, pair.wo, pair.wi, mode).f_cos / std::abs(pair.wi.z);
}

bool is_comparable(const BsdfSetting& setting, const Pair& pair) {
    return !is_two_sided_interface(setting.bsdf) || !is_edge_on(setting, pair);
}

/// The same scattering from its other end. Lobes that do not tell sides apart are turned about the y axis, as on a
/// surface, so that the direction that is seen lies on their outside.
Pair reversed(const BsdfSetting& setting, const Pair& pair) {
    if (is_two_sided_interface(setting.bsdf) || pair.wi.z > 0.0f) return {pair.wi, pair.wo};
    const auto turned = [](const Vec3f& w) { return Vec3f(-w.x, w.y, -w.z); };
    return {turned(pair.wi), turned(pair.wo)};
}

// Veach 1997, equation 5.14: f(o -> i) / n_i² = f(i -> o) / n_o², with f in importance mode. For reflection the indices
// are equal and this is Helmholtz reciprocity. Normals of a lobe's own break the symmetry: there the adjoint is tested.
TEST(Bsdf, IsReciprocalUpToTheSquaredIndex) {
    Random random(7);
    for (const BsdfSetting& setting : non_delta_bsdf_settings()) {
        if (setting.mode != TransportMode::Importance || setting.has_tilted_normal) continue;
        int compared = 0;
        for (int i = 0; i < 1000; ++i) {
            const std::optional<Pair> pair = random_pair(setting, random);
            if (!pair || !is_comparable(setting, *pair)) continue;
            const float n_o = index_at(setting.bsdf, pair->wo);
            const float n_i = index_at(setting.bsdf, pair->wi);
            const Rgb forward = value_without_cosine(setting, *pair, TransportMode::Importance) / (n_i * n_i);
            const Rgb backward =
                value_without_cosine(setting, reversed(setting, *pair), TransportMode::Importance) / (n_o * n_o);
            const float tolerance = 2e-3f * (max_component(forward) + max_component(backward)) + 1e-6f;
            ASSERT_NEAR(forward.r, backward.r, tolerance) << describe(setting, pair->wo);
            ASSERT_NEAR(forward.b, backward.b, tolerance) << describe(setting, pair->wo);
            ++compared;
        }
        EXPECT_GT(compared, 100) << setting.name;
    }
}

// The two modes are each other's adjoint (Veach 1997, section 3.7.6): an eye walk from o that goes on along i weighs
// with f(i -> o), which is what a light walk from i that goes on along o weighs with.
TEST(Bsdf, RadianceModeIsTheAdjointOfImportanceMode) {
    Random random(8);
    for (const BsdfSetting& setting : non_delta_bsdf_settings()) {
        if (setting.mode != TransportMode::Importance) continue;
        for (int i = 0; i < 1000; ++i) {
            const std::optional<Pair> pair = random_pair(setting, random);
            if (!pair || !is_comparable(setting, *pair)) continue;
            const Rgb eye = value_without_cosine(setting, *pair, TransportMode::Radiance);
            const Rgb light = value_without_cosine(setting, reversed(setting, *pair), TransportMode::Importance);
            const float tolerance = 2e-3f * (max_component(eye) + max_component(light)) + 1e-6f;
            ASSERT_NEAR(eye.r, light.r, tolerance) << describe(setting, pair->wo);
        }
    }
}

TEST(Bsdf, KnowsWhichLobesAreDeltasAndWhichHaveTwoSides) {
    EXPECT_FALSE(has_non_delta(SmoothConductor{}));
    EXPECT_FALSE(has_non_delta(SmoothDielectric{}));
    EXPECT_TRUE(has_non_delta(RoughConductor{}));
    EXPECT_TRUE(has_non_delta(MetallicRoughness{.metallic = 0.0f, .alpha_x = 0.0f, .alpha_y = 0.0f}))
        << "a smooth coat over a diffuse base";
    EXPECT_FALSE(has_non_delta(MetallicRoughness{.metallic = 1.0f, .alpha_x = 0.0f, .alpha_y = 0.0f}));
    EXPECT_TRUE(is_two_sided_interface(RoughDielectric{}));
    EXPECT_TRUE(is_two_sided_interface(SmoothDielectric{}));
    EXPECT_FALSE(is_two_sided_interface(MetallicRoughness{}));
}

}  // namespace

}  // namespace etendue::test
