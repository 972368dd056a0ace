#include "bsdf/plain_metallic_roughness.h"

#include "bsdf/metallic_roughness.h"
#include "core/wide.h"
#include "support/lanes.h"
#include "support/random.h"

#include <array>
#include <type_traits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// A surface and two directions of 18 numbers in [0, 1).
template <typename T>
struct Case {
    PlainMetallicRoughness<T> lobe;
    Imath::Vec3<T> wo, wi;
    T u_lobe;
    Imath::Vec2<T> u;
};

template <typename T>
Case<T> make_case(const std::array<T, 18>& in) {
    // All kinds of them: pure metals and dielectrics too, and smooth surfaces up to rough ones.
    const T metallic = clamp(in[3] * 2.0f - 0.5f, T(0.0f), T(1.0f));
    const T alpha = max(T(kSmoothAlpha), in[4] * in[4]);
    const BasicRgb<T> f0 = BasicRgb<T>(in[5], in[6], in[7]) * (in[8] * 0.5f);
    const auto direction = [](T x, T y, T z) {
        return normalize(Imath::Vec3<T>(2.0f * x - 1.0f, 2.0f * y - 1.0f, z * 1.2f - 0.2f));
    };
    return {{{in[0], in[1], in[2]}, metallic, alpha, f0, in[8]},
            direction(in[9], in[10], in[11]),
            direction(in[12], in[13], in[14]),
            in[15],
            {in[16], in[17]}};
}

TEST(PlainMetallicRoughness, IsMetallicRoughness) {
    Random random(7);
    int scattering = 0;
    for (int i = 0; i < 100'000; ++i) {
        std::array<float, 18> in{};
        for (float& x : in) x = random.next();
        const Case<float> c = make_case(in);
        MetallicRoughness general;
        general.base = c.lobe.base;
        general.metallic = c.lobe.metallic;
        general.alpha_x = general.alpha_y = c.lobe.alpha;
        general.f0 = c.lobe.f0;
        general.f90 = c.lobe.f90;
        ASSERT_TRUE(general.is_plain());
        const auto both = c.lobe.evaluate_and_sample({}, c.wo, c.wi, c.u_lobe, c.u);
        const BsdfValue value = general.evaluate(c.wo, c.wi, TransportMode::Radiance);
        const BsdfSample sample = general.sample(c.wo, c.u_lobe, c.u, TransportMode::Radiance);
        const auto expect_same = [](float a, float b) { EXPECT_NEAR(a, b, 1e-5f * std::max(1.0f, std::abs(b))); };
        expect_same(both.value.f_cos.r, value.f_cos.r);
        expect_same(both.value.f_cos.b, value.f_cos.b);
        expect_same(both.value.pdf_solid_angle, value.pdf_solid_angle);
        ASSERT_EQ(is_black(both.sample.weight), is_black(sample.weight));
        if (is_black(sample.weight)) continue;
        ++scattering;
        expect_same(both.sample.weight.g, sample.weight.g);
        expect_same(both.sample.wi.x, sample.wi.x);
        expect_same(both.sample.wi.z, sample.wi.z);
        expect_same(both.sample.pdf_solid_angle, sample.pdf_solid_angle);
    }
    EXPECT_GT(scattering, 50'000);
}

// Roundings grow where facets are nearly smooth, as a lobe of 10⁶ / sr depends on the last bits of its directions, and
// at grazing angles. From below nothing is scattered, and samples mean nothing.
TEST(PlainMetallicRoughness, OfManyLanesIsThatOfFloat) {
    EXPECT_LE(
        (largest_lane_difference<18>(
            0.0f, 1.0f,
            [](const auto& in) {
                using T = std::decay_t<decltype(in[0])>;
                const Case<T> c = make_case<T>(in);
                const auto both = c.lobe.evaluate_and_sample({}, c.wo, c.wi, c.u_lobe, c.u);
                const auto is_rough = c.lobe.alpha > T(0.05f);
                const auto is_above = c.wo.z > T(0.02f);
                const auto value = [&](T x) { return select(is_rough && (is_above || c.wo.z <= T(0.0f)), x, T(0.0f)); };
                const auto sample = [&](T x) { return select(is_rough && is_above, x, T(0.0f)); };
                return std::array{
                    value(both.value.f_cos.r),   value(both.value.f_cos.g),          value(both.value.pdf_solid_angle),
                    value(both.sample.weight.g), value(both.sample.pdf_solid_angle), sample(both.sample.wi.x),
                    sample(both.sample.wi.z)};
            })),
        256.0f);
}

TEST(PlainMetallicRoughness, WhatIsNotPlain) {
    MetallicRoughness lobe;
    EXPECT_TRUE(lobe.is_plain());
    const auto with = [&](auto change) {
        MetallicRoughness changed = lobe;
        change(changed);
        return changed.is_plain();
    };
    EXPECT_FALSE(with([](auto& m) { m.alpha_x = 0.5f; }));
    EXPECT_FALSE(with([](auto& m) { m.alpha_x = m.alpha_y = 0.5f * kSmoothAlpha; }));
    EXPECT_FALSE(with([](auto& m) { m.transmission = 0.1f; }));
    EXPECT_FALSE(with([](auto& m) { m.diffuse_transmission = 0.1f; }));
    EXPECT_FALSE(with([](auto& m) { m.film.strength = 0.1f; }));
}

}  // namespace

}  // namespace etendue::test
